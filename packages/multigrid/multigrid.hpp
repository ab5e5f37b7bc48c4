// Multigrid for matrices of node blocks.
#pragma once

#include "multigrid/chebyshev.hpp"
#include "multigrid/direct_inverse.hpp"
#include "multigrid/fewer_ranks.hpp"
#include "multigrid/galerkin.hpp"
#include "multigrid/options.hpp"

namespace sprekk::multigrid {

/// Approximate inverse of a matrix: one V-cycle of smoothed aggregation. The graphs of all levels are created once.
/// Levels with small matrices per rank move to fewer ranks, the last ones to one. Each piece of rock keeps at least one
/// node on every level. Throws an Error if the last level is singular. All members are collective unless they return
/// stored data.
class Multigrid : public fields::Operator {
 public:
  /// Returns whether there is compiled code for this number of unknowns per node and modes.
  static bool can_solve(int n_components, int n_modes);

  /// Creates the levels from aggregates of `nodes`. These must belong to a matrix whose graph is a subset of that of
  /// later matrices and has no edge across an interface. No aggregate of any level then crosses an interface. modes:
  /// [unknown, mode], null for constants.
  Multigrid(const RCP<const Matrix>& matrix, Nodes nodes, int n_components, const RCP<const MultiVector>& modes,
            const Options& options = {});
  /// Creates the levels from the nodes of the matrix `bulk`. places: [node, dim], m; null: all neighbours count as
  /// near.
  Multigrid(const RCP<const Matrix>& matrix, const Matrix& bulk, int n_components, const RCP<const MultiVector>& modes,
            const RCP<const MultiVector>& places = Teuchos::null)
      : Multigrid(matrix, nodes_of(node_matrix(bulk, n_components), modes, places), n_components, modes) {}

  /// Prepares the values of a matrix with the graph of the first one. `careful`: for nonsymmetric matrices, tries a
  /// cycle and reduces the smoothing if the residual grows strongly.
  void setup(const RCP<const Matrix>& matrix, bool symmetric, bool careful = true);

  RCP<const Map> getDomainMap() const override { return map_; }
  RCP<const Map> getRangeMap() const override { return map_; }
  void apply(const MultiVector& b, MultiVector& y, Teuchos::ETransp, Real alpha, Real beta) const override;

  /// Returns the matrix entries of all levels, relative to the finest.
  double operator_complexity() const { return operator_complexity_; }
  double bytes() const;        ///< stored on this rank
  double cycle_bytes() const;  ///< of matrices read by this rank in a V-cycle
  /// Messages and bytes received by this rank in a V-cycle, without the solve on the last level.
  struct Traffic {
    double messages = 0, bytes = 0;
  };
  Traffic traffic() const;
  int n_levels() const { return static_cast<int>(levels_.size()); }
  std::vector<GlobalIndex> n_unknowns() const;                  ///< [level], over all ranks; collective
  const std::vector<int>& n_ranks() const { return n_ranks_; }  ///< [level] number of ranks with unknowns

 private:
  struct Level {
    NodeMatrix A;
    std::unique_ptr<Chebyshev> smoother;
    std::unique_ptr<FewerRanks> moved;    // null: nodes are on the ranks of the level above
    std::unique_ptr<Galerkin> to_coarse;  // null: the last level
    View<Real*> b, x, r;                  // [owned, and transferred], empty on the finest level; [all], [all]
    int degree;                           // of the smoother for symmetric matrices
  };

  void add_level(const NodeMatrix& A, std::unique_ptr<FewerRanks> moved);
  std::unique_ptr<FewerRanks> on_fewer_ranks(const Galerkin& galerkin, Nodes& nodes) const;
  const ShortNodeMatrix& prolongation(std::size_t level) const;
  void factor_last(bool symmetric);
  Real growth() const;
  void cycle(std::size_t level, const ConstView<Real*>& b) const;
  void solve_last(const ConstView<Real*>& b) const;

  RCP<const Map> map_;
  RCP<const Matrix> finest_;
  int size_;
  Options options_;
  double operator_complexity_ = 1;
  bool shares_ = false;  // the finest level shares the values of the matrix on all ranks
  std::vector<Level> levels_;
  std::vector<int> n_ranks_;  // [level]
  RCP<CrsMatrix> last_matrix_;
  RCP<DirectInverse> last_;
};

}  // namespace sprekk::multigrid
