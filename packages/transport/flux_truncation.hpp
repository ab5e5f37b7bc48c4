// Truncation error of the hybrid form: residual of its rows at the exact solution.
#pragma once

#include "transport/hybrid_error.hpp"

#include <memory>
#include <vector>

namespace sprekk::transport {

/// Truncation error of a balance due to its scheme, as in HybridError, or to upwinding.
class FluxTruncation {
 public:
  virtual ~FluxTruncation() = default;

  virtual void set_transmissivity(FaceTransmissivity present) = 0;
  /// Flows driven by the given potentials, [owned unknown]. Collective.
  virtual HybridFlows flows(const fields::Vector& cells, const fields::Vector& facets) const = 0;
  /// Flows q_i driven by potential differences c_i. For flows q_v of potentials v:
  /// c . q_v = q . (v_K - v_i).
  virtual HybridFlows flows(const HybridFlows& differences) const = 0;
  /// Adds the excess transport by the fluid flows Q, with `capacity` per volume and unit.
  /// Upwinding uses T_K instead of the facet value T_i. The excess is -Q (T_i - T_K), with the gradient fitted to the
  /// T_K of the surrounding cells. Collective.
  virtual void add_upwind(const HybridFlows& carrying, Real capacity, const fields::Vector& cells,
                          const fields::Vector& facets, HybridFlows& excess) const = 0;

  /// Adds the flows to the rows of cells, and with opposite sign to those of facets. Collective.
  virtual void add_to_rows(const HybridFlows& excess, fields::Vector& cells, fields::Vector& facets) const = 0;
  /// Adds values of local facets. Collective.
  virtual void add_over_ranks(const std::vector<Real>& local, fields::Vector& facets) const = 0;
  /// Adds the mean minus the midpoint value to the rows of prescribed facets. Collective.
  virtual void add_prescribed(Real t, fields::Vector& facets) const = 0;
  /// [owned cell] sum of |excess_i (v_K - v_i)|. Fracture faces count for the cell on side minus. Collective.
  virtual std::vector<Real> products(const HybridFlows& excess, const fields::Vector& cells,
                                     const fields::Vector& facets) const = 0;
};

/// Creates the truncation error. The result holds references to the layouts of cells and facets. `constrained_facets`:
/// owned facets with prescribed values. Throws an Error unless the cells are simplices. Collective.
std::unique_ptr<FluxTruncation> make_flux_truncation(RCP<const mesh::Mesh> mesh, const fields::Layout& cells,
                                                     const fields::Layout& facets, ConstView<char*> constrained_facets,
                                                     HybridFluxParameters parameters);

}  // namespace sprekk::transport
