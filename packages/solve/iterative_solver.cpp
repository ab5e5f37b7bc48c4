// Belos, preconditioned from the right by a solver for each block.
#include <BelosSolverFactory.hpp>
#include <BelosTpetraAdapter.hpp>
#include <MueLu_MasterList.hpp>
#include <cmath>
#include <limits>
#include <utility>

#include "base/check.hpp"
#include "base/over_ranks.hpp"
#include "solve/block_solver.hpp"
#include "solve/families.hpp"
#include "solve/fine_level.hpp"
#include "solve/reuse.hpp"
#include "multigrid/multigrid.hpp"

namespace sprekk::solve {
namespace {

using fields::MultiVector;
using fields::Operator;
using multigrid::Multigrid;
using Teuchos::ParameterList;

ParameterList krylov_defaults() {
  ParameterList list("Belos");
  list.set("Maximum Iterations", 500);
  list.set("Num Blocks", 60, "basis of GMRES");
  list.set("Implicit Residual Scaling", "Norm of RHS");
  list.set("Explicit Residual Scaling", "Norm of RHS");
  return list;
}

/// Throws an Error that names the entry if a list has one that the library does not know; `allowed` are its lists.
void check_names(const ParameterList& given, const std::vector<ParameterList>& allowed) {
  for (const auto& item : given) {
    const std::string& name = item.first;
    bool known = name.rfind("level ", 0) == 0 || name == "user data";  // MueLu's sections of one level
    for (const auto& list : allowed) known = known || list.isParameter(name) || list.isSublist(name);
    SPREKK_CHECK(known, "{} has no parameter \"{}\"; its manual lists those that it has", given.name(), name);
  }
}

/// What the Krylov methods that are used here, or the one that is asked for, know.
std::vector<ParameterList> belos_parameters(const ParameterList& given) {
  std::vector<std::string> methods = {"Pseudo Block CG", "Block GMRES"};
  if (given.isParameter("Solver Type")) methods = {given.get<std::string>("Solver Type")};
  std::vector<ParameterList> lists(1);
  lists[0].set("Solver Type", "");
  Belos::SolverFactory<Real, MultiVector, Operator> factory;
  for (const auto& method : methods) {
    try {
      lists.push_back(*factory.create(method, Teuchos::parameterList())->getValidParameters());
    } catch (const std::exception&) {
      throw Error(fmt::format("Belos has no solver \"{}\"", method));
    }
  }
  return lists;
}

/// The last paragraph of an exception's text: what went wrong, without the place in the library.
std::string gist(const std::string& text) {
  const auto end = text.find_last_not_of('\n') + 1, gap = text.rfind("\n\n", end - 1);
  return gap == std::string::npos ? text : text.substr(gap + 2, end - gap - 2);
}

/// y = S A S x, S diagonal.
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

/// 1/sqrt(diagonal), or its inverse.
RCP<const Vector> root_of_diagonal(const Matrix& A, bool inverse) {
  const auto scale = rcp(new Vector(A.row_map()));
  A.copy_diagonal(*scale);
  const auto values = scale->getLocalViewHost(Tpetra::Access::ReadWrite);
  for (std::size_t k = 0; k < values.extent(0); ++k)
    values(k, 0) = values(k, 0) > 0 ? std::pow(values(k, 0), inverse ? 0.5 : -0.5) : 1;
  return scale;
}

class IterativeSolver : public LinearSolver {
 public:
  IterativeSolver(const LinearSolverOptions& options, const std::vector<Block>& blocks)
      : muelu_(options.muelu), reproducible_(options.reproducible.value_or(false)), parameters_("iterative") {
    check_names(ParameterList(options.muelu).setName("MueLu"), {*MueLu::MasterList::List()});
    check_names(ParameterList(options.belos).setName("Belos"), belos_parameters(options.belos));
    const int coarse_size = describe_multigrid(blocks.front());
    parameters_.sublist("Belos") = krylov_defaults();
    parameters_.sublist("Belos").setParameters(options.belos);
    long long n = 0;
    for (const auto& block : blocks) n += block.map->getGlobalNumElements();
    // A matrix of the size of a coarse level is one: its direct solver is all of multigrid then.
    if (n <= coarse_size) {
      coarse_ = make_direct_solver(options.mumps, 1);
      parameters_.sublist("MUMPS") = coarse_->parameters();
    } else {
      make_solvers(blocks);
    }
  }

