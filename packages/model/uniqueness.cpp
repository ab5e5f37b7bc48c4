#include "model/uniqueness.hpp"

#include "mesh/extents.hpp"

#include <algorithm>
#include <cmath>

namespace sprekk::model {

namespace {

/// The most compliant in compression and the stiffest in shear of a scene's rocks, if they are uniform.
std::optional<laws::Elasticity> bounding_rock(const Scene& scene) {
  if (!scene.deforms()) return {};
  std::vector<const Material*> rocks = {&scene.materials.at(scene.bulk.material)};
  for (const auto& [name, region] : scene.regions) rocks.push_back(&scene.material_of(name));
  Real shear = 0, uniaxial = std::numeric_limits<Real>::infinity();
  for (const auto* rock : rocks) {
    if (!rock->is_uniform()) return {};
    const auto elasticity = rock->elasticity({});
    shear = std::max(shear, elasticity.G);
    uniaxial = std::min(uniaxial, elasticity.lambda + 2 * elasticity.G);
  }
  return laws::Elasticity{shear, uniaxial - 2 * shear};
}

}  // namespace

std::string friction_doubt(const Scene& scene) {
  std::string largest;
  Real mu = 1;
  for (const auto& [name, fracture] : scene.fractures) {
    const auto here = scene.materials.at(fracture.material).uniform_friction();
    if (!here || *here <= mu) continue;
    mu = *here;
    largest = fracture.material;
  }
  if (largest.empty()) return "";
  return fmt::format(
      "the friction coefficient of \"{}\" is {:.4g}: above about 1 equilibrium need not exist, nor be unique", largest,
      mu);
}

std::string dilation_doubt(const Scene& scene, const mesh::Mesh& mesh) {
  const Real size = mesh::largest_extent(mesh);
  const auto rock = bounding_rock(scene);
  if (!rock) return "";
  for (const auto& [name, fracture] : scene.fractures) {
    const auto& material = scene.materials.at(fracture.material);
    if (!material.is_uniform()) continue;
    const auto law = material.joint({}).law;
    const Real shear = law.friction.coefficient * (size / rock->G + law.elastic.compliance),
               normal = size / (rock->lambda + 2 * rock->G) + law.gap.closure.initial_compliance();
    if (law.gap.dilation.tangent * shear <= normal) continue;
    const auto degrees = [](Real tangent) { return std::atan(tangent) * 180 / M_PI; };
    return fmt::format(
        "slip of \"{}\" that turns back need not have one state only: its dilation angle is {:.4g} degrees, and above "
        "{:.4g} the friction bound falls faster than the shear traction (rock of size {:.4g} m)",
        fracture.material, degrees(law.gap.dilation.tangent), degrees(normal / shear), size);
  }
  return "";
}

}  // namespace sprekk::model
