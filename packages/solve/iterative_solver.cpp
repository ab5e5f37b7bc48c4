// Krylov methods of Belos, preconditioned from the right.
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/check.hpp"
#include "base/over_ranks.hpp"
#include "solve/krylov.hpp"
#include "solve/preconditioner.hpp"
#include "solve/reuse.hpp"

namespace sprekk::solve {
namespace {

using fields::MultiVector;
using fields::Operator;
using Teuchos::ParameterList;

/// Operator y = S A S x with a diagonal S.
class ScaledOperator : public Operator {
 public:
  ScaledOperator(RCP<const Operator> A, RCP<const Vector> S)
      : A_(A), S_(S), Sx_(A->getDomainMap(), 1), ASx_(A->getRangeMap(), 1) {}
  RCP<const fields::Map> getDomainMap() const override { return A_->getDomainMap(); }
  RCP<const fields::Map> getRangeMap() const override { return A_->getRangeMap(); }
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp mode, Real alpha, Real beta) const override {
    for (std::size_t v = 0; v < x.getNumVectors(); ++v) {
      const auto to = y.getVectorNonConst(v);
      Sx_.elementWiseMultiply(1, *S_, *x.getVector(v), 0);
      A_->apply(Sx_, ASx_, mode, 1, 0);
      to->elementWiseMultiply(alpha, *S_, ASx_, beta);
    }
  }

 private:
  RCP<const Operator> A_;
  RCP<const Vector> S_;
  mutable MultiVector Sx_, ASx_;
};

/// Sets scale[i] = 1/sqrt(diagonal of s A s) for the rows of a block, where s is its scale.
void scale_by_diagonal(const Matrix& A, Real s, Vector& scale) {
  A.copy_diagonal(scale);
  const auto values = scale.getLocalViewHost(Tpetra::Access::ReadWrite);
  for (std::size_t k = 0; k < values.extent(0); ++k)
    values(k, 0) = values(k, 0) > 0 ? 1 / (s * std::sqrt(values(k, 0))) : 1;
}

class IterativeSolver : public LinearSolver {
 public:
  IterativeSolver(const LinearSolverOptions& options, const std::vector<Block>& blocks)
      : options_(options.preconditioner),
        blocks_(blocks),
        reproducible_(options.reproducible.value_or(false)),
        by_cost_(options.type == "auto"),
        should_stop_(options.should_stop),
        parameters_("iterative") {
    check_krylov(options.belos, blocks.front().map->getComm());
    preconditioner_ = make_preconditioner(options_, blocks_, by_cost_);
    long long n = 0;
    for (const auto& block : blocks) n += block.map->getGlobalNumElements();
    // A matrix as small as a coarse level: multigrid would consist of the direct solver only.
    if (n <= preconditioner_->coarse_size()) {
      coarse_ = make_direct_solver(options.mumps, 1);
      parameters_.sublist("MUMPS") = coarse_->parameters();
      return;
    }
    parameters_.sublist("Belos") = krylov_defaults();
    parameters_.sublist("Belos").setParameters(options.belos);
    preconditioner_->describe(parameters_.sublist("Blocks"));
    parameters_.sublist("Sweep").set("type", options_.sweep.type);
    if (!options_.sweep.order.empty())
      parameters_.sublist("Sweep").set("order", fmt::format("{{{}}}", fmt::join(options_.sweep.order, ", ")));
  }

  bool reads_matrix() const override { return coarse_ != nullptr; }

  /// Keeps multigrid of an earlier matrix as long as solves remain fast.
  std::string setup(const LinearSystem& system) override {
    if (coarse_) return coarse_->setup(system);
    const bool keeps = reuse_.may_keep() && preconditioner_->can_be_reused() && system.symmetric == system_.symmetric &&
                       !system.diagonal.front().matrix.is_null() && n_changed(system) <= max_changed;
    system_ = system;
    system_.reproducible = reproducible_;
    symmetric_ = system.symmetric && preconditioner_->is_symmetric();
    comm_ = system.joined->map()->getComm();
    matrix_ = system.joined_operator();
    set_scale();
    if (keeps)
      reuse_.keep();
    else
      reuse_.make(is_careful());
    set_up_preconditioner();
    return failure_;
  }

