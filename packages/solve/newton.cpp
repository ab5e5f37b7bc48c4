#include "solve/newton.hpp"

#include <NOX.H>
#include <NOX_Direction_UserDefinedFactory.H>
#include <NOX_LineSearch_UserDefinedFactory.H>
#include <NOX_StatusTest_Generic.H>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>

#include "base/over_ranks.hpp"
#include "base/check.hpp"
#include "base/parameters.hpp"
#include "base/text.hpp"
#include "solve/balance_check.hpp"
#include "solve/newton_step.hpp"

namespace sprekk::solve {
namespace {

using NOX::StatusTest::StatusType;

constexpr int max_lagged = 60;  // steps with lagged coefficients
constexpr int max_additional = 2, max_hidden = 3;

/// Convergence test. Converged: all measures are at most the tolerance. If round-off hides an error of the sums of
/// balances, up to two full steps follow while they halve it; if the error exceeds the flows, steps follow until three
/// in a row do not halve it. Failed: a measure or the residual is not finite, no progress, too many iterations, or
/// stopped. Saves the history and the reason.
class MeasureTest : public NOX::StatusTest::Generic {
 public:
  MeasureTest(BlockProblem& problem, const NewtonOptions& options, int max_changes, const Picard& picard,
              NewtonStep& step, NewtonReport& report)
      : problem_(problem),
        options_(options),
        max_changes_(max_changes),
        picard_(picard),
        step_(step),
        report_(report),
        balances_(problem) {}

  StatusType checkStatus(const NOX::Solver::Generic& solver, NOX::StatusTest::CheckType) override {
    const auto& group = dynamic_cast<const NoxGroup&>(solver.getSolutionGroup());
    report_.iterations = solver.getNumIterations();
    report_.measures = problem_.measures(group.x(), group.f());
    report_.history.push_back(report_.measures);
    const Measure* worst = nullptr;
    for (const auto& measure : report_.measures)
      if (!worst || !(measure.value <= worst->value)) worst = &measure;
    const Real value = worst ? worst->value : 0;
    report_.reason.clear();
    status_ = NOX::StatusTest::Unconverged;
    if (report_.iterations == 0) balances_.start(report_.measures, options_.tolerance);
    balances_.note(group.f());
    const bool lags = picard_.lags() && picard_.n_steps() > 0;
    const bool is_hidden = value <= options_.tolerance && report_.iterations > 0 && !lags && hides_imbalance(group);
    const bool within_tolerance = value <= options_.tolerance && !is_hidden && !lags;
    if (!std::isfinite(group.getNormF())) {
      fail("the residual is not finite");
    } else if (within_tolerance) {
      if (!needs_another_iteration(group)) status_ = NOX::StatusTest::Converged;
    } else if (n_additional_ > 0) {
      fail("an additional iteration has larger errors");
    } else if (is_hidden && report_.iterations - picard_.n_steps() >= options_.max_iterations) {
      fail(fmt::format("the sum of a balance exceeds its flows after {} iterations", report_.iterations));
    } else if (!std::isfinite(value)) {
      fail(fmt::format("'{}' is {}", worst->name, value));
    } else if ((picard_.lags() && picard_.n_steps() >= max_lagged) ||
               report_.iterations - picard_.n_steps() >= options_.max_iterations) {
      fail(fmt::format("no convergence in {} iterations: '{}' is {:.2e}, required is {:.0e}", report_.iterations,
                       worst->name, value, options_.tolerance));
    } else if (step_.report().stagnant) {
      fail(fmt::format("no progress in {} iterations: '{}' is {:.2e}, required is {:.0e}", report_.iterations,
                       worst->name, value, options_.tolerance));
    } else if (max_changes_ < std::numeric_limits<int>::max() &&
               base::on_any_rank(*problem_.comm(), step_.iterates().n_changes() > max_changes_)) {
      fail(fmt::format("a state changed more than {} times in {} iterations", max_changes_, report_.iterations));
    } else if (base::any_rank(*problem_.comm(), options_.should_stop)) {
      report_.stopped = true;
      fail("interrupted");
    }
    return status_;
  }

