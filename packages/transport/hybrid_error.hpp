// A-posteriori error of the fluxes of the hybrid form, from a continuous reconstruction of the potential.
#pragma once

#include "assembly/rates.hpp"
#include "transport/hybrid_flux.hpp"

#include <memory>

namespace sprekk::transport {

struct HybridErrorParameters {
  HybridFluxParameters flow = {};
  std::vector<Real> storage = {};  ///< [owned cell] storage coefficient, 1/Pa; empty: no storage
};

/// Error of fluxes q_h that satisfy the balance. For any continuous potential s with the prescribed values (Prager and
/// Synge 1947)
///   |q_h - q|^2 + |K grad(s - p)|^2 = |q_h + K grad s|^2,   |v|^2 = integral v . K^-1 v,
/// summed over rock and fractures. On sides with a resistance R per area, |v|^2 = integral R v_n^2, and the jump of s
/// divided by R replaces K grad s.
///
/// Construction of s: in each cell a quadratic p~ has -K grad p~ = q_h and the mean p_K (Vohralik 2010). The quadratic
/// s is, at each place, the mean of p~ over the adjacent cells, weighted by their mobility. Fractures split the rock
/// and have a potential s_F of their own (Varela et al. 2023). Where rock and fracture meet, s and s_F minimise
///   sum w_K (s - p~_K)^2 + sum A/R (s - s_F - R q_n)^2 + sum T_F/h (s_F - p~_F)^2.
/// Without a resistance s = s_F. Some Jacobi steps then reduce |q_h + K grad s| almost to its minimum. Requires
/// simplices with the scheme rt0.
///
/// Further components contribute to functionals only, not to the energy:
///
/// - 2D: the distance of a well from the centre of its fracture face changes the resistance to both ends.
/// - On the boundary the pressure at the centre of a face differs from its mean. The factor of the adjoint solution is
///   its flow there.
/// - The source minus the storage rate varies in a cell. Its variation is multiplied by that of the adjoint potential.
class HybridError {
 public:
  struct Parts {
    std::vector<Real> error, whole;  ///< [component] of the error; the same for the total fluxes
  };

  virtual ~HybridError() = default;
  /// [component] owned cell to which the component belongs. Stored data.
  virtual const std::vector<LocalIndex>& cells() const = 0;
  /// Number of leading components that contribute to the energy. The others contribute to functionals only.
  virtual std::size_t n_of_energy() const = 0;
  /// Components of a state from potentials on cells and on facets, [owned unknown]. The storage rate refers to the two
  /// previous calls, or to the initial state. Collective.
  virtual Parts of_state(const fields::Vector& cells, const fields::Vector& facets, Real t,
                         const assembly::Rates& rates) = 0;
  /// Components of a small change (d_cells, d_facets) of these potentials. Collective.
  virtual Parts of_linearized(const fields::Vector& cells, const fields::Vector& facets, const fields::Vector& d_cells,
                              const fields::Vector& d_facets) const = 0;

  /// Linear form of potentials v and their flows q_v, summed over the ends of each entity.
  struct Forces {
    std::vector<Real> on_cells, on_facets;  ///< coefficients of v, [owned cell], [local facet]
    HybridFlows on_flows;                   ///< coefficients of q_v
  };
  /// Linear form -e . e_v, where e are components of the last state of of_state() and e_v those of a change v. Excludes
  /// the terms of v where a potential is prescribed. The reconstruction of v starts from the means of v alone, with any
  /// resistance. Collective.
  virtual Forces forces(const std::vector<Real>& e) const = 0;
  virtual void set_transmissivity(FaceTransmissivity present) = 0;
};

/// Creates the estimator. The result holds references to the layouts of cells and facets. `constrained_facets`: owned
/// facets with prescribed values. Throws an Error unless the cells are simplices. Collective.
std::unique_ptr<HybridError> make_hybrid_error(RCP<const mesh::Mesh> mesh, const fields::Layout& cells,
                                               const fields::Layout& facets, ConstView<char*> constrained_facets,
                                               HybridErrorParameters parameters);

}  // namespace sprekk::transport
