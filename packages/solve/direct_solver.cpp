// Factors of MUMPS, and refinement of what they give.
#include <algorithm>
#include <limits>

#include "base/check.hpp"
#include "multigrid/mumps.hpp"
#include "solve/linear_solver.hpp"

namespace sprekk::solve {
namespace {

class DirectSolver : public LinearSolver {
 public:
  DirectSolver(const Teuchos::ParameterList& controls, int most_ranks) : mumps_(controls, most_ranks) {}

  bool reads_matrix() const override { return true; }

  std::string setup(const LinearSystem& system) override {
    matrix_ = system.matrix;
    balances_ = std::any_of(system.diagonal.begin(), system.diagonal.end(),
                            [](const auto& part) { return part.block.balance; });
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
    report.converged = report.residual <= acceptable;
    if (!report.converged)
      report.reason = fmt::format(
          "direct solve: relative residual {:.1e}, at most {:.0e} is acceptable: the matrix is "
          "singular or nearly so",
          report.residual, acceptable);
    return report;
  }

  const Teuchos::ParameterList& parameters() const override { return mumps_.parameters(); }

 private:
  /// Relative residual that rounding leaves: each row is known to the rounding of its diagonal times the unknown, which
  /// may be large next to b, where bodies are all but free or balances of rates differ by many orders of magnitude.
  Real noise(const Vector& b, const Vector& x) const {
    Vector Dx(x.getMap());
    matrix_->getLocalDiagCopy(Dx);
    Dx.elementWiseMultiply(1, x, Dx, 0);
    return std::min(64 * std::numeric_limits<Real>::epsilon() * Dx.norm2() / b.norm2(),
                    balances_ ? most_noise_of_rates : most_noise);
  }

  static constexpr Real most_noise = 1e-2, most_noise_of_rates = 0.5;
  multigrid::Mumps mumps_;
  RCP<const CrsMatrix> matrix_;
  bool balances_ = false;
  std::string failure_ = "the matrix was not set up";
};

}  // namespace

std::unique_ptr<LinearSolver> make_direct_solver(const Teuchos::ParameterList& mumps, int most_ranks) {
  return std::make_unique<DirectSolver>(mumps, most_ranks);
}

}  // namespace sprekk::solve
