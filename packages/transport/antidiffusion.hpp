// Flux correction that makes upwind advection second-order accurate without new extrema.
#pragma once

#include "fields/layout.hpp"
#include "mesh/facets.hpp"

#include <array>
#include <vector>

namespace sprekk::transport {

/// Connectivity of entities through their ends. Two entities are neighbours if they alone share an end.
struct EndGraph {
  int n_ends;
  std::vector<LocalIndex> neighbour;              ///< [local entity * n_ends + end]; -1: none
  std::vector<int> end;                           ///< [local entity * n_ends + end] end of the neighbour
  std::vector<std::array<Real, 3>> centre, away;  ///< m; centre [local entity], and away [local entity * n_ends + end],
                                                  ///< from centre to end
};
/// Graph of cells and their faces. Faces on fractures have no neighbours.
EndGraph end_graph_of_cells(const mesh::Mesh& mesh);
/// Graph of fracture faces and their ridges. Ridges with one face or more than two have no neighbours.
EndGraph end_graph_of_fractures(const mesh::Mesh& mesh);

/// Flux correction (Zalesak 1979), linearised about the upwind state of implicit Euler (Kuzmin 2009), once per step. At
/// the end of a step of length dt, the deficit of the flow c q > 0 from K to L through end i against a second-order
/// flux is
///   f_i = dt c q (G_K . d_i - s_i (u_i - u_K) - (u_K - u_K,old)/2),   s_i = |d_L|/(|d_K| + |d_L|).
/// G_K is the least-squares gradient over the neighbours. The second term is already supplied by conduction to the end,
/// whose u_i the flow moves towards u_K.
///
/// f_i counts only if it has the sign of u_L - u_K. A factor from 0 to 1 keeps each u_K + sum(+-f)/C_K within the range
/// of u_K, its neighbours and its ends, where C_K is the storage capacity of K. These sums are the gains of K at the
/// start of the next step. They are conservative and create no new extrema.
class Antidiffusion {
 public:
  using Stored = View<Real**>::HostMirror;

  /// Sets up the communication between neighbours. Collective.
  Antidiffusion(const mesh::Mesh& mesh, fields::Entity entity, EndGraph graph);

  /// Number of history columns of owned entities: f [end], u, largest u, least u, C.
  static int n_saved(int n_ends) { return n_ends + 4; }
  /// Computes the history at the end of a step. `u`, `of_ends` and `flow` (c q): local entities and their ends.
  /// `stored`: C of owned entities. dt = 0: no step.
  void keep(const std::vector<Real>& u, const std::vector<Real>& of_ends, const std::vector<Real>& flow,
            const std::vector<Real>& stored, Real dt, const Stored& saved) const;
  /// Gains of owned entities. Collective.
  std::vector<Real> gains(const Stored& saved) const;

 private:
  std::array<Real, 3> gradient(LocalIndex e, const std::vector<Real>& u, const std::vector<Real>& of_ends) const;
  Real share(std::size_t k) const;

  EndGraph graph_;
  fields::Layout of_ends_, of_bounds_;
};

}  // namespace sprekk::transport
