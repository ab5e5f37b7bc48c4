// Balance of what flows down a gradient through rock, in the hybrid form: unknowns on cells and on facets.
#pragma once

#include "assembly/module.hpp"
#include "physics/fluid_change.hpp"
#include "physics/hybrid_cell.hpp"
#include "physics/outflow.hpp"
#include "physics/properties.hpp"

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sprekk::physics {

/// What flows, Q, under the gradient of u: of a fluid its volume (m^3) and pressure (Pa), of energy J and K.
struct HybridDiffusionParameters {
  std::string name;       ///< of the module; the scheme is told behind it
  std::string field;      ///< "pressure", u on cells; on facets "face pressure"; also the name of its scale
  std::string unit;       ///< of u
  std::string flux;       ///< name of the output
  std::string flux_unit;  ///< Q per area and time
  OutflowNames outflow = {};
  Properties<laws::Mobility> mobility = {};  ///< of cells, K in q = -K grad u
  FluxScheme scheme = FluxScheme::rt0;
  std::string reason = "";                       ///< why this one
  laws::Fluid fluid = {};                        ///< of energy: the default, whose density is 1
  std::optional<FluidChange> change = {};        ///< flows are those of ChangedFlow
  std::array<Real, 3> weight{};                  ///< rho_0 g, N/m^3
  std::optional<base::Expression> initial = {};  ///< u at the start; none: it has no meaning
  std::vector<base::Expression> source = {};     ///< Q per volume and time; empty or one
  std::vector<FluxCondition> conditions = {};    ///< those without a fracture
  bool in_regions = false;                       ///< u of cells is prescribed: they stay in linear solves
  std::vector<std::string> coupled_by = {};      ///< fields with which, where they are there, cells couple: they stay
  std::vector<Real> exchange = {};  ///< [local fracture face] of each of its sides, m/(Pa s): a resistance between the
                                    ///< cell and the pressure of the fracture; infinite: none. Empty: all infinite
};

/// Declares the unknowns u on cells and on facets and adds to their rows, for a cell K with faces i,
///   sum_i q_i - integral_K source   and, on a facet,   -sum_K q_i + integral of what leaves
/// with q_i = sum_j T_ij (u_K - u_j + rho_0 g . d_j), for a compressible fluid as HybridFlow says, where beside
/// fractures T = (T_0^-1 + diag(1/(exchange A)))^-1 and u_j is the pressure in the fracture: the hybrid form of the
/// mixed method (Arnold and Brezzi 1985): its flows are in balance on every cell and continuous across facets. A facet
/// on the boundary without a condition lets nothing through. T is exact from open to closed sides: no pressure of a
/// side is subtracted from that of a fracture, which would cost digits of the balance. Volumes of fluid are those at
/// reference conditions. Outputs: u, and the flux q = sum_i q_i d_i / (V e_K) (cells, global components), for a fluid
/// a volume at the pressure there.
std::unique_ptr<assembly::Module> make_hybrid_diffusion(mesh::Shape shape, HybridDiffusionParameters parameters);

/// Puts u at the start into unknowns: its means over cells, and its values at the centres of facets, those of fractures
/// among them.
void put_initial(const mesh::Mesh& mesh, const base::Expression& u, const View<Real*>& cells,
                 const View<Real*>& facets);

}  // namespace sprekk::physics
