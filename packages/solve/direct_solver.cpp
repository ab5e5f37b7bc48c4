// Direct solver with MUMPS factors and iterative refinement.
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.hpp"
#include "multigrid/mumps.hpp"
#include "solve/krylov.hpp"
#include "solve/linear_solver.hpp"

namespace sprekk::solve {
namespace {

/// Factors as an operator.
class Factors : public fields::Operator {
 public:
  Factors(multigrid::Mumps& mumps, RCP<const fields::Map> map) : mumps_(mumps), map_(map) {}
  RCP<const fields::Map> getDomainMap() const override { return map_; }
  RCP<const fields::Map> getRangeMap() const override { return map_; }
  void apply(const fields::MultiVector& x, fields::MultiVector& y, Teuchos::ETransp, Real alpha,
             Real beta) const override {
    fields::MultiVector z(map_, x.getNumVectors());
    SPREKK_CHECK(mumps_.substitute(x, z).empty(), "substitution failed");
    y.update(alpha, z, beta);
  }

 private:
  multigrid::Mumps& mumps_;
  RCP<const fields::Map> map_;
};

class DirectSolver : public LinearSolver {
 public:
  DirectSolver(const Teuchos::ParameterList& controls, int max_ranks) : mumps_(controls, max_ranks) {}

  bool reads_matrix() const override { return true; }

  std::string setup(const LinearSystem& system) override {
    matrix_ = system.matrix;
    balances_ = std::any_of(system.diagonal.begin(), system.diagonal.end(),
                            [](const auto& part) { return part.block.balance; });
    factors_ = rcp(new Factors(mumps_, matrix_->getRowMap()));
    return failure_ = mumps_.factor(matrix_, system.symmetric);
  }

  LinearReport solve(const Vector& b, Vector& x, Real tolerance) override {
    LinearReport report;
    x.putScalar(0);
    if (!failure_.empty()) {
      report.reason = failure_;
      return report;
    }
    report.iterations = 1;
    Vector r(b, Teuchos::Copy), dx(x.getMap()), best(x, Teuchos::Copy);
    report.residual = 1;
    for (int refinement = 0; refinement <= 3 && report.residual > 1e-2 * tolerance; ++refinement) {
      report.reason = mumps_.substitute(r, dx);
      if (!report.reason.empty()) return report;
      x.update(1, dx, 1);
      const Real residual = relative_residual(*matrix_, b, x, r);
      if (refinement > 0 && !(residual < report.residual)) break;
      const bool slow = refinement > 0 && residual > 0.1 * report.residual;
      report.residual = residual;
      Tpetra::deep_copy(best, x);
      if (slow) break;
    }
    Tpetra::deep_copy(x, best);
    const Real acceptable = std::max(acceptable_linear_residual, noise(b, x));
    if (!(report.residual <= acceptable)) correct(b, x, acceptable, report);
    report.converged = report.residual <= acceptable;
    if (!report.converged)
      report.reason = fmt::format(
          "direct solve: relative residual {:.1e} after refinement and {} iterations of GMRES with the factors, at "
          "most {:.0e} is acceptable: the matrix is singular or nearly so",
          report.residual, report.iterations - 1, acceptable);
    return report;
  }

  const Teuchos::ParameterList& parameters() const override { return mumps_.parameters(); }
  RCP<const fields::Operator> preconditioner() const override { return factors_; }
  Work work() const override { return {mumps_.operations(), mumps_.operations_of_substitution()}; }

 private:
  /// Returns the relative residual caused by round-off: in each row, round-off of the diagonal times the unknown. It
  /// may be large relative to b for nearly floating bodies, or if balances differ by many orders of magnitude.
  /// Collective.
  Real noise(const Vector& b, const Vector& x) const {
    Vector Dx(x.getMap());
    matrix_->getLocalDiagCopy(Dx);
    Dx.elementWiseMultiply(1, x, Dx, 0);
    return std::min(64 * std::numeric_limits<Real>::epsilon() * Dx.norm2() / b.norm2(),
                    balances_ ? max_noise_of_rates : max_noise);
  }

  /// Corrects x by GMRES preconditioned by the factors. It permits less accurate factors than refinement, which
  /// requires a small residual after one substitution (Carson and Higham 2017). Adds to the iterations.
  void correct(const Vector& b, Vector& x, Real acceptable, LinearReport& report) {
    Vector r(b.getMap()), dx(x.getMap());
    const Real before = relative_residual(*matrix_, b, x, r);
    if (!std::isfinite(before)) return;
    try {
      report.iterations += krylov(matrix_, factors_, krylov_defaults(), "Block GMRES", r, dx,
                                  std::min(0.1 * acceptable / before, 0.1), max_corrections)
                               .iterations;
    } catch (const std::exception&) {
      return;  // keep the result of refinement
    }
    dx.update(1, x, 1);
    const Real after = relative_residual(*matrix_, b, dx, r);
    if (!(after < report.residual)) return;
    report.residual = after;
    Tpetra::deep_copy(x, dx);
  }

  static constexpr int max_corrections = 30;
  static constexpr Real max_noise = 1e-2, max_noise_of_rates = 0.5;
  multigrid::Mumps mumps_;
  RCP<const CrsMatrix> matrix_;
  RCP<const Factors> factors_;
  bool balances_ = false;
  std::string failure_ = "the matrix was not set up";
};

}  // namespace

std::unique_ptr<LinearSolver> make_direct_solver(const Teuchos::ParameterList& mumps, int max_ranks) {
  return std::make_unique<DirectSolver>(mumps, max_ranks);
}

}  // namespace sprekk::solve
