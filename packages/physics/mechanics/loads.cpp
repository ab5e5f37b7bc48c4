#include "physics/mechanics/loads.hpp"

namespace sprekk::physics {

std::array<Real, 3> InitialStress::traction(const mesh::Mesh& mesh, LocalIndex cell, const std::array<Real, 3>& x,
                                            const std::array<Real, 3>& n) const {
  const auto centre = mesh::cell_centre(mesh, cell);
  std::array<Real, 3> t{}, inside = x;
  const auto add = [&](const auto& sigma, Real weight) {
    for (int i = 0; i < mesh.dim(); ++i)
      for (int j = 0; j < mesh.dim(); ++j) t[i] += weight * sigma[i][j] * n[j];
  };
  for (const Real weight : {2.0, -1.0}) {
    for (int i = 0; i < mesh.dim(); ++i) inside[i] += 1e-6 * (centre[i] - x[i]);
    Real plane[2][2], sigma[3][3];
    if (mesh.dim() == 2) {
      at(mesh, cell, inside, plane);
      add(plane, weight);
    } else {
      at(mesh, cell, inside, sigma);
      add(sigma, weight);
    }
  }
  return t;
}

Real mean_fluid_pressure(const FluidPressure& fluid, const mesh::Mesh& mesh, const mesh::Mesh::FractureFace& face,
                         int side, Real t) {
  const auto& p = fluid.value[face.fracture];
  if (p.is_constant()) return p({}, t);
  return assembly::face_mean(mesh, face.cell[side], face.local_face[side],
                             [&](const auto&, const auto& x) { return p(x, t); });
}

Real mean_bearing_pressure(const FluidPressure& fluid, const mesh::Mesh& mesh, LocalIndex face, int side, Real t) {
  const Real p = mean_fluid_pressure(fluid, mesh, mesh.fracture_faces[face], side, t);
  return fluid.biot.empty() ? p : fluid.biot[face] * p;
}

std::array<Real, 3> mean_initial_traction(const InitialStress& stress, const mesh::Mesh& mesh,
                                          const mesh::Mesh::FractureFace& face, int side) {
  std::array<Real, 3> sum{};
  Real total = 0;
  assembly::for_each_face_point(mesh, face.cell[side], face.local_face[side],
                                [&](const auto&, Real area, const auto& x) {
                                  const auto traction = stress.traction(mesh, face.cell[side], x, face.frame[0]);
                                  for (int i = 0; i < 3; ++i) sum[i] += area * traction[i];
                                  total += area;
                                });
  for (auto& component : sum) component /= total;
  return sum;
}

}  // namespace sprekk::physics
