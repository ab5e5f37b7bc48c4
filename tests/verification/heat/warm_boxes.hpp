// Boxes with heat, and quantities that the suites of heat compare.
#pragma once

#include "../flow/boxes.hpp"

namespace sprekk::tests {

using base::Expression;

/// Adds heat to a scene: initial temperature T_0, conductivity and capacity of the rocks, capacity c of the fluid.
inline void warm(model::Scene& scene, Real T_0, Real conductivity, Real capacity, Real c) {
  scene.heat.emplace().initial_temperature = Expression(T_0);
  if (scene.flow) scene.heat->fluid_capacity = c;
  for (auto& [name, material] : scene.materials) {
    if (material.type == "joint") continue;
    material.thermal_conductivity = {Expression(conductivity)};
    material.heat_capacity = Expression(capacity);
  }
}

inline void prescribe_temperature(model::Scene& scene, const std::string& side, const std::string& T,
                                  const std::string& fracture = "") {
  auto& condition = scene.boundary_conditions[side + fracture + " is warm"];
  condition.boundary = side;
  condition.temperature = Expression(T);
  if (!fracture.empty()) condition.fracture = fracture;
}

/// Prescribes the volumetric inflow `rate` into a fracture at a side (aperture 1 mm, extent 1).
inline void inject(model::Scene& scene, const std::string& side, const std::string& fracture, Real rate) {
  auto& condition = scene.boundary_conditions[side + " end"];
  condition.boundary = side;
  condition.fracture = fracture;
  condition.flux = Expression(-rate / aperture);
}

inline Real value_at(model::Model& model, const std::string& output, const Vector3& place) {
  const auto field = model.output(output);
  const auto& mesh = model.mesh();
  const bool in_cells = field.entity == fields::Entity::cell;
  Real best = 1e300, value = 0;
  const std::size_t n = in_cells ? mesh.n_owned_cells : mesh.n_owned_fracture_faces;
  for (std::size_t e = 0; e < n; ++e) {
    const auto x = in_cells ? mesh::cell_centre(mesh, static_cast<LocalIndex>(e)) : mesh.fracture_faces[e].centre;
    if (const Real d = norm(difference(x, place)); d < best) {
      best = d;
      value = field.values[e * field.n_components];
    }
  }
  Real nearest = 0;
  Teuchos::reduceAll(*mesh.comm, Teuchos::REDUCE_MIN, 1, &best, &nearest);
  const Real here = best == nearest ? value : -1e300;
  Real all = 0;
  Teuchos::reduceAll(*mesh.comm, Teuchos::REDUCE_MAX, 1, &here, &all);
  return all;
}

}  // namespace sprekk::tests
