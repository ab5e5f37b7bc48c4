#include "physics/mechanics/unbroken.hpp"

#include "base/entry_of_place.hpp"
#include "base/over_ranks.hpp"
#include "laws/bond/process_zone.hpp"
#include "mesh/extents.hpp"
#include "physics/comparison.hpp"

#include <algorithm>
#include <cmath>

namespace sprekk::physics {

bool is_unbroken(const Scene& scene, const mesh::Mesh& mesh, const mesh::Mesh::FractureFace& face) {
  const auto& unbroken = scene.fractures.at(mesh.fracture_names[face.fracture]).unbroken;
  return unbroken && (*unbroken)(face.centre, 0) > 0;
}

void set_bond(laws::JointParameters& joint, bool unbroken) {
  if (!unbroken) return void(joint.law.bond = {});
  joint.law.elastic = laws::Shear();
  joint.law.gap.closure = laws::Closure();
  joint.law.gap.initial = joint.initial_aperture = joint.min_aperture = 0;
}

laws::Bond bond_of(const laws::Bond& bond, const mesh::Mesh& mesh, const mesh::Mesh::FractureFace& face,
                   const fields::Properties<laws::Elasticity>& rock) {
  const auto modulus = [&](LocalIndex cell) { return rock.of_cell(mesh, cell).plane_strain_modulus(); };
  return laws::on_face(bond, std::min(modulus(face.cell[0]), modulus(face.cell[1])), mesh::length_of(mesh, face));
}

void compare_unbroken(Comparison& c) {
  const auto& scene = c.scene();
  for (const auto& [name, fracture] : scene.fractures) {
    if (!fracture.unbroken) continue;
    const std::string place = fmt::format("Fractures > {} > \"unbroken\"", name);
    if (!Mechanics::is_in(scene)) {
      c.fail(place, "requires rock that deforms");
      continue;
    }
    for_each_physics([&]<HasTransport P>(P) {
      for (const auto& carried : P::Transport::carried(scene))
        c.fail(place, fmt::format("not available with transport of the {}", carried.field));
    });
    for (const auto& [entry, given] :
         {std::pair("plastic jump", !fracture.plastic_jump.empty()),
          std::pair("prescribed slip", fracture.prescribed_slip && !fracture.prescribed_slip->slip.empty())})
      if (given) c.fail(place, fmt::format("not available with a \"{}\": bonded faces have no jump", entry));
    if (scene.host_fluid) c.fail(place, "not available with a fluid of a host program");
    const auto* joint = c.joint_of(fracture);
    if (!joint || !c.is_sound("Flow")) continue;
    const auto fail = [&](const char* entry, const std::string& what) {
      c.fail(fmt::format("Materials > {} > \"{}\"", fracture.material, entry),
             what + fmt::format(", required by the \"unbroken\" part of \"{}\"", name));
    };
    const bool is_sharp = joint->bond == laws::SharpFrontBond::name;
    if (!is_sharp && joint->bond != laws::SofteningBond::name)
      fail("bond",
           fmt::format("is {}; must be {} or {}", joint->bond, laws::SharpFrontBond::name, laws::SofteningBond::name));
    else if (const auto& strength = joint->entry("tensile strength"); !is_sharp && (!strength || is_zero(*strength)))
      fail("tensile strength", "must be above 0");
    else if (const auto& cohesion = joint->entry("cohesion"); !is_sharp && (!cohesion || is_zero(*cohesion)))
      fail("cohesion", "must be above 0 as the only resistance of bonded faces to slip under tension");
    if (joint->is_in_situ()) fail("reference state", fmt::format("is {}; must be unloaded", joint->reference_state));
    if (!scene.flow) continue;
    if (is_zero(joint->residual_aperture)) fail("residual aperture", "must be above 0");
    if (joint->tangential_permeability) fail("tangential permeability", "must be absent");
    const auto& across = joint->normal_permeability;
    if (!across.is_constant() || std::isfinite(across({}, 0))) fail("normal permeability", "must be infinite");
  }
}

std::string notch_doubt(const Scene& scene) {
  if (!scene.flow || scene.flow->compressibility > 0 || flows_in_rock(scene)) return "";
  for (const auto& [name, condition] : scene.boundary_conditions)
    if (condition.fracture && (condition.pressure || condition.conductance)) return "";
  for (const auto& [name, well] : scene.flow->wells)
    if (well.pressure) return "";
  for (const auto& [name, fracture] : scene.fractures)
    if (fracture.unbroken)
      return implausible(scene.origin + ": Sprekk > Flow > \"compressibility\"",
                         fmt::format("is 0, \"{}\" is partly bonded, and the rock is impermeable", name),
                         "the pressure in a closed notch is undetermined, and the run may fail",
                         "give the \"compressibility\" of the fluid, 4.5e-10 for water");
  return "";
}

std::vector<std::string> process_zone_warnings(const Setting& setting) {
  constexpr Real faces_in_zone = 3, coarse = 1.1;
  const auto& [scene, mesh, start] = setting;
  std::vector<Real> least(mesh.fracture_names.size(), HUGE_VAL), ratio(least.size(), 0);  // length; to zone
  for (const auto& face : mesh.fracture_faces)  // expressions of bonded parts were evaluated before
    if (is_unbroken(scene, mesh, face)) least[face.fracture] = std::min(least[face.fracture], length_of(mesh, face));
  least = base::min_over_ranks(*mesh.comm, least);
  if (std::all_of(least.begin(), least.end(), [](Real length) { return length == HUGE_VAL; })) return {};
  base::collectively(*mesh.comm, [&, &scene = scene, &mesh = mesh] {
    const auto rock = elasticity(scene, mesh);
    for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) {
      const auto& face = mesh.fracture_faces[f];
      if (!is_unbroken(scene, mesh, face) || length_of(mesh, face) > coarse * least[face.fracture]) continue;
      const auto& material = joint_of(scene, mesh, face.single);
      const auto given = at_place(scene, material, [&] { return material.joint(face.centre).law.bond; });
      const auto bond = bond_of(given, mesh, face, rock);
      for (const LocalIndex cell : face.cell)
        ratio[face.fracture] = std::max(
            ratio[face.fracture],
            mesh::length_of(mesh, face) / laws::process_zone(bond, rock.of_cell(mesh, cell).plane_strain_modulus()));
    }
  });
  ratio = base::max_over_ranks(*mesh.comm, ratio);
  std::vector<std::string> warnings;
  for (std::size_t k = 0; k < ratio.size(); ++k)
    if (ratio[k] * faces_in_zone > 1 + 1e-9)
      warnings.push_back(implausible(
          fmt::format("{}: Sprekk > Fractures > {} > \"unbroken\"", scene.origin, mesh.fracture_names[k]),
          fmt::format("the process zone has about {:.2g} faces", 1 / ratio[k]), "the front needs at least three",
          "use smaller cells, or less \"tensile strength\" with the same \"fracture energy\""));
  return warnings;
}

}  // namespace sprekk::physics
