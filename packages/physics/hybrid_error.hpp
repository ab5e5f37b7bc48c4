// How far the fluxes of the hybrid form are off, told by a potential that is continuous.
#pragma once

#include "assembly/rates.hpp"
#include "physics/hybrid_flux.hpp"
#include "physics/mesh_error.hpp"

#include <memory>

namespace sprekk::physics {

struct HybridErrorParameters {
  HybridFluxParameters flow = {};
  std::vector<Real> storage = {};  ///< [owned cell] 1/Pa; empty: nothing is stored
};

/// For fluxes q_h that are in balance and any continuous potential s with the values that are prescribed (Prager and
/// Synge 1947)
///   |q_h - q|^2 + |K grad(s - p)|^2 = |q_h + K grad s|^2,   |v|^2 = integral v . K^-1 v,
/// summed over rock and fractures, and on sides that resist, R per area, |v|^2 = integral R v_n^2, with the jump of s
/// over R for K grad s. In each cell a quadratic p~ has -K grad p~ = q_h and the mean p_K (Vohralik 2010); s is
/// quadratic, too: in each place the mean of p~ over the cells around it, weighted by their mobility. Rock is split
/// along fractures, which have an s of their own (Varela et al. 2023); where they meet, both are such that the sum of
/// the squares
///   sum w_K (s - p~_K)^2 + sum A/R (s - s_F - R q_n)^2 + sum T_F/h (s_F - p~_F)^2
/// is the least: equal without a resistance. Some steps of Jacobi's method then bring |q_h + K grad s| close to the
/// least. Simplices with the scheme rt0.
///
/// Components that are none of the energy are of functionals alone. In 2D fluxes along fractures are of two points: as
/// if something resisted between a face and its middle, h/(6 T). On the boundary the pressure in the middle of a face
/// is not its mean, with the flow there as the answer's part. A source, less what is stored per time, is other than its
/// mean in a cell, and so is the answer's potential.
class HybridError {
 public:
  virtual ~HybridError() = default;
  virtual const std::vector<LocalIndex>& cells() const = 0;
  virtual std::size_t n_of_energy() const = 0;
  /// Of potentials on cells and on facets, [owned unknown]; `answer`: small changes of these. Collective.
  /// What is stored is since the two states of which this was asked before, or the initial one.
  virtual MeshError::Parts of_state(const fields::Vector& cells, const fields::Vector& facets, Real t,
                                    const assembly::Rates& rates) = 0;
  virtual MeshError::Parts of_answer(const fields::Vector& cells, const fields::Vector& facets,
                                     const fields::Vector& d_cells, const fields::Vector& d_facets) const = 0;

  /// A linear form of potentials v and their flows q_v, with what is added up over an entity's ends.
  struct Forces {
    std::vector<Real> on_cells, on_facets;  ///< times v, [owned cell], [local facet]
    HybridFlows on_flows;                   ///< times q_v
  };
  /// -e . e_v of components e of the last state that was asked for and of an answer v, but for what v needs where a
  /// potential is prescribed; v's potential begins as the means of v alone, whatever resists. Collective.
  virtual Forces forces(const std::vector<Real>& e) const = 0;
  virtual void set_transmissivity(std::vector<Real> of_local_faces) = 0;
};

/// Refers to the layouts, of cells and of facets; `held_facets`: the owned ones that are prescribed. Collective.
std::unique_ptr<HybridError> make_hybrid_error(RCP<const mesh::Mesh> mesh, const fields::Layout& cells,
                                               const fields::Layout& facets, ConstView<char*> held_facets,
                                               HybridErrorParameters parameters);

}  // namespace sprekk::physics