  /// Solves the scaled system. Balances, and a field with one unknown per node, are scaled by the square roots of their
  /// diagonals. Regions of low and high conductivity then contribute equally. A residual below the round-off is
  /// accepted.
  LinearReport solve(const Vector& b, Vector& x, Real tolerance) override {
    if (coarse_) return coarse_->solve(b, x, tolerance);
    if (scale_.is_null()) return solve_scaled(b, x, tolerance);
    Vector scaled(b.getMap()), y(x.getMap());
    scaled.elementWiseMultiply(1, *scale_, b, 0);
    auto report = solve_scaled(scaled, y, tolerance);
    if (!report.converged && blocks_.size() == 1 && report.residual <= noise(scaled, y)) {
      report.converged = true;
      report.reason.clear();
    }
    x.elementWiseMultiply(1, *scale_, y, 0);
    return report;
  }

  const ParameterList& parameters() const override { return parameters_; }
  RCP<const Operator> preconditioner() const override { return inverse_; }

  std::vector<SolverCost> costs() const override {
    return coarse_ ? std::vector<SolverCost>() : preconditioner_->costs();
  }

 private:
  bool is_scaled(const DiagonalBlock& diagonal) const {
    const auto& block = diagonal.block;
    const bool alone = blocks_.size() == 1 && block.n_components == 1 && block.near_null_space.n() == 0;
    return (alone || block.balance) && !diagonal.matrix.is_null();
  }

  void set_scale() {
    scale_ = unscale_ = Teuchos::null;
    const auto& diagonal = system_.diagonal;
    if (std::none_of(diagonal.begin(), diagonal.end(), [&](const auto& of) { return is_scaled(of); })) return;
    const auto& joined = *system_.joined;
    const auto scale = rcp(new Vector(joined.map())), unscale = rcp(new Vector(joined.map()));
    scale->putScalar(1);
    for (int r = 0; r < joined.n_blocks(); ++r)
      if (is_scaled(diagonal[r]))
        scale_by_diagonal(*diagonal[r].matrix, joined.scale(r),
                          *scale->offsetViewNonConst(joined.map(r), joined.first(r))->getVectorNonConst(0));
    unscale->reciprocal(*scale);
    scale_ = scale;
    unscale_ = unscale;
    matrix_ = rcp(new ScaledOperator(matrix_, scale_));
  }

  /// Returns the round-off of scaled rows relative to b: the terms of each row are as large as x.
  static Real noise(const Vector& b, const Vector& x) {
    return std::min(16 * std::numeric_limits<Real>::epsilon() * x.norm2() / b.norm2(), max_noise);
  }

  LinearReport solve_scaled(const Vector& b, Vector& x, Real tolerance) {
    LinearReport report;
    x.putScalar(0);
    if (!failure_.empty() || b.normInf() == 0) {
      report.reason = failure_;
      report.converged = failure_.empty();
      return report;
    }
    iterate(b, x, tolerance, reuse_.max_iterations(tolerance), report);
    if (reuse_.gives_up(report.iterations, report.reason.empty() && report.residual <= 2 * tolerance)) {
      if (!report.reason.empty() || !std::isfinite(report.residual)) {  // unusable as a start
        x.putScalar(0);
        report = {};
      }
      reuse_.make(true);
      set_up_preconditioner();
      report.reason = failure_;
      const int before = report.iterations;
      const Real from = before > 0 ? report.residual : 1;
      if (failure_.empty()) iterate(b, x, tolerance, 0, report);
      reuse_.learn(report.iterations - before, report.residual / from, tolerance / from);
    } else {
      reuse_.learn(report.iterations, report.residual, tolerance);
    }
    if (!report.reason.empty()) return report;
    report.converged = report.residual <= std::max(10 * tolerance, acceptable_linear_residual);
    if (!report.converged)
      report.reason = fmt::format("iterative solve: relative residual {:.1e} after {} iterations, {:.0e} is required",
                                  report.residual, report.iterations, tolerance);
    return report;
  }

