// What makes upwind advection one of second order, without new extremes.
#pragma once

#include "fields/layout.hpp"
#include "mesh/facets.hpp"

#include <array>
#include <vector>

namespace sprekk::physics {

/// Entities with ends: which other entity has the same end, if just one has, and places.
struct EndGraph {
  int n_ends;
  std::vector<LocalIndex> neighbour;              ///< [local entity * n_ends + end]; -1: none
  std::vector<int> end;                           ///< likewise: the end of the neighbour
  std::vector<std::array<Real, 3>> centre, away;  ///< [local entity] m; [local entity * n_ends + end] from there
};
/// Cells and their faces; faces of fractures are no neighbours.
EndGraph end_graph_of_cells(const mesh::Mesh& mesh);
/// Fracture faces and their ridges; those in which more or less than two faces end have no neighbours.
EndGraph end_graph_of_fractures(const mesh::Mesh& mesh);

/// Flux correction (Zalesak 1979), linearised about the upwind state of implicit Euler (Kuzmin 2009), once per step. At
/// the end of a step of length dt the flow c q > 0 that leaves K through end i towards L has carried too little by
///   f_i = dt c q (G_K . d_i - s_i (u_i - u_K) - (u_K - u_K,old)/2),   s_i = |d_L|/(|d_K| + |d_L|)
/// against a flux of second order in space and time, with the gradient G_K by least squares over neighbours; what is
/// conducted to the end, whose u_i lies towards u_K by the flow, brings the second part already. f_i counts
/// where it has the sign of u_L - u_K, times a factor from 0 to 1, so that no u_K + sum(+-f)/C_K leaves the range of
/// u_K, its neighbours and its ends, C_K being what K stores per u. The sums are what K gains at the start of the next
/// step: no more than is gained elsewhere, and between extremes that are there.
class Antidiffusion {
 public:
  using Kept = View<Real**>::HostMirror;

  /// Collective.
  Antidiffusion(const mesh::Mesh& mesh, fields::Entity entity, EndGraph graph);

  /// Columns to be kept of owned entities from the end of a step to the next: f [end], u, largest, least, C.
  static int n_kept(int n_ends) { return n_ends + 4; }
  /// u and c q of local entities and of their ends, C of owned entities; dt = 0: no step.
  void keep(const std::vector<Real>& u, const std::vector<Real>& of_ends, const std::vector<Real>& flow,
            const std::vector<Real>& stored, Real dt, const Kept& kept) const;
  /// What owned entities gain. Collective.
  std::vector<Real> gains(const Kept& kept) const;

 private:
  LocalIndex n_local() const { return static_cast<LocalIndex>(graph_.centre.size()); }
  std::array<Real, 3> gradient(LocalIndex e, const std::vector<Real>& u, const std::vector<Real>& of_ends) const;
  Real share(std::size_t k) const;

  EndGraph graph_;
  fields::Layout of_ends_, of_bounds_;
};

}  // namespace sprekk::physics
