// What the rows of the hybrid form leave over where unknowns are those of the exact solution.
#pragma once

#include "physics/hybrid_error.hpp"

#include <memory>
#include <vector>

namespace sprekk::physics {

/// Parts of the rows of a balance that a scheme leaves over, as HybridError or an upwind flow says.
class FluxTruncation {
 public:
  virtual ~FluxTruncation() = default;

  virtual void set_transmissivity(std::vector<Real> of_local_faces) = 0;
  /// Of potentials, [owned unknown]. Collective.
  virtual HybridFlows flows(const fields::Vector& cells, const fields::Vector& facets) const = 0;
  /// The flows q_i that differences of potentials c_i make: a form c . q_v is the form q . (v_K - v_i).
  virtual HybridFlows flows(const HybridFlows& differences) const = 0;
  /// Adds by how much flows Q of a fluid carry too much, `capacity` for each volume and unit: upwind T_K in place of
  /// the T_i of a facet, -Q (T_i - T_K), with the gradient of the T_K around. Collective.
  virtual void add_upwind(const HybridFlows& carrying, Real capacity, const fields::Vector& cells,
                          const fields::Vector& facets, HybridFlows& excess) const = 0;

  /// Adds to the rows of cells, and with the other sign to those of facets. Collective.
  virtual void add_to_rows(const HybridFlows& excess, fields::Vector& cells, fields::Vector& facets) const = 0;
  /// Adds values of local facets. Collective.
  virtual void add_over_ranks(const std::vector<Real>& local, fields::Vector& facets) const = 0;
  /// Adds in the rows of prescribed facets what the value in the middle of each is less than the mean. Collective.
  virtual void add_prescribed(Real t, fields::Vector& facets) const = 0;
  /// [owned cell] sum of |excess_i (v_K - v_i)|, of fracture faces in the cell on side minus. Collective.
  virtual std::vector<Real> products(const HybridFlows& excess, const fields::Vector& cells,
                                     const fields::Vector& facets) const = 0;
};

/// Refers to the layouts, of cells and of facets; `held_facets`: the owned ones that are prescribed. Collective.
std::unique_ptr<FluxTruncation> make_flux_truncation(RCP<const mesh::Mesh> mesh, const fields::Layout& cells,
                                                     const fields::Layout& facets, ConstView<char*> held_facets,
                                                     HybridFluxParameters parameters);

}  // namespace sprekk::physics