  bool reads_matrix() const override { return coarse_ != nullptr; }

  /// Multigrid of an earlier matrix stays, as long as solves with it are worth it.
  std::string setup(const LinearSystem& system) override {
    if (coarse_) return coarse_->setup(system);
    const bool keeps = reuse_.may_keep() && !families_ && system.symmetric == system_.symmetric &&
                       !system.diagonal.front().matrix.is_null() &&
                       n_changed(*system.diagonal.front().matrix) <= most_changed;
    system_ = system;
    system_.reproducible = reproducible_;
    symmetric_ = system.symmetric && !families_;  // a sweep over families is not symmetric
    comm_ = system.joined->map()->getComm();
    matrix_ = system.joined_operator();
    set_scale();
    if (keeps)
      reuse_.keep();
    else
      reuse_.make(is_careful());
    make_preconditioner();
    return failure_;
  }

  /// Rows of one unknown of a node are scaled by the roots of their diagonals: what conducts little then counts as much
  /// as what conducts well. What rounding leaves of the residual is no failure.
  LinearReport solve(const Vector& b, Vector& x, Real tolerance) override {
    if (coarse_) return coarse_->solve(b, x, tolerance);
    if (scale_.is_null()) return solve_scaled(b, x, tolerance);
    Vector scaled(b.getMap()), y(x.getMap());
    scaled.elementWiseMultiply(1, *scale_, b, 0);
    auto report = solve_scaled(scaled, y, tolerance);
    if (!report.converged && report.residual <= noise(scaled, y)) {
      report.converged = true;
      report.reason.clear();
    }
    x.elementWiseMultiply(1, *scale_, y, 0);
    return report;
  }

  const ParameterList& parameters() const override { return parameters_; }
  RCP<const Operator> preconditioner() const override { return preconditioner_; }

  std::vector<SolverCost> costs() const override {
    if (fine_level_) return {*fine_cost_, fine_level_->order_one_cost()};
    if (families_) return families_->costs();
    return solver_.is_null() ? std::vector<SolverCost>() : solver_->costs();
  }

 private:
  void set_scale() {
    const auto& first = system_.diagonal.front();
    const bool scalar = !solver_.is_null() && first.block.n_components == 1 && first.block.near_null_space.n() == 0;
    scale_ = scalar ? root_of_diagonal(*first.matrix, false) : Teuchos::null;
    if (!scalar) return;
    matrix_ = rcp(new ScaledOperator(matrix_, scale_));
    unscale_ = root_of_diagonal(*first.matrix, true);
  }

  /// Of rows that are scaled, relative to b: each is a sum of terms as large as x.
  static Real noise(const Vector& b, const Vector& x) {
    return std::min(16 * std::numeric_limits<Real>::epsilon() * x.norm2() / b.norm2(), most_noise);
  }