  StatusType getStatus() const override { return status_; }
  /// Returns the iterate with the smallest error of the sums of balances of those whose measures are at most the
  /// tolerance, if it is not the last one; otherwise empty.
  const BlockVector& accepted() const { return accepted_; }
  const std::vector<fields::Measure>& measures_of_accepted() const { return measures_of_accepted_; }
  std::ostream& print(std::ostream& stream, int indent) const override {
    stream << std::string(indent, ' ');
    for (const auto& measure : report_.measures) stream << fmt::format("{} {:.3e}  ", measure.name, measure.value);
    return stream << std::endl;
  }

 private:
  /// Returns whether the sum of a balance exceeds its flows, and saves the iterate with the smallest sum. False after
  /// three such iterates without a reduction by half: Newton's method does not reduce the sum, which is the round-off
  /// of large stored amounts.
  bool hides_imbalance(const NoxGroup& group) {
    const Real imbalance = balances_.imbalance(group.x());
    if (!(imbalance > BalanceCheck::largest_hidden)) return false;
    const bool halved = imbalance <= 0.5 * hidden_;
    n_hidden_ = halved ? 1 : n_hidden_ + 1;
    if (halved) hidden_ = imbalance;
    if (n_hidden_ > max_hidden) return false;
    if (imbalance < least_imbalance_) save(group.x().x());
    least_imbalance_ = std::min(least_imbalance_, imbalance);
    return true;
  }
  /// Saves the iterate if another one follows and it is the best so far.
  bool needs_another_iteration(const NoxGroup& group) {
    const Real imbalance = report_.iterations == 0 ? 0 : balances_.imbalance(group.x());
    const bool is_best = imbalance <= least_imbalance_;
    const bool is_last = n_additional_ == max_additional || (n_additional_ > 0 && imbalance > 0.5 * least_imbalance_);
    if (imbalance <= BalanceCheck::allowed || is_last || n_hidden_ > max_hidden) {
      if (is_best) accepted_.clear();
      return false;
    }
    if (is_best) save(group.x().x());
    least_imbalance_ = std::min(least_imbalance_, imbalance);
    ++n_additional_;
    step_.end_search();
    return true;
  }
  void save(const BlockVector& x) {
    accepted_ = fields::create_like(x);
    fields::copy(x, accepted_);
    measures_of_accepted_ = report_.measures;
  }
  void fail(const std::string& reason) {
    report_.reason = reason;
    status_ = NOX::StatusTest::Failed;
  }

  BlockProblem& problem_;
  const NewtonOptions& options_;
  int max_changes_;
  const Picard& picard_;
  NewtonStep& step_;
  NewtonReport& report_;
  BalanceCheck balances_;
  int n_additional_ = 0;  // iterations after the measures have converged
  int n_hidden_ = 0;      // iterates since the last reduction by half of an imbalance above the flows
  Real hidden_ = std::numeric_limits<Real>::max();  // imbalance after this reduction
  BlockVector accepted_;
  Real least_imbalance_ = std::numeric_limits<Real>::infinity();
  std::vector<fields::Measure> measures_of_accepted_;
  StatusType status_ = NOX::StatusTest::Unevaluated;
};

/// Provides the direction and the line search to NOX.
class StepFactory : public NOX::Direction::UserDefinedFactory, public NOX::LineSearch::UserDefinedFactory {
 public:
  explicit StepFactory(const RCP<NewtonStep>& step) : step_(step) {}
  RCP<NOX::Direction::Generic> buildDirection(const RCP<NOX::GlobalData>&, Teuchos::ParameterList&) const override {
    return step_;
  }
  RCP<NOX::LineSearch::Generic> buildLineSearch(const RCP<NOX::GlobalData>&, Teuchos::ParameterList&) const override {
    return step_;
  }

