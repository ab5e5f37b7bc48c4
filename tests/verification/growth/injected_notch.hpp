// A notch at the end of a bonded surface, into which a nearly inviscid fluid is injected.
#pragma once

#include "bonded_fracture.hpp"

namespace sprekk::tests {
namespace injection {

constexpr Real modulus = 32e9, energy = 125, notch = 1, compression = 1e7;  // E/(1 - nu^2), Pa; G_I, J/m^2; m; Pa
constexpr Real residual = 4.5e-5, film = 1e-4 * 0.05 * residual;  // residual aperture; storage of bonded faces, m
constexpr Real share_of_film = 1.25e-4;                           // transmissivity of a sealed face

/// Crack of half-length a with K = K_c in the middle of a tall body between rollers at x = +-W. K = p sqrt(2 W
/// tan(pi a/2W)) is exact; the area of the half follows from dv/da = 4 K^2/(E' p^2).
inline Real exact_area(Real a, Real W) {
  const Real angle = M_PI * a / (2 * W), p = std::sqrt(energy * modulus / (2 * W * std::tan(angle)));
  return -8 * W * W / (M_PI * modulus) * p * std::log(std::cos(angle));
}
inline Real exact_length(Real area, Real W) {
  Real low = 0.05 * W, high = 0.9 * W;
  for (int k = 0; k < 60; ++k) (exact_area((low + high) / 2, W) < area ? low : high) = (low + high) / 2;
  return low;
}

/// Box of 4 m x 6 m with faces of 0.25 m; the source is in the first face. In 3D one layer of cells, plane strain.
/// Process zone of 1.3 m.
inline model::Scene small_body(const std::string& cell, const std::vector<std::string>& more = {}) {
  std::vector<std::string> all = {"Materials.bonded joint.tensile strength=1.55 MPa"};
  all.insert(all.end(), more.begin(), more.end());
  auto scene = read_scene("growth/injection_2d.xml", all);
  const bool flat = cell == "quadrilateral" || cell == "triangle";
  const Real length = 4, width = 0.25;
  scene.mesh_file.reset();
  scene.mesh.cell = cell;
  scene.mesh.lower_corner = {0, -3};
  scene.mesh.upper_corner = {length, 3};
  scene.mesh.cells = {16, 24};
  auto& plane = scene.mesh.fractures["growing"];
  plane.lower_corner = {0, 0};
  plane.upper_corner = {length, 0};
  auto& conditions = scene.boundary_conditions;
  conditions["west"] = conditions.at("west lower");
  conditions["west"].boundary = "west";
  conditions.erase("west lower");
  conditions.erase("west upper");
  scene.flow->wells.clear();
  auto& source = scene.fractures.at("growing").source;
  source = base::Expression("x < 0.25 ? 8e-5 : 0");
  source.compile();
  if (flat) return scene;
  scene.mesh.cells.push_back(1);
  for (auto* lower : {&scene.mesh.lower_corner, &plane.lower_corner}) lower->push_back(0);
  for (auto* upper : {&scene.mesh.upper_corner, &plane.upper_corner}) upper->push_back(width);
  auto& stress = scene.bulk.initial_stress;
  stress.resize(6, base::Expression(0));
  for (auto& [name, condition] : conditions) {
    if (!condition.displacement.empty()) condition.displacement.emplace_back("free");
    if (!condition.traction.empty()) condition.traction.emplace_back(0.0);
  }
  for (const std::string side : {"bottom", "top"}) {
    auto& condition = conditions[side];
    condition.boundary = side;
    condition.displacement.assign(3, base::Expression("free"));
    condition.displacement[2] = base::Expression(0);
  }
  return scene;
}

/// Integral of the fluid that fractures have taken up, at reference conditions. Collective.
inline Real stored(model::Model& model) {
  constexpr Real compressibility = 4.5e-10;
  const auto& mesh = model.mesh();
  const auto opening = model.output("opening").values, pressure = model.output("fracture pressure").values;
  Real here = 0, all = 0;
  for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) {
    const auto& face = mesh.fracture_faces[f];
    const Real first = face.centre[0] > notch ? film : residual;
    const Real now = face.centre[0] > notch ? film + std::max(Real(0), opening[f]) : std::max(residual, opening[f]);
    here += face.area * (now * std::exp(compressibility * pressure[f]) - first);
  }
  Teuchos::reduceAll(*mesh.comm, Teuchos::REDUCE_SUM, 1, &here, &all);
  return all;
}

}  // namespace injection
}  // namespace sprekk::tests
