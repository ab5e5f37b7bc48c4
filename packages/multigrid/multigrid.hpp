// Multigrid on blocks of nodes.
#pragma once

#include "multigrid/chebyshev.hpp"
#include "multigrid/direct_inverse.hpp"
#include "multigrid/fewer_ranks.hpp"
#include "multigrid/galerkin.hpp"
#include "multigrid/options.hpp"

namespace sprekk::multigrid {

/// About the inverse of a matrix: one V-cycle of smoothed aggregation. The graphs of all levels are made once. Levels
/// of whose matrices ranks would have little move to fewer ranks, the last ones to one. Each piece of rock keeps at
/// least one node on every level. It throws where the last level is singular. All members are collective unless they
/// return stored data.
class Multigrid : public fields::Operator {
 public:
  /// Whether there is code for that many unknowns of a node and motions.
  static bool can_solve(int n_components, int n_modes);

  /// Aggregates of `nodes`, of a matrix that has the graph of those that follow or less and no edge across an
  /// interface, so no aggregate of any level reaches across one. `modes` [unknown, mode], null for the constant ones.
  Multigrid(const RCP<const Matrix>& matrix, Nodes nodes, int n_components, const RCP<const MultiVector>& modes,
            const Options& options = {});
  /// Aggregates of the nodes of a matrix; `places` [node, dim], null: near and far neighbours are alike.
  Multigrid(const RCP<const Matrix>& matrix, const Matrix& bulk, int n_components, const RCP<const MultiVector>& modes,
            const RCP<const MultiVector>& places = Teuchos::null)
      : Multigrid(matrix, nodes_of(node_matrix(bulk, n_components), modes, places), n_components, modes) {}

  /// Makes ready for the values of a matrix with the graph of the first. `careful`: if it is not symmetric, tries a
  /// cycle, and smooths less if the residual grows much in it.
  void setup(const RCP<const Matrix>& matrix, bool symmetric, bool careful = true);

  RCP<const Map> getDomainMap() const override { return map_; }
  RCP<const Map> getRangeMap() const override { return map_; }
  void apply(const MultiVector& b, MultiVector& y, Teuchos::ETransp, Real alpha, Real beta) const override;

  /// Entries of the matrices of all levels over those of the finest.
  double operator_complexity() const { return operator_complexity_; }
  double bytes() const;        ///< that this rank has stored
  double cycle_bytes() const;  ///< of matrices that this rank reads in a V-cycle
  /// What this rank receives in a V-cycle, without the solve on the last level.
  struct Traffic {
    double messages = 0, bytes = 0;
  };
  Traffic traffic() const;
  int n_levels() const { return static_cast<int>(levels_.size()); }
  std::vector<GlobalIndex> n_unknowns() const;                  ///< [level], all ranks; collective
  const std::vector<int>& n_ranks() const { return n_ranks_; }  ///< [level] that have some of them

 private:
  struct Level {
    NodeMatrix A;
    std::unique_ptr<Chebyshev> smoother;
    std::unique_ptr<FewerRanks> moved;    // null: its nodes are where the level above has made them
    std::unique_ptr<Galerkin> to_coarse;  // null: the last level
    View<Real*> b, x, r;                  // [owned, and those handed over], none on the finest level; [all], [all]
    int degree;                           // of the smoother, of a symmetric matrix
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
  bool shares_ = false;  // the finest level has the values of the matrix itself, on all ranks
  std::vector<Level> levels_;
  std::vector<int> n_ranks_;  // [level]
  RCP<CrsMatrix> last_matrix_;
  RCP<DirectInverse> last_;
};

}  // namespace sprekk::multigrid
