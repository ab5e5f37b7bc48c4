// Prolongator by smoothed aggregation, and the coarse matrix.
#pragma once

#include "multigrid/aggregates.hpp"
#include "multigrid/slices.hpp"

namespace sprekk::multigrid {

/// P = (I - w D^-1 A) T, R = T^T (I - w A D^-1) and R A P of a matrix A with a constant graph and changing values. T is
/// the tentative prolongator of aggregates, D the diagonal of A (Vanek, Mandel and Brezina 1996). For nonsymmetric A, R
/// is P^T of the transposed matrix (Sala and Tuminaro 2008).
/// - In P and R, blocks of A between nodes out of reach are added to the diagonal. Otherwise coarse rows would grow too
///   long for flat cells.
/// - Graphs are made once. Positions in rows are found by a cursor, as columns are in order, except for ghosts. Stored
///   positions would require more memory and save almost no time.
/// - Only a slice of A P exists at a time.
/// - P and R are stored in single precision. R A P is the product of the stored matrices. With one unknown per node,
///   entries of P are rounded so that the sums of its rows are exact. Otherwise constants in a part that is stiffer
///   than its surroundings by more than 1e8 would have energy. R of nonsymmetric A is rounded entry by entry.
/// - Coarse nodes are aggregates with numbers increasing with the ranks. Their unknowns are modes. R has the graph of
///   P^T.
class Galerkin {
 public:
  /// Creates the graphs. tentative: [owned node, unknown, mode]. Collective.
  Galerkin(const NodeMatrix& A, const Nodes& nodes, const Aggregates& aggregates, const std::vector<Real>& tentative);

  /// Computes the matrices for the present values of A. inverse_diagonal: w D^-1, [all nodes, unknown]. Collective.
  void update(const NodeMatrix& A, const View<Real*>& inverse_diagonal, bool symmetric);

  const ShortNodeMatrix& prolongation() const { return P_; }  ///< [fine, coarse]
  const ShortNodeMatrix& restriction() const { return R_; }   ///< [coarse, fine]
  const NodeMatrix& coarse() const { return coarse_; }
  const View<LocalIndex*>& aggregate() const { return aggregate_; }  ///< [all nodes] column of P; -1: none
  std::size_t bytes() const;  ///< of values, and of columns used by products only

 private:
  void find_members(const Aggregates& aggregates);
  void smooth(const NodeMatrix& A, const View<Real*>& inverse_diagonal) const;
  void restrict_symmetric() const;
  void restrict_general(const NodeMatrix& A, const View<Real*>& inverse_diagonal) const;
  void multiply_right(const NodeMatrix& A, const View<Real*>& AP, std::size_t first_made, std::size_t end_made) const;
  void multiply_left(const View<Real*>& AP, LocalIndex first, LocalIndex end) const;

  NodeGraph fine_;                  // graph of A
  View<float*> tentative_;          // [all nodes, unknown, mode]
  View<std::size_t*> start_P_all_;  // rows of P, including ghosts; values of ghost rows follow the owned ones
  View<LocalIndex*> column_P_all_;
  View<float*> value_P_all_;
  View<std::size_t*> start_AP_all_;  // likewise for A P, of which only slices exist
  View<LocalIndex*> column_AP_all_;
  View<LocalIndex*> aggregate_;      // [all nodes]
  View<std::uint64_t*> far_;         // bit e % 64 of word e / 64: entry e of A is out of reach; empty: none
  View<std::size_t*> first_member_;  // [coarse row]
  View<LocalIndex*> member_;
  Slices slices_;  // of A P
  ShortNodeMatrix P_, R_;
  NodeMatrix coarse_;
};

}  // namespace sprekk::multigrid
