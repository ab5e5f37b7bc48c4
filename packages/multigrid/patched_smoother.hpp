// Smoother of a level above multigrid: Chebyshev's polynomial and exact solves on small sets of rows.
#pragma once

#include <memory>
#include <vector>

#include "fields/matrix.hpp"

namespace sprekk::multigrid {

using fields::Matrix;
using fields::MultiVector;

using RowSets = std::vector<std::vector<LocalIndex>>;  ///< disjoint sets of owned rows with one unknown each

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
  ~PatchedSmoother();

  /// Prepares the values of a matrix with the same graph. Throws an Error on all ranks if a patch is singular.
  /// Collective.
  void update(const RCP<const Matrix>& A, int degree);
  void widen();  ///< see Chebyshev

  /// Vectors have one column. Collective.
  void before(const MultiVector& b, MultiVector& x) const;
  void after(const MultiVector& b, MultiVector& x) const;

  double bytes() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace sprekk::multigrid