  /// Returns whether cycles of multigrid are tried, or need no trial. Otherwise they are tried only after a slow solve.
  bool is_careful() const { return reuse_.is_careful() || symmetric_ || !preconditioner_->has_cycles(); }

  static RCP<const Vector> diagonal_of(const Matrix& matrix) {
    const auto diagonal = rcp(new Vector(matrix.row_map()));
    matrix.copy_diagonal(*diagonal);
    return diagonal;
  }

  /// Returns the number of rows whose diagonal has changed since multigrid was made. Collective.
  GlobalIndex n_changed(const LinearSystem& system) {
    GlobalIndex here = 0;
    for (std::size_t r = 0; r < diagonals_.size(); ++r) {
      if (diagonals_[r].is_null()) continue;
      const auto diagonal = diagonal_of(*system.diagonal[r].matrix);
      const auto now = diagonal->getLocalViewHost(Tpetra::Access::ReadOnly),
                 then = diagonals_[r]->getLocalViewHost(Tpetra::Access::ReadOnly);
      for (std::size_t i = 0; i < now.extent(0); ++i)
        here += std::fabs(now(i, 0) - then(i, 0)) > much * std::fabs(then(i, 0));
    }
    return base::sum_over_ranks(*comm_, here);
  }

  /// Sets up the preconditioner for the present system, or only the parts above multigrid if that remains. Sets
  /// failure_. Throws RefusedList at the first set-up. Collective.
  void set_up_preconditioner() {
    const bool keeps = reuse_.is_of_earlier_system();
    failure_.clear();
    system_.diagonal.front().careful = reuse_.state() != Reuse::State::unchecked;
    if (!keeps) {
      diagonals_.clear();
      for (const auto& part : system_.diagonal)
        diagonals_.push_back(part.matrix.is_null() ? Teuchos::null : diagonal_of(*part.matrix));
    }
    try {
      preconditioner_->setup(system_, keeps);
      inverse_ = preconditioner_->inverse();
      if (const auto made = preconditioner_->matrix(); scale_.is_null() && !made.is_null()) matrix_ = made;
      has_worked_ = true;
    } catch (const Error& error) {
      if (!has_worked_ && dynamic_cast<const RefusedList*>(&error)) throw;
      failure_ = error.what();
      preconditioner_ =
          make_preconditioner(options_, blocks_, by_cost_);  // its state after a failure may differ among ranks
      inverse_ = Teuchos::null;
      reuse_.lose();
    }
  }

  /// Continues from x. Sets a reason only if the library throws.
  void iterate(const Vector& b, Vector& x, Real tolerance, int maximum, LinearReport& report) {
    try {
      base::collectively(*comm_, [&] { refine(b, x, tolerance, maximum, report); });
    } catch (const Error& error) {
      report.reason = fmt::format("iterative solve: {}", gist(error.what()));
    }
  }

  /// Solves, then refines the result. The updated residual of the Krylov method deviates from the true one if the
  /// matrix is nearly singular. Then the method solves for the remaining residual, as long as this helps.
  void refine(const Vector& b, Vector& x, Real tolerance, int maximum, LinearReport& report) {
    const bool begins = report.iterations == 0;
    report.residual = begins ? 1 : residual_of(b, x);
    bool ended = report.residual > tolerance;
    if (begins && ended) {
      ended = krylov(b, x, tolerance, maximum, report.iterations);
      const Real before = std::exchange(report.residual, residual_of(b, x));
      ended = ended && is_worthwhile(before, report.residual, tolerance);
    }
    if (!ended || report.residual <= tolerance) return;
    Vector r(b.getMap()), dx(b.getMap());
    relative_residual(*matrix_, b, x, r);
    while (ended && report.residual > tolerance) {
      dx.putScalar(0);
      ended = krylov(r, dx, tolerance / report.residual, maximum, report.iterations);
      x.update(1, dx, 1);
      const Real before = std::exchange(report.residual, relative_residual(*matrix_, b, x, r));
      ended = ended && is_worthwhile(before, report.residual, tolerance);
    }
  }

