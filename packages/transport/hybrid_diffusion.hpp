// Hybrid form of a diffusive balance in rock, with unknowns on cells and on facets.
#pragma once

#include "assembly/module.hpp"
#include "fields/properties.hpp"
#include "transport/fluid_change.hpp"
#include "transport/hybrid_cell.hpp"
#include "transport/outflow.hpp"

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sprekk::transport {

/// Parameters of the diffusion of a quantity Q driven by the gradient of u. Fluid: volume (m^3) and pressure (Pa).
/// Energy: J and K.
struct HybridDiffusionParameters {
  std::string name;       ///< name of the module; the scheme is appended
  std::string field;      ///< "pressure": u on cells; on facets "face pressure"; also the name of its scale
  std::string unit;       ///< unit of u
  std::string flux;       ///< name of the flux output
  std::string flux_unit;  ///< unit of Q per area and time
  OutflowNames outflow = {};
  fields::Properties<laws::Mobility> mobility = {};  ///< K of cells in q = -K grad u
  FluxScheme scheme = FluxScheme::rt0;
  std::string reason = "";                       ///< reason for the choice of the scheme
  laws::Fluid fluid = {};                        ///< energy: the default, with density 1
  std::optional<FluidChange> change = {};        ///< use the flows of ChangedFlow
  std::array<Real, 3> weight{};                  ///< rho_0 g, N/m^3
  std::optional<base::Expression> initial = {};  ///< u at the start; none: undefined
  std::vector<base::Expression> source = {};     ///< Q per volume and time; empty or one
  std::vector<FluxCondition> conditions = {};    ///< without those of fractures
  bool in_regions = false;                       ///< u is prescribed in some cells; these are not eliminated
  std::vector<std::string> coupled_by = {};      ///< fields whose presence prevents the elimination of cells
  std::vector<Real> exchange = {};  ///< [local fracture face] m/(Pa s), transfer coefficient between each side's cell
                                    ///< and the fracture; infinite: no resistance; empty: all infinite
};

/// Creates the module that declares u on cells and on facets and adds their rows. For a cell K with faces i, and for a
/// facet, the rows are
///   sum_i q_i - integral_K source   and   -sum_K q_i + integral of the prescribed outflow,
///   q_i = sum_j T_ij (u_K - u_j + rho_0 g . d_j)
/// or, for a compressible fluid, the flow of HybridFlow. This is the hybrid form of the mixed method (Arnold and Brezzi
/// 1985): flows are conservative on every cell and continuous across facets. A boundary facet without a condition is
/// impermeable.
///
/// Next to fractures T = (T_0^-1 + diag(1/(exchange A)))^-1, and u_j is the pressure in the fracture. T is accurate for
/// all values of `exchange`. No side pressure is subtracted from a fracture pressure, so no digits of the balance are
/// lost. Fluid volumes are those at reference conditions.
///
/// Outputs: u, and the flux q = sum_i q_i d_i / (V e_K) on cells in global components. The flux of a fluid is a volume
/// at the local pressure.
std::unique_ptr<assembly::Module> make_hybrid_diffusion(mesh::Shape shape, HybridDiffusionParameters parameters);

/// Sets the initial values of u: means over cells, and values at the centres of facets, including those of fractures.
void put_initial(const mesh::Mesh& mesh, const base::Expression& u, const View<Real*>& cells,
                 const View<Real*>& facets);
/// Sets the initial values of u on the facets of a mesh that has facets of fractures alone.
void put_initial(const mesh::Mesh& mesh, const base::Expression& u, const View<Real*>& facets);

}  // namespace sprekk::transport
