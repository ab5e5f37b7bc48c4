// Mass balance of a fluid in the rock: rows of the pressure and of the pressure on faces.
#pragma once

#include "assembly/module.hpp"
#include "base/expression.hpp"
#include "physics/hybrid_cell.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sprekk::physics {

/// Volumes of fluid here and below are those at reference conditions, mass over the density rho_0 there.

/// Fluid that leaves through a boundary: volume per area and time, m/s; or with a conductance c, m/(Pa s), as much as
/// c (p - value) (see Exchange), the value being the pressure beyond, Pa.
struct FluidCondition {
  int boundary;
  base::Expression value;
  std::optional<base::Expression> conductance = {};
  int region = -1;    ///< only on faces of cells of this region; -1: all
  int fracture = -1;  ///< through the end of this fracture, of which the area is length times aperture; -1: of rock

  /// What leaves where the pressure is p.
  Real outflow(Real p, const std::array<Real, 3>& x, Real t, const laws::Fluid& fluid) const {
    return conductance ? (*conductance)(x, t) * fluid.drop(p, value(x, t), 0) : value(x, t);
  }
};

struct DarcyFlowParameters {
  std::vector<laws::Mobility> mobility;  ///< different ones
  std::vector<int> mobility_of_cell;     ///< [local cell] which of them; empty: the number of the cell's region
  FluxScheme scheme = FluxScheme::rt0;
  std::string reason = "";  ///< why this one
  laws::Fluid fluid = {};
  std::array<Real, 3> weight{};                 ///< rho_0 g, N/m^3
  std::vector<base::Expression> source = {};    ///< volume of fluid per volume and time, 1/s; empty or one
  std::vector<FluidCondition> conditions = {};  ///< those without a fracture
  bool in_regions = false;                      ///< pressures of cells are prescribed: they stay in linear solves
  std::vector<Real> exchange = {};  ///< [local fracture face] of each of its sides, m/(Pa s): a resistance between the
                                    ///< cell and the pressure of the fracture; infinite: none. Empty: all infinite
};

/// Appends a total of what flows in for each condition, still zero; returns the number of the first.
std::size_t add_inflows(const std::vector<FluidCondition>& conditions, const mesh::Mesh& mesh,
                        std::vector<assembly::Total>& totals);

/// Declares the unknowns "pressure" (cells, Pa) and "face pressure" (facets, Pa) and adds to their rows, for a cell K
/// with faces i,
///   sum_i q_i - integral_K source   and, on a facet,   -sum_K q_i + integral of what leaves
/// with q_i = sum_j T_ij (p_K - p_j + rho_0 g . d_j), for a compressible fluid as HybridFlow says, where beside
/// fractures T = (T_0^-1 + diag(1/(exchange A)))^-1 and p_j is the pressure in the fracture: the hybrid form of the
/// mixed method (Arnold and Brezzi 1985): its flows are in balance on every cell and continuous across facets. A facet
/// on the boundary without a condition lets nothing through. T is exact from open to closed sides: no pressure of a
/// side is subtracted from that of a fracture, which would cost digits of the balance. Outputs: pressure, and "Darcy
/// velocity" q = sum_i q_i d_i / (V e_K) (cells, m/s), a volume at the pressure there.
std::unique_ptr<assembly::Module> make_darcy_flow(mesh::Shape shape, DarcyFlowParameters parameters);

}  // namespace sprekk::physics