  LinearReport solve_scaled(const Vector& b, Vector& x, Real tolerance) {
    LinearReport report;
    x.putScalar(0);
    if (!failure_.empty() || b.normInf() == 0) {
      report.reason = failure_;
      report.converged = failure_.empty();
      return report;
    }
    iterate(b, x, tolerance, reuse_.most_iterations(tolerance), report);
    if (reuse_.gives_up(report.iterations, report.reason.empty() && report.residual <= 2 * tolerance)) {
      if (!report.reason.empty() || !std::isfinite(report.residual)) {  // what the library left is no start
        x.putScalar(0);
        report = {};
      }
      reuse_.make(true);
      make_preconditioner();
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
      report.reason = fmt::format("iterative solve: relative residual {:.1e} after {} iterations, {:.0e} was asked for",
                                  report.residual, report.iterations, tolerance);
    return report;
  }

  /// Whether multigrid's cycles are tried, or need not be: else only once a solve has taken many iterations.
  bool is_careful() const { return reuse_.is_careful() || symmetric_ || families_ || !has_cycles_; }

  /// Adds what multigrid is like to the parameters, and returns how many unknowns its last level has at most.
  int describe_multigrid(const Block& block) {
    if (takes_muelu(muelu_, block)) {
      parameters_.sublist("MueLu") = multigrid_parameters(muelu_, block);
      return parameters_.sublist("MueLu").get<int>("coarse: max size");
    }
    auto& list = parameters_.sublist("multigrid");
    list.set("coarsest level", Multigrid::coarse_size, "unknowns at most");
    list.set("degree of Chebyshev's polynomial", multigrid::Chebyshev::usual_degree);
    return Multigrid::coarse_size;
  }

  void make_solvers(const std::vector<Block>& blocks) {
    blocks_ = blocks;
    has_cycles_ = !blocks.front().coordinates.is_null() && !takes_muelu(muelu_, blocks.front());
    solver_.reset();
    fine_level_.reset();
    families_.reset();
    if (have_fine_level(blocks)) {
      fine_level_ = std::make_unique<FineLevel>(muelu_, blocks);
      fine_cost_ = std::make_shared<SolverCost>();
      fine_cost_->name = fmt::format("fine level of '{}'", blocks.front().name);
    } else if (blocks.size() == 1) {
      solver_ = make_block_solver(muelu_, blocks.front());
    } else {
      families_ = std::make_unique<Families>(muelu_, blocks);
    }
  }

  static RCP<const Vector> diagonal_of(const Matrix& matrix) {
    const auto diagonal = rcp(new Vector(matrix.row_map()));
    matrix.copy_diagonal(*diagonal);
    return diagonal;
  }

  /// How many rows have another diagonal than when multigrid was made.
  GlobalIndex n_changed(const Matrix& matrix) {
    const auto diagonal = diagonal_of(matrix);
    const auto now = diagonal->getLocalViewHost(Tpetra::Access::ReadOnly),
               then = diagonal_->getLocalViewHost(Tpetra::Access::ReadOnly);
    GlobalIndex here = 0;
    for (std::size_t i = 0; i < now.extent(0); ++i)
      here += std::fabs(now(i, 0) - then(i, 0)) > much * std::fabs(then(i, 0));
    return base::sum_over_ranks(*comm_, here);
  }

  /// For the present system; of multigrid that is kept only what is above it. Leaves a failure.
  void make_preconditioner() {
    const bool keeps = reuse_.is_of_earlier_system();
    failure_.clear();
    system_.diagonal.front().careful = reuse_.state() != Reuse::State::unchecked;
    if (const auto& first = system_.diagonal.front().matrix; !keeps && !first.is_null())
      diagonal_ = diagonal_of(*first);
    if (!solver_.is_null() && !keeps)
      prepare(system_.diagonal.front().block.name, [&] { solver_->setup(system_.diagonal.front()); });
    for (int f = 0; families_ && f < families_->n() && failure_.empty(); ++f)
      prepare(families_->name(f), [&] { families_->setup(f, system_); });
    if (fine_level_)
      prepare(system_.diagonal.front().block.name,
              [&] { timed(fine_cost_->setup_seconds, [&] { fine_level_->setup(system_, keeps); }); });
    if (!failure_.empty()) {
      make_solvers(blocks_);  // what the libraries left may differ among ranks
      preconditioner_ = Teuchos::null;
      reuse_.lose();
    } else if (fine_level_) {
      ++fine_cost_->n_setups;
      preconditioner_ = rcp(new CountedOperator(fine_level_->inverse(), fine_cost_));
    } else if (!keeps) {
      preconditioner_ = families_ ? families_->sweep(system_) : solver_->inverse();
    }
  }

  /// Goes on from x. Leaves a reason only where the library gives up.
  void iterate(const Vector& b, Vector& x, Real tolerance, int most, LinearReport& report) {
    try {
      base::collectively(*comm_, [&] { refine(b, x, tolerance, most, report); });
    } catch (const Error& error) {
      report.reason = fmt::format("iterative solve: {}", gist(error.what()));
    }
  }

  template <class Work>
  void prepare(const std::string& block, const Work& work) {
    try {
      base::collectively(*comm_, work);
    } catch (const Error& error) {
      failure_ = fmt::format("preconditioner of block '{}': {}", block, gist(error.what()));
    }
  }

  /// Krylov's method updates its residual, which rounding drives away from the true one where the matrix is nearly
  /// singular. Then it solves for what is left, as long as that helps.
  void refine(const Vector& b, Vector& x, Real tolerance, int most, LinearReport& report) {
    const bool begins = report.iterations == 0;
    if (fine_level_ && begins) fine_level_->start(b, x);
    report.residual = fine_level_ || !begins ? residual_of(b, x) : 1;
    bool ended = report.residual > tolerance;
    if (begins && ended) {
      ended = krylov(b, x, tolerance, most, report.iterations);
      const Real before = std::exchange(report.residual, residual_of(b, x));
      ended = ended && is_worthwhile(before, report.residual, tolerance);
    }
    if (!ended || report.residual <= tolerance) return;
    Vector r(b.getMap()), dx(b.getMap());
    relative_residual(*matrix_, b, x, r);
    while (ended && report.residual > tolerance) {
      dx.putScalar(0);
      ended = krylov(r, dx, tolerance / report.residual, most, report.iterations);
      x.update(1, dx, 1);
      const Real before = std::exchange(report.residual, relative_residual(*matrix_, b, x, r));
      ended = ended && is_worthwhile(before, report.residual, tolerance);
    }
  }

  Real residual_of(const Vector& b, const Vector& x) const {
    Vector r(b.getMap());
    return relative_residual(*matrix_, b, x, r);
  }

  /// To go on after a solve.
  static bool is_worthwhile(Real before, Real residual, Real tolerance) {
    return residual > 2 * tolerance && residual < 0.1 * before;
  }

  /// Our own cycles are linear: so GMRES needs one basis instead of two, for one more cycle at the end. A sweep over
  /// families is dear, and may have others in it.
  const char* usual_method() const {
    if (symmetric_) return "Pseudo Block CG";
    return has_cycles_ && !families_ ? "Block GMRES" : "Flexible GMRES";
  }

  /// Starts from x. Adds to the iterations, of which there are at most `most`, unless it is 0; false where there are
  /// too many.
  bool krylov(const Vector& b, Vector& x, Real tolerance, int most, int& iterations) {
    using Problem = Belos::LinearProblem<Real, MultiVector, Operator>;
    const auto problem =
        rcp(new Problem(matrix_, Teuchos::rcpFromRef<MultiVector>(x), Teuchos::rcpFromRef<const MultiVector>(b)));
    const auto unscaled = [&]() -> RCP<const Operator> { return rcp(new ScaledOperator(preconditioner_, unscale_)); };
    problem->setRightPrec(scale_.is_null() ? preconditioner_ : unscaled());
    problem->setProblem();
    const auto list = rcp(new ParameterList(parameters_.sublist("Belos")));
    const std::string method = list->get("Solver Type", usual_method());
    list->remove("Solver Type");
    if (method.find("GMRES") == std::string::npos) list->remove("Num Blocks", false);
    list->get("Convergence Tolerance", tolerance);
    if (most > 0) list->set("Maximum Iterations", std::min(most, list->get<int>("Maximum Iterations")));
    Belos::SolverFactory<Real, MultiVector, Operator> factory;
    const auto solver = factory.create(method, list);
    solver->setProblem(problem);
    const bool converged = solver->solve() == Belos::Converged;
    iterations += solver->getNumIters();
    return converged || solver->isLOADetected();
  }

  ParameterList muelu_;
  bool reproducible_;
  ParameterList parameters_;
  std::unique_ptr<LinearSolver> coarse_;
  std::vector<Block> blocks_;
  RCP<BlockSolver> solver_;                // of the only block, or
  std::unique_ptr<FineLevel> fine_level_;  // of all blocks, or
  std::unique_ptr<Families> families_;     // of several
  std::shared_ptr<SolverCost> fine_cost_;
  RCP<const Comm> comm_;
  RCP<const Operator> matrix_;
  RCP<const Operator> preconditioner_;
  RCP<const Vector> scale_, unscale_;  // of rows and columns; null: none
  static constexpr Real most_noise = 0.1;
  static constexpr Real much = 0.1;        // that a diagonal may change,
  static constexpr int most_changed = 30;  // of all but a few rows, so that multigrid is kept: each takes an iteration
  LinearSystem system_;
  RCP<const Vector> diagonal_;  // when multigrid was made
  bool has_cycles_ = false;     // of our own multigrid, which can be tried
  bool symmetric_ = false;
  Reuse reuse_;
  std::string failure_ = "the matrix was not set up";
};

}  // namespace

std::unique_ptr<LinearSolver> make_iterative_solver(const LinearSolverOptions& options,
                                                    const std::vector<Block>& blocks) {
  return std::make_unique<IterativeSolver>(options, blocks);
}

}  // namespace sprekk::solve
