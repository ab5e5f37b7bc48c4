// From one level of multigrid to the next: interpolation by smoothed aggregation, and the coarse matrix.
#pragma once

#include "multigrid/aggregates.hpp"
#include "multigrid/slices.hpp"

namespace sprekk::multigrid {

/// P = (I - w D^-1 A) T, R = T^T (I - w A D^-1) and R A P of a matrix A whose values change and whose graph does not,
/// with T the tentative prolongator of aggregates and D the diagonal of A (Vanek, Mandel and Brezina 1996; R of a
/// matrix that is not symmetric is P^T of its transpose: Sala and Tuminaro 2008). In P and R, blocks of A between nodes
/// out of each other's reach are added to the diagonal, or levels would fill up where cells are flat. Graphs are made
/// once. Where a number goes in its row is found by walking along the row's columns, in whose order they come, but for
/// ghosts: to store the places takes more memory, and hardly less time. Of A P there is never more than a slice. P and
/// R are stored in single precision, and R A P is the product of what is stored. Coarse nodes are aggregates, numbered
/// through the ranks; their unknowns are modes. R has the graph of P^T.
class Galerkin {
 public:
  /// Makes the graphs. `tentative` [owned node, unknown, mode]. Collective.
  Galerkin(const NodeMatrix& A, const Nodes& nodes, const Aggregates& aggregates, const std::vector<Real>& tentative);

  /// Makes the matrices for the present values of A; `inverse_diagonal` [all nodes, unknown] is w D^-1. Collective.
  void update(const NodeMatrix& A, const View<Real*>& inverse_diagonal, bool symmetric);

  const ShortNodeMatrix& prolongation() const { return P_; }  ///< [fine, coarse]
  const ShortNodeMatrix& restriction() const { return R_; }   ///< [coarse, fine]
  const NodeMatrix& coarse() const { return coarse_; }
  const View<LocalIndex*>& aggregate() const { return aggregate_; }  ///< [all nodes] column of P, -1: none
  std::size_t bytes() const;  ///< of values, and of columns that only products need

 private:
  void find_members(const Aggregates& aggregates);
  void smooth(const NodeMatrix& A, const View<Real*>& inverse_diagonal) const;
  void restrict_symmetric() const;
  void restrict_general(const NodeMatrix& A, const View<Real*>& inverse_diagonal) const;
  void multiply_right(const NodeMatrix& A, const View<Real*>& AP, std::size_t first_made, std::size_t end_made) const;
  void multiply_left(const View<Real*>& AP, LocalIndex first, LocalIndex end) const;

  NodeGraph fine_;                  // of A
  View<float*> tentative_;          // [all nodes, unknown, mode]
  View<std::size_t*> start_P_all_;  // of rows of P, ghosts' included; their values follow the owned ones'
  View<LocalIndex*> column_P_all_;
  View<float*> value_P_all_;
  View<std::size_t*> start_AP_all_;  // the same of A P, of which there are slices only
  View<LocalIndex*> column_AP_all_;
  View<LocalIndex*> aggregate_;      // [all nodes]
  View<std::uint64_t*> far_;         // bit e % 64 of word e / 64: entry e of A is out of reach; empty: none is
  View<std::size_t*> first_member_;  // [coarse row]
  View<LocalIndex*> member_;
  Slices slices_;  // of A P
  ShortNodeMatrix P_, R_;
  NodeMatrix coarse_;
};

}  // namespace sprekk::multigrid
