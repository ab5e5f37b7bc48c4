// Mass balance of a fluid in the rock: rows of the pressure and of the pressure on faces.
#pragma once

#include "assembly/module.hpp"
#include "base/expression.hpp"
#include "physics/hybrid_cell.hpp"

#include <memory>
#include <string>
#include <vector>

namespace sprekk::physics {

/// Volume of fluid that leaves through a boundary, m/s.
struct BoundaryFlux {
  int boundary;
  base::Expression value;
  int region = -1;  ///< only on faces of cells of this region; -1: all
};

struct DarcyFlowParameters {
  std::vector<laws::Mobility> mobility;  ///< different ones
  std::vector<int> mobility_of_cell;     ///< [local cell] which of them; empty: the number of the cell's region
  FluxScheme scheme = FluxScheme::rt0;
  std::array<Real, 3> weight{};               ///< rho g, N/m^3
  std::vector<base::Expression> source = {};  ///< volume of fluid per volume and time, 1/s; empty or one
  std::vector<BoundaryFlux> fluxes = {};
};

/// The scheme of that name. "auto": rt0 on simplices; on others tpfa where that is exact for constant gradients (all
/// (k/mu) A_i parallel to d_i, to 1e-10), else mimetic. Throws an Error for rt0 on other cells. Collective.
FluxScheme flux_scheme(const std::string& name, const mesh::Mesh& mesh, const std::vector<laws::Mobility>& mobility);
std::string name_of(FluxScheme scheme);

/// Declares the unknowns "pressure" (cells, Pa) and "face pressure" (facets, Pa) and adds to their rows, for a cell K
/// with faces i,
///   sum_i q_i - integral_K source   and, on a facet,   -sum_K q_i + integral flux
/// with q_i = sum_j T_ij (p_K - p_j + rho g . d_j), the hybrid form of the mixed method (Arnold and Brezzi 1985): its
/// flows are in balance on every cell and continuous across facets. A facet on the boundary without flux and without
/// prescribed pressure lets nothing through.
/// Outputs: pressure, and "Darcy velocity" q = sum_i q_i d_i / V (cells, m/s).
std::unique_ptr<assembly::Module> make_darcy_flow(mesh::Shape shape, DarcyFlowParameters parameters);

}  // namespace sprekk::physics
