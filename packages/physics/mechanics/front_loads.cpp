#include "physics/mechanics/front_loads.hpp"

#include "assembly/geometry.hpp"
#include "physics/poroelasticity/poroelasticity.hpp"
#include "physics/scene.hpp"

#include <algorithm>
#include <utility>

namespace sprekk::physics::front {

using mesh::Vector;
using mesh::operator-, mesh::operator*;

const std::vector<Real>* values_of(const std::vector<assembly::OutputField>& outputs, const std::string& name) {
  const auto found = std::find_if(outputs.begin(), outputs.end(), [&](const auto& one) { return one.name == name; });
  return found == outputs.end() ? nullptr : &found->values;
}

LoadsOfStates::LoadsOfStates(const Setting& setting, InitialStress initial)
    : scene_(setting.scene), mesh_(setting.mesh), initial_(std::move(initial)), filling_(filling_biot(scene_, mesh_)) {
  if (!has_fluid(scene_)) return;
  for (LocalIndex c = 0; c < mesh_.n_owned_cells; ++c) {
    const auto& material = scene_.material_of(mesh_.region_names[mesh_.cell_region[c]]);
    biot_.push_back(material.biot(mesh::cell_centre(mesh_, c), 0));
    initial_pressure_.push_back(
        assembly::cell_mean(mesh_, c, [p = initial_pressure(scene_)](const auto& x) { return p(x, 0); })[1]);
  }
}

Loads LoadsOfStates::operator()(const std::vector<assembly::OutputField>& outputs) const {
  Loads loads;
  const auto add = [&](const std::vector<Real>& values, const auto& of) {
    loads.isotropic.resize(mesh_.n_owned_cells, 0);
    for (LocalIndex c = 0; c < mesh_.n_owned_cells; ++c) loads.isotropic[c] += of(c, values[c]);
  };
  if (const auto* thermal = values_of(outputs, "thermal stress"))
    add(*thermal, [](LocalIndex, Real value) { return value; });
  if (const auto* p = values_of(outputs, "pressure"); p && !biot_.empty())
    add(*p, [&](LocalIndex c, Real value) { return -biot_[c] * (value - initial_pressure_[c]); });
  const auto& contact = *values_of(outputs, "traction");
  const auto *flowing = values_of(outputs, "fracture pressure"), *given = values_of(outputs, "fluid pressure");
  const int dim = mesh_.dim();
  for (LocalIndex f = 0; f < mesh_.n_owned_fracture_faces; ++f) {
    const auto& face = mesh_.fracture_faces[f];
    Vector t{};
    std::copy_n(&contact[f * dim], dim, t.begin());
    const auto* pressure = flowing ? flowing : given;
    const Real p = pressure ? filling_[f] * (*pressure)[f] : 0;
    t = t - p * face.frame[0];
    if (!initial_.empty()) t = t - mean_initial_traction(initial_, mesh_, face, mesh::minus);
    loads.traction.push_back(t);
  }
  return loads;
}

}  // namespace sprekk::physics::front
