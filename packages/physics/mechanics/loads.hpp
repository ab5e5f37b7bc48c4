// Loads on the rock that act on all displacement functions, including face bubbles.
#pragma once

#include "assembly/geometry.hpp"
#include "base/expression.hpp"
#include "base/types.hpp"
#include "mesh/facets.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace sprekk::physics {

/// Force per volume, N/m^3, in global components. Empty: none.
struct BodyForce {
  std::vector<base::Expression> value = {};  ///< per component
  std::vector<Real> gravity = {};            ///< per component, m/s^2
  std::vector<Real> density_of_cell = {};    ///< [local cell], kg/m^3; required with gravity

  bool empty() const { return value.empty() && gravity.empty(); }
  bool constant_in_time() const {
    return std::all_of(value.begin(), value.end(), [](const base::Expression& e) { return e.constant_in_time(); });
  }
  /// Component i at a point of a local cell.
  Real operator()(int i, LocalIndex cell, const std::array<Real, 3>& x, Real t) const {
    return (value.empty() ? 0 : value[i](x, t)) + (gravity.empty() ? 0 : density_of_cell[cell] * gravity[i]);
  }
};

/// Stress sigma_0 of the rock at zero displacement, Pa, tension positive: sigma = sigma_0 + 2 G eps + lambda tr(eps) I.
/// Components XX, YY, ZZ, XY in 2D; XX, YY, ZZ, XY, YZ, XZ in 3D. Empty: none.
struct InitialStress {
  std::vector<std::vector<base::Expression>> value = {};  ///< [region, component]
  /// [fracture, component] traction of the contact in the frame of the face, Pa, tension positive, in place of that of
  /// the rock; no components: as in the rock.
  std::vector<std::vector<base::Expression>> of_fracture = {};

  bool empty() const { return value.empty(); }
  const std::vector<base::Expression>& of_cell(const mesh::Mesh& mesh, LocalIndex cell) const {
    return value[mesh.cell_region[cell]];
  }
  /// Computes the stress at a point inside of a cell.
  template <int dim>
  void at(const mesh::Mesh& mesh, LocalIndex cell, const std::array<Real, 3>& x, Real (&sigma)[dim][dim]) const {
    const auto& component = of_cell(mesh, cell);
    sigma[0][0] = component[0](x, 0);
    sigma[1][1] = component[1](x, 0);
    sigma[0][1] = sigma[1][0] = component[3](x, 0);
    if constexpr (dim == 3) {
      sigma[2][2] = component[2](x, 0);
      sigma[1][2] = sigma[2][1] = component[4](x, 0);
      sigma[0][2] = sigma[2][0] = component[5](x, 0);
    }
  }
  /// Traction sigma_0 n, Pa, at a point x of a face of a cell, on the side of this cell. sigma_0 may be discontinuous
  /// across the face, where rounding would select the side of x. It is therefore extrapolated from the cell as
  ///   2 sigma_0(x + d) - sigma_0(x + 2 d),   d = 1e-6 (centre - x),
  /// which is exact for linear sigma_0.
  std::array<Real, 3> traction(const mesh::Mesh& mesh, LocalIndex cell, const std::array<Real, 3>& x,
                               const std::array<Real, 3>& n) const;
};

/// Pressure p of a fluid in the fractures, Pa, compression positive: the traction on the rock is lambda - alpha_f p n
/// with Biot's coefficient alpha_f of the filling. Empty: none.
struct FluidPressure {
  std::vector<base::Expression> value = {};  ///< [fracture]
  std::vector<Real> biot = {};               ///< [local fracture face] alpha_f, see filling_biot(); empty: 1

  bool empty() const { return value.empty(); }
  bool constant_in_time() const {
    return std::all_of(value.begin(), value.end(), [](const base::Expression& e) { return e.constant_in_time(); });
  }
};

/// Mean of the fluid pressure over a fracture face at time t, Pa, on the face of the cell on `side`.
Real mean_fluid_pressure(const FluidPressure& fluid, const mesh::Mesh& mesh, const mesh::Mesh::FractureFace& face,
                         int side, Real t);

/// The same mean times Biot's coefficient of the filling.
Real mean_bearing_pressure(const FluidPressure& fluid, const mesh::Mesh& mesh, LocalIndex face, int side, Real t);

/// Mean of sigma_0 n over a fracture face, n from minus to plus, on the face of the cell on `side`; global components,
/// Pa.
std::array<Real, 3> mean_initial_traction(const InitialStress& stress, const mesh::Mesh& mesh,
                                          const mesh::Mesh::FractureFace& face, int side);

}  // namespace sprekk::physics
