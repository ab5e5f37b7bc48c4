// Straight crack of half-length 1 in the plane (Sneddon 1946), with the exact displacement prescribed on the boundary.
// It opens or slips by 2 (1 - nu) s/G sqrt(1 - x^2), with the released stress s.
#pragma once

#include "verification/patch/patch.hpp"

namespace sprekk::tests {
inline model::Scene crack(const std::string& name, const std::vector<std::string>& overrides) {
  return model::read_scene(*Tpetra::getDefaultComm(), source_dir() + "/tests/verification/tips/" + name + ".xml",
                           overrides);
}

/// Returns the crack in a box of squares or cubes, or of triangles or tetrahedra; in 3D a slab in plane strain.
inline model::Scene crack_in_box(const std::string& name, const std::string& cell, int order, int n,
                                 const std::string& tips) {
  auto scene = crack(name, {});
  auto& box = scene.mesh;
  const bool flat = cell == "quadrilateral" || cell == "triangle";
  const Real thickness = 4.0 / n;
  scene.mesh_file.reset();
  box.cell = cell;
  box.order = order;
  box.tips = tips;
  box.lower_corner = {-2, -2};
  box.upper_corner = {2, 2};
  box.cells = {n, n};
  auto& fracture = box.fractures["crack"];
  fracture.lower_corner = {-1, 0};
  fracture.upper_corner = {1, 0};
  fracture.reference_normal = {{0, 1}};
  const auto condition = scene.boundary_conditions.at("exact");
  scene.boundary_conditions.clear();
  for (const std::string side : {"west", "east", "south", "north"}) {
    auto& here = scene.boundary_conditions[side] = condition;
    here.boundary = side;
    if (!flat) here.displacement.emplace_back(0);
  }
  if (flat) return scene;
  box.lower_corner.push_back(0);
  box.upper_corner.push_back(thickness);
  box.cells.push_back(1);
  fracture.lower_corner.push_back(0);
  fracture.upper_corner.push_back(thickness);
  fracture.reference_normal->push_back(0);
  for (const std::string side : {"bottom", "top"}) {
    auto& here = scene.boundary_conditions[side];
    here.boundary = side;
    for (const char* component : {"free", "free", "0"}) here.displacement.emplace_back(component);
  }
  scene.bulk.initial_stress.resize(6, base::Expression(0));
  return scene;
}

/// Returns the mean of sqrt(1 - x^2) over a face with these x of its corners. Faces are segments, rectangles, or right
/// triangles with two corners of equal x.
inline Real mean_root(std::vector<Real> x) {
  for (Real& v : x) v = std::max<Real>(-1, std::min<Real>(1, v));
  std::sort(x.begin(), x.end());
  const Real low = x.front(), high = x.back(), h = high - low;
  const auto root = [](Real v) { return std::sqrt(1 - v * v); };
  const auto integral = [&](Real v) { return (v * root(v) + std::asin(v)) / 2; };
  const auto moment = [&](Real v) { return -std::pow(root(v), 3) / 3; };
  const Real area = integral(high) - integral(low);
  if (x.size() != 3) return area / h;
  const Real alone = x[1] - low < h / 2 ? high : low;
  return std::abs(moment(high) - moment(low) - alone * area) * 2 / (h * h);
}

/// Returns the relative L2 error of the mean jumps of faces, all components. Collective.
inline Real jump_error(const model::Scene& scene, int direction) {
  model::Model model(scene, Tpetra::getDefaultComm());
  const auto report = model.step_to(1);
  EXPECT_TRUE(report.converged) << report.reason;
  const Outputs out(model);
  const auto& mesh = model.mesh();
  const Real nu = 0.25, G = 1, s = 1e-3;
  Real here[2] = {0, 0}, all[2];
  for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) {
    const auto& face = mesh.fracture_faces[f];
    std::vector<Real> x;
    for (int k = 0; k < mesh::n_face_corners(mesh.shape); ++k)
      x.push_back(mesh.coordinates[face.nodes[mesh::minus][k] * mesh.dim()]);
    Vector3 exact{};
    exact[direction] = 2 * (1 - nu) * s / G * mean_root(x);
    const auto e = difference(out.vector("jump", f), exact);
    here[0] += face.area * dot(e, e);
    here[1] += face.area * dot(exact, exact);
  }
  Teuchos::reduceAll(*mesh.comm, Teuchos::REDUCE_SUM, 2, here, all);
  return std::sqrt(all[0] / all[1]);
}

}  // namespace sprekk::tests
