// Smoother of a level above multigrid: Chebyshev's polynomial and exact solves on small sets of rows.
#pragma once

#include <memory>
#include <vector>

#include "multigrid/chebyshev.hpp"

namespace sprekk::multigrid {

using RowSets = std::vector<std::vector<LocalIndex>>;  ///< disjoint sets of owned rows with one unknown each

/// Exact inverses of the diagonal blocks of a matrix on sets of rows, by dense LU factors.
class Patches {
 public:
  explicit Patches(RowSets sets) : sets_(std::move(sets)), factors_(sets_.size()), pivots_(sets_.size()) {}

  /// Factorises the blocks of A. Throws an Error if one is singular. Local.
  void update(const NodeMatrix& A);

  /// Solves A_pp dx = (b - A x)_p for each set p and adds dx to x; b [owned], x [all]. Collective.
  void correct(const NodeMatrix& A, const ConstView<Real*>& b, const View<Real*>& x) const;

  bool empty() const { return sets_.empty(); }
  std::size_t bytes() const;

 private:
  RowSets sets_;
  std::vector<std::vector<Real>> factors_;  // [set] column by column
  std::vector<std::vector<int>> pivots_;
  mutable std::vector<Real> residual_;
};

/// Smoother S of a matrix with one unknown per node:
///   before the coarse correction  x = C b,             then x += B (b - A x),
///   after it                      x += B (b - A x),    then x += C (b - A x).
/// C is a Chebyshev polynomial, B the sum of the exact solves on the sets. For symmetric A, the second is the adjoint
/// of the first, and the cycle is symmetric. A set should contain rows with strong couplings that no polynomial
/// smooths and no coarse space represents, e.g. around flat cells. Without sets on any rank, S is C.
class PatchedSmoother {
 public:
  /// Collective.
  PatchedSmoother(const RCP<const Matrix>& A, RowSets sets);

  /// Prepares the values of a matrix with the same graph. Throws an Error on all ranks if a patch is singular.
  /// Collective.
  void update(const RCP<const Matrix>& A, int degree);
  void widen() { chebyshev_.widen(); }  ///< see Chebyshev

  /// Vectors have one column. Collective.
  void before(const MultiVector& b, MultiVector& x) const;
  void after(const MultiVector& b, MultiVector& x) const;

  double bytes() const { return static_cast<double>(chebyshev_.bytes() + patches_.bytes()); }

 private:
  NodeMatrix A_;
  Chebyshev chebyshev_;
  Patches patches_;
  bool has_patches_;   // on any rank
  View<Real*> x_, r_;  // [all], [owned]
};

}  // namespace sprekk::multigrid
