// The inverse of a matrix that is small enough for one rank.
#pragma once

#include "solve/linear_solver.hpp"

namespace sprekk::solve {

/// By factors on rank 0, for multigrid's last level and the rows around crack tips. The graph must stay as it is.
class DirectInverse : public fields::Operator {
 public:
  /// `name` begins the messages of errors. Collective.
  DirectInverse(const RCP<const CrsMatrix>& A, const std::string& name);

  /// Factors the present values. Collective.
  void setup(bool symmetric);

  RCP<const fields::Map> getDomainMap() const override { return map_; }
  RCP<const fields::Map> getRangeMap() const override { return map_; }
  /// y <- A^-1 b.
  void apply(const fields::MultiVector& b, fields::MultiVector& y, Teuchos::ETransp, Real, Real) const override;

 private:
  std::string name_;
  RCP<const fields::Map> map_;
  RCP<const CrsMatrix> A_;  // numbered from 0 without gaps; with the values of the matrix it was made of
  std::unique_ptr<LinearSolver> solver_;
};

}  // namespace sprekk::solve
