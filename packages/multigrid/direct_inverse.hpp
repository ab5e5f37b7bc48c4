// Inverse of a matrix that is small enough for one or a few ranks.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "multigrid/mumps.hpp"

namespace sprekk::multigrid {

/// Inverse by factors, for the last level of multigrid and for blocks that are solved directly. MUMPS factorises on the
/// first ranks, as many as are useful. For few unknowns, calls of MUMPS would dominate, so dense factors are on every
/// rank. The graph must not change.
class DirectInverse : public fields::Operator {
 public:
  static constexpr int max_dense = 300;          ///< largest number of unknowns for dense factors
  static constexpr int minimum_per_rank = 2000;  ///< unknowns; twice as many gain little on two ranks

  /// Prepares the factors. `name` begins error messages. On several ranks, the last bits vary. Collective.
  DirectInverse(const RCP<const CrsMatrix>& A, const std::string& name, int max_ranks = 1);

  /// Factorises the present values. Throws an Error on all ranks if they are singular. Collective.
  void setup(bool symmetric);

  /// Return the floating-point operations of the last setup() and the entries of the factors; 0: dense. Stored data.
  Real operations() const { return mumps_ ? mumps_->operations() : 0; }
  Real entries() const { return mumps_ ? mumps_->entries() : 0; }

  RCP<const fields::Map> getDomainMap() const override { return map_; }
  RCP<const fields::Map> getRangeMap() const override { return map_; }
  /// Computes y = A^-1 b. Throws an Error if MUMPS fails.
  void apply(const fields::MultiVector& b, fields::MultiVector& y, Teuchos::ETransp, Real, Real) const override;

 private:
  void factor_dense();
  void solve_dense(const Vector& b, Vector& x) const;

  std::string name_;
  RCP<const fields::Map> map_;
  RCP<const CrsMatrix> A_;  // numbered from 0 without gaps; shares the values of the original matrix
  mutable Vector from_, to_;
  std::unique_ptr<Mumps> mumps_;  // null: dense
  std::vector<Real> factors_;     // whole matrix, column by column
  std::vector<int> pivots_;
  mutable std::vector<Real> part_, whole_;  // of a vector: values of this rank, zero elsewhere; all values
};

}  // namespace sprekk::multigrid
