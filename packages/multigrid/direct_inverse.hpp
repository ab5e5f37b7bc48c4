// The inverse of a matrix that is small enough for one rank, or a few.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "multigrid/mumps.hpp"

namespace sprekk::multigrid {

/// By factors, for multigrid's last level and blocks that are solved directly: those of MUMPS on the first ranks, as
/// many as gain from it; of few unknowns, for which calls of MUMPS take longer than the work, dense ones on every rank.
/// The graph must stay as it is.
class DirectInverse : public fields::Operator {
 public:
  static constexpr int most_dense = 300;        ///< unknowns
  static constexpr int least_of_a_rank = 2000;  ///< unknowns: two ranks gain little from sharing twice as many

  /// `name` begins the messages of errors. Of several ranks, the last bits vary. Collective.
  DirectInverse(const RCP<const CrsMatrix>& A, const std::string& name, int most_ranks = 1);

  /// Factors the present values. Throws where they are singular. Collective.
  void setup(bool symmetric);

  RCP<const fields::Map> getDomainMap() const override { return map_; }
  RCP<const fields::Map> getRangeMap() const override { return map_; }
  /// y <- A^-1 b.
  void apply(const fields::MultiVector& b, fields::MultiVector& y, Teuchos::ETransp, Real, Real) const override;

 private:
  void factor_dense();
  void solve_dense(const Vector& b, Vector& x) const;

  std::string name_;
  RCP<const fields::Map> map_;
  RCP<const CrsMatrix> A_;  // numbered from 0 without gaps; with the values of the matrix it was made of
  mutable Vector from_, to_;
  std::unique_ptr<Mumps> mumps_;  // null: dense
  std::vector<Real> factors_;     // of the whole matrix, column by column
  std::vector<int> pivots_;
  mutable std::vector<Real> part_, whole_;  // of a vector: what this rank has, zero elsewhere; all of it
};

}  // namespace sprekk::multigrid