 private:
  RCP<NewtonStep> step_;
};

RCP<Teuchos::ParameterList> nox_parameters(const NewtonOptions& options, const RCP<NewtonStep>& step, int rank) {
  const auto list = Teuchos::parameterList("NOX");
  list->set("Nonlinear Solver", "Line Search Based");
  const auto factory = rcp(new StepFactory(step));
  auto& direction = list->sublist("Direction");
  direction.set("Method", "User Defined");
  direction.set<RCP<NOX::Direction::UserDefinedFactory>>("User Defined Direction Factory", factory);
  auto& search = list->sublist("Line Search");
  search.set("Method", "User Defined");
  search.set<RCP<NOX::LineSearch::UserDefinedFactory>>("User Defined Line Search Factory", factory);
  const int shown = NOX::Utils::OuterIteration + NOX::Utils::OuterIterationStatusTest + NOX::Utils::Error;
  auto& printing = list->sublist("Printing");
  printing.set("Output Information", options.print ? shown : 0);
  printing.set("MyPID", rank);
  printing.set("Output Processor", options.print ? 0 : -1);  // NOX would print failed line searches in any case
  list->setParameters(options.nox);
  return list;
}

/// Reports NOX entries for other methods, and entries that should be sections.
void check_methods(base::Section& section, const Teuchos::ParameterList& nox) {
  constexpr char solver[] = "Line Search Based";
  if (const auto* entry = nox.getEntryPtr("Nonlinear Solver");
      entry && !(entry->isType<std::string>() && Teuchos::getValue<std::string>(*entry) == solver))
    section.fail_inside(
        fmt::format("NOX > \"Nonlinear Solver\": is {}, must be \"{}\"", base::describe(*entry), solver));
  for (const char* name : {"Direction", "Line Search"})
    if (nox.getEntryPtr(name))
      section.fail_inside(fmt::format("NOX > \"{}\": must be absent: Sprekk computes direction and step length", name));
  if (const auto* entry = nox.getEntryPtr("Printing"); entry && !entry->isList())
    section.fail_inside(fmt::format("NOX > \"Printing\": is {}, must be a section", base::describe(*entry)));
}

constexpr char nox_place[] = "Sprekk > Solver > NOX";

/// Returns an Error with the message of NOX on one line, without source locations.
Error refused(const std::string& text) {
  std::istringstream lines(text);
  std::string words;
  for (std::string line; std::getline(lines, line);)
    if (!line.empty() && line.rfind("Throw ", 0) != 0 && line.rfind("./packages/", 0) != 0)
      words += ' ' + std::string(base::trimmed(line));
  return Error(std::string(nox_place) + ": NOX does not take these parameters:" + words);
}

/// Throws an Error with an entry of `given` that NOX has not read. NOX has no list of its parameters, but marks those
/// it has read.
void refuse_unread(const Teuchos::ParameterList& given, const Teuchos::ParameterList& read, const std::string& path) {
  for (const auto& item : given) {
    const auto& entry = read.getEntry(item.first);
    if (entry.isList()) {
      refuse_unread(given.sublist(item.first), read.sublist(item.first), path + " > " + item.first);
      continue;
    }
    SPREKK_CHECK(entry.isUsed(),
                 "{} > \"{}\": NOX does not read this parameter here; see its manual for its parameters", path,
                 item.first);
  }
}

/// Solves, and converts exceptions of NOX, including plain text, to an Error.
StatusType solve_by(RCP<NOX::Solver::Generic>& solver, const RCP<NOX::Abstract::Group>& group,
                    const RCP<NOX::StatusTest::Generic>& test, const RCP<Teuchos::ParameterList>& parameters,
                    const Teuchos::ParameterList& given) {
  try {
    try {
      solver = NOX::Solver::buildSolver(group, test, parameters);
    } catch (const std::logic_error& error) {
      throw refused(error.what());
    }
    refuse_unread(given, *parameters, nox_place);
    return solver->solve();
  } catch (const char* text) {
    throw refused(text);
  }
}

}  // namespace

void NewtonOptions::describe(base::Section& section) {
  section.entry(tolerance, "tolerance", "-", base::positive(),
                "tolerance of the convergence measures, relative to the loads");
  section.entry(max_iterations, "maximum iterations", "-", base::at_least(1),
                "maximum number of Newton iterations per solve");
  section.entry(print, "print", "-", "switch for output of every Newton iteration");
  section.section(linear_solver, "Linear solver", "solver of the linear systems");
  section.named_sections(linear_solver.preconditioner.blocks, "Blocks",
                         "preconditioner of the block of this name, for the iterative solver");
  section.section(linear_solver.preconditioner.sweep, "Sweep", "sweep over several groups of blocks");
  section.passthrough(nox, "NOX", "parameters of the library NOX");
  check_methods(section, nox);
}

namespace {

/// Returns options with which linear solves stop if, and only if, Newton's method is active.
LinearSolverOptions stopping(LinearSolverOptions options, const std::function<bool()>& should_stop,
                             const bool& solving) {
  if (should_stop) options.should_stop = [&solving, should_stop] { return solving && should_stop(); };
  return options;
}

/// Sets a flag during its lifetime.
struct While {
  explicit While(bool& flag) : flag(flag) { flag = true; }
  ~While() { flag = false; }
  bool& flag;
};

}  // namespace

Newton::Newton(BlockProblem& problem, const NewtonOptions& options, RCP<base::Timers> timers)
    : problem_(problem),
      options_(options),
      linear_(std::make_unique<CondensedSolve>(problem, stopping(options.linear_solver, options.should_stop, solving_),
                                               timers)),
      forced_(std::make_unique<ForcedSolve>(problem, *linear_)) {}

Newton::~Newton() = default;

NewtonReport Newton::solve(BlockVector& x) {
  auto start = fields::create_like(x);
  fields::copy(x, start);
  Evaluation at(start);
  auto report = solve(at);
  fields::copy(at.x(), x);
  return report;
}

NewtonReport Newton::solve(Evaluation& x, int max_changes) {
  NewtonReport report;
  forced_->start(options_.tolerance);
  problem_.globalisation().damp(0, {});
  const RCP<NOX::Abstract::Group> group = rcp(new NoxGroup(problem_, x));
  std::optional<Picard> picard(std::in_place, problem_, x);
  const auto step = rcp(new NewtonStep(problem_, *forced_, *picard));
  const auto& found = step->report();
  const auto test = rcp(new MeasureTest(problem_, options_, max_changes, *picard, *step, report));
  const auto parameters = nox_parameters(options_, step, problem_.comm()->getRank());
  RCP<NOX::Solver::Generic> solver;
  try {
    const While solving(solving_);
    report.converged = solve_by(solver, group, test, parameters, options_.nox) == NOX::StatusTest::Converged;
  } catch (const Stopped&) {
    report.stopped = true;
    report.reason = "interrupted";
  }
  picard.reset();
  report.linear_solves = found.linear_solves;
  report.advected_solves = found.advected_solves;
  report.iterations = static_cast<int>(report.linear_solves.size());
  if (report.stopped) return report;
  const bool returns_accepted = !test->accepted().empty();  // additional iterations failed or had larger errors
  x = returns_accepted ? Evaluation(test->accepted()) : dynamic_cast<const NoxGroup&>(solver->getSolutionGroup()).x();
  if (returns_accepted) report.measures = test->measures_of_accepted();
  report.converged = report.converged || returns_accepted;
  for (auto& linear : report.linear_solves) linear.used = report.converged;
  if (report.iterations > 0) {
    const bool damped = base::on_any_rank(*problem_.comm(), found.damped);
    factors_ = damped ? Factors::damped : Factors::good;
    if (report.converged && (damped || returns_accepted)) {  // before the commit, after which sliding faces would stick
      problem_.globalisation().damp(0, {});
      problem_.jacobian(x);
      factors_ = Factors::old;
    }
  }
  if (!found.failure.empty()) report.reason = found.failure;
  if (report.iterations > 0 && !report.linear_solves.back().converged)
    report.reason = report.linear_solves.back().reason;
  if (!report.converged && report.reason.empty()) report.reason = "NOX gave up";
  if (returns_accepted) report.reason.clear();
  report.floating = found.floating;
  report.oscillating = step->iterates().changed_lately();
  return report;
}

void Newton::linearize(const Evaluation& x) {
  problem_.globalisation().damp(0, {});
  problem_.jacobian(x);
  factors_ = Factors::old;
}

LinearReport Newton::solve_linearized(const Evaluation& x, const BlockVector& b, BlockVector& dx, Real tolerance) {
  if (factors_ == Factors::damped || (factors_ == Factors::good && linear_->n_setups() == 0)) linearize(x);
  if (factors_ == Factors::old) linear_->update();
  factors_ = Factors::good;
  return linear_->solve(b, dx, tolerance);
}

}  // namespace sprekk::solve