  Real residual_of(const Vector& b, const Vector& x) const {
    Vector r(b.getMap());
    return relative_residual(*matrix_, b, x, r);
  }

  /// Returns whether another solve is worthwhile.
  static bool is_worthwhile(Real before, Real residual, Real tolerance) {
    return residual > 2 * tolerance && residual < 0.1 * before;
  }

  /// Returns the default method. Sprekk's cycles are linear: GMRES needs one basis instead of two, and one more cycle
  /// at the end. A sweep over groups is expensive and may contain nonlinear methods.
  const char* usual_method() const {
    if (symmetric_ && definite_) return "Pseudo Block CG";
    return preconditioner_->has_cycles() ? "Block GMRES" : "Flexible GMRES";
  }

  /// Solves from x = 0. Adds to the iterations, at most `maximum` unless this is 0. Returns false after too many
  /// iterations, or if the preconditioner of an earlier matrix is not positive for this one. If this happens with a new
  /// preconditioner, the matrix is indefinite: in hexahedra, quadrature may give single functions at crack tips a small
  /// negative energy. GMRES then replaces conjugate gradients permanently.
  bool krylov(const Vector& b, Vector& x, Real tolerance, int maximum, int& iterations) {
    const auto& parameters = parameters_.sublist("Belos");
    RCP<const Operator> M = inverse_;
    if (!scale_.is_null()) M = rcp(new ScaledOperator(inverse_, unscale_));
    std::function<void()> watch;
    if (should_stop_)
      watch = [this, n = 0]() mutable {
        if (n++ % products_between_stops == 0 && base::any_rank(*comm_, should_stop_)) throw Stopped();
      };
    const auto solve_once = [&] {
      return solve::krylov(matrix_, M, parameters, usual_method(), b, x, tolerance, maximum, watch);
    };
    auto end = solve_once();
    if (end.indefinite) x.putScalar(0);
    if (end.indefinite && !reuse_.is_of_earlier_system() && !parameters.isParameter("Solver Type")) {
      definite_ = false;
      end = solve_once();
    }
    iterations += end.iterations;
    return end.ended;
  }

  PreconditionerOptions options_;
  std::vector<Block> blocks_;
  bool reproducible_, by_cost_;
  std::function<bool()> should_stop_;
  static constexpr int products_between_stops = 4;
  ParameterList parameters_;
  std::unique_ptr<LinearSolver> coarse_;  // replaces all members below; or null
  std::unique_ptr<Preconditioner> preconditioner_;
  RCP<const Comm> comm_;
  RCP<const Operator> matrix_;
  RCP<const Operator> inverse_;        // approximate inverse of the matrix
  RCP<const Vector> scale_, unscale_;  // of rows and columns; null: none
  static constexpr Real max_noise = 0.1;
  static constexpr Real much = 0.1;       // relative change of a diagonal above which a row has changed
  static constexpr int max_changed = 30;  // changed rows for which multigrid is kept; each costs an iteration
  LinearSystem system_;
  std::vector<RCP<const Vector>> diagonals_;  // [block] when multigrid was made; null: the block has no matrix
  bool symmetric_ = false, definite_ = true, has_worked_ = false;
  Reuse reuse_;
  std::string failure_ = "the matrix was not set up";
};

}  // namespace

std::unique_ptr<LinearSolver> make_iterative_solver(const LinearSolverOptions& options,
                                                    const std::vector<Block>& blocks) {
  return std::make_unique<IterativeSolver>(options, blocks);
}

}  // namespace sprekk::solve
