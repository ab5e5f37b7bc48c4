// Boxes with two crossing fractures, and quantities that the suites of flow compare.
#pragma once

#include "../scenes.hpp"

namespace sprekk::tests {

inline const char* const all_cells[] = {"triangle", "quadrilateral", "tetrahedron", "hexahedron"};
constexpr Real aperture = 1e-3, viscosity = 2;

inline bool is_flat(const std::string& cell) { return cell == "triangle" || cell == "quadrilateral"; }

/// Returns the unit square or cube with the fractures "a" at y = 1/2 and, if `with_b`, "b" at x = 1/2; all sides are
/// closed.
inline model::Scene closed_box(const std::string& cell, bool with_b = true, int n = 4) {
  const bool flat = is_flat(cell);
  auto scene = read_scene(flat ? "flow/source_2d.xml" : "flow/source_3d.xml");
  scene.mesh.cell = cell;
  for (int& count : scene.mesh.cells) count = n;
  using Corner = std::vector<Real>;
  scene.mesh.fractures["a"] = {flat ? Corner{0, 0.5} : Corner{0, 0.5, 0}, flat ? Corner{1, 0.5} : Corner{1, 0.5, 1}};
  if (with_b)
    scene.mesh.fractures["b"] = {flat ? Corner{0.5, 0} : Corner{0.5, 0, 0}, flat ? Corner{0.5, 1} : Corner{0.5, 1, 1}};
  auto& joint = scene.materials["joint"];
  joint.type = "joint";
  joint.initial_aperture = aperture;
  for (const auto& [name, fracture] : scene.mesh.fractures) scene.fractures[name].material = "joint";
  scene.flow->source = 0;
  scene.flow->viscosity = viscosity;
  scene.boundary_conditions.clear();
  return scene;
}

/// Prescribes a pressure on one side, for the rock and fractures that end there, or for a fracture only.
inline void constrain(model::Scene& scene, const std::string& side, const std::string& pressure,
                      const std::string& fracture = "") {
  auto& condition = scene.boundary_conditions[side];
  condition.boundary = side;
  condition.pressure = base::Expression(pressure);
  if (!fracture.empty()) condition.fracture = fracture;
}

/// Returns the inflow at a side with a prescribed pressure. Collective.
inline Real inflow(model::Model& model, const std::string& condition) {
  for (const auto& reaction : model.system().reactions(model.state()))
    if (reaction.condition == condition) return reaction.force.at(0);
  ADD_FAILURE() << condition;
  return 0;
}

/// Returns the largest difference from an exact vector or scalar on owned entities, over all ranks. Collective.
template <class Exact>
Real error(model::Model& model, const std::string& output, const Exact& exact) {
  const auto field = model.output(output);
  const auto& mesh = model.mesh();
  Real here = 0, all = 0;
  for (std::size_t e = 0; e < field.values.size() / field.n_components; ++e) {
    Vector3 x{};
    const auto cell = static_cast<LocalIndex>(e);
    const int n = mesh::n_corners(mesh.shape);
    for (int k = 0; k < n && field.entity == fields::Entity::cell; ++k)
      for (int i = 0; i < mesh.dim(); ++i) x[i] += mesh.coordinates[mesh.cells[cell * n + k] * mesh.dim() + i] / n;
    if (field.entity == fields::Entity::fracture_face) x = mesh.fracture_faces[e].centre;
    const auto value = exact(x, field.entity == fields::Entity::fracture_face ? mesh.fracture_faces[e].frame[0] : x);
    for (int c = 0; c < field.n_components; ++c)
      here = std::max(here, std::abs(field.values[e * field.n_components + c] - value[c]));
  }
  Teuchos::reduceAll(*mesh.comm, Teuchos::REDUCE_MAX, 1, &here, &all);
  return all;
}

}  // namespace sprekk::tests
