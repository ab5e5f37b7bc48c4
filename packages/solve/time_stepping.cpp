#include "solve/time_stepping.hpp"

#include <algorithm>
#include <cmath>

#include "base/check.hpp"
#include "base/parameters.hpp"

namespace sprekk::solve {
namespace {

constexpr Real first_stiffness = 10, weak_stiffness = 1e-3, min_stiffness = 1e-9, max_stiffness = 1e8;
constexpr Real weaker = 0.3, slightly_weaker = 0.9, stronger = 5;
constexpr int max_proximal_solves = 120, min_cuts = 3, max_placements = 4;
constexpr int max_changes_before_cut = 12, max_failed_solves = 100;

struct Release {
  BlockProblem& problem;
  const Evaluation& x;
  ~Release() { problem.globalisation().set_proximal_term(0, x); }
};

void append(const std::vector<LinearReport>& from, std::vector<LinearReport>& to) {
  to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

void TimeSteppingOptions::describe(base::Section& section) {
  section.entry(max_halvings, "maximum halvings", "-", base::between(0, 20),
                "maximum number of bisections of a failed step before the run ends");
  section.hint({"tethers"}, "Did you mean \"proximal continuation\"?");
  section.entry(proximal_continuation, "proximal continuation", "-",
                "proximal continuation after a failed Newton solve: springs between the sides of fractures, gradually "
                "relaxed to zero; only after three bisections if shorter steps are easier to solve");
}

bool TimeStepper::is_hopeless(const StepReport& report) const {
  return std::count_if(report.linear_solves.begin() + first_counted_, report.linear_solves.end(),
                       [](const auto& solve) { return !solve.converged; }) > max_failed_solves;
}

NewtonReport TimeStepper::solve(Evaluation& x, StepReport& report, int max_changes) {
  auto newton = newton_.solve(x, max_changes);
  report.newton_iterations += newton.iterations;
  append(newton.linear_solves, report.linear_solves);
  if (newton.converged) first_counted_ = static_cast<std::ptrdiff_t>(report.linear_solves.size());
  append(newton.advected_solves, report.advected_solves);
  return newton;
}

/// Solves from the state extrapolated from x, which is that at t, to t + dt, and from x itself if there is none or
/// Newton's method fails. If `shortens`, it also fails if a state changes often: several states may satisfy the
/// equations of a large step, and round-off would select one of them.
NewtonReport TimeStepper::solve_from_prediction(Evaluation& x, Real t, Real dt, bool shortens, StepReport& report) {
  const int max_changes = shortens ? max_changes_before_cut : std::numeric_limits<int>::max();
  if (options_.predicts) {
    if (auto predicted = predictor_.predict(x.x(), t, dt); !predicted.empty()) {
      Evaluation from(predicted);
      auto newton = solve(from, report, max_changes);
      if (newton.converged || newton.stopped) {
        x = from;
        return newton;
      }
    }
  }
  return solve(x, report, max_changes);
}

/// Proximal continuation. Springs pull the sides of fractures to their present position. Newton's method finds the
/// state, from which new springs start, with a lower stiffness while Newton's method converges. Unstable motions
/// advance fastest with springs just above the stiffness at which Newton's method fails. After a failure the last
/// stiffness that converged is used again, and the stiffness decreases more slowly. The last solve is without springs:
/// after a weak spring or, if that fails, after the weakest. Thin layers yield to much smaller forces.
NewtonReport TimeStepper::relax(Evaluation& x, StepReport& report) {
  auto place = x;
  const Release release{problem_, x};  // also if an evaluation throws
  Real stiffness = first_stiffness, enough = weak_stiffness, factor = weaker;
  bool converged = false;  // the last solve
  for (int k = 0; k < max_proximal_solves && stiffness < max_stiffness && !is_hopeless(report); ++k) {
    const bool last = stiffness < enough;
    if (!problem_.globalisation().set_proximal_term(last ? 0 : stiffness, place)) return {};
    auto newton = solve(x, report);
    if (newton.stopped || (last && (newton.converged || enough == min_stiffness))) return newton;
    (newton.converged ? place : x) = newton.converged ? x : place;
    if (last) {
      enough = min_stiffness;
    } else if (newton.converged) {
      stiffness *= factor;
      factor = std::max(weaker, std::pow(factor, 1.5));
    } else {
      stiffness *= converged ? 1 / factor : stronger;
      factor = std::min(slightly_weaker, std::sqrt(factor));
    }
    converged = newton.converged;
  }
  return {};
}

/// Moves floating bodies to their minimum-norm position and solves again, mostly without an iteration. If this solve
/// fails, x is restored: place_at_minimum_norm() cannot distinguish joints with very small differences.
NewtonReport TimeStepper::place_at_minimum_norm(Evaluation& x, NewtonReport newton, int& placements,
                                                StepReport& report) {
  for (placements = 0; placements < max_placements; ++placements) {
    const auto found = x;
    if (!problem_.globalisation().place_at_minimum_norm(x)) break;
    auto moved = solve(x, report);
    if (moved.stopped) return moved;
    if (!moved.converged) {
      x = found;
      return solve(x, report);
    }
    newton = std::move(moved);
  }
  return newton;
}

StepReport TimeStepper::advance(BlockVector& x, Real& t, Real t_to) {
  StepReport report;
  auto start = fields::create_like(x);
  fields::copy(x, start);
  Evaluation committed(start), at = committed;
  // in units of the smallest substep, so that substeps end exactly at t_to
  const long long whole = t_to > t ? 1LL << options_.max_halvings : 1;
  const Real t_from = t;
  std::string floating;  // floating bodies in the last failed substep that had some
  const long long largest_relaxed = problem_.stores() ? std::max(1LL, whole >> min_cuts) : whole;
  const auto time = [&](long long at) { return at == whole ? t_to : t_from + (t_to - t_from) * at / whole; };
  long long done = 0, size = whole;
  bool relaxed = false;  // since the last commit
  report.time = t_from;
  first_counted_ = 0;
  while (done < whole) {
    size = std::min(size, whole - done);
    const Real end = time(done + size);
    problem_.set_time(end, end - report.time);
    auto newton = solve_from_prediction(at, report.time, end - report.time, size > largest_relaxed, report);
    const bool relaxes =
        options_.proximal_continuation && !is_hopeless(report) && size <= largest_relaxed && (!relaxed || size == 1);
    if (!newton.converged && !newton.stopped && relaxes) {
      relaxed = true;
      at = committed;
      if (auto found = relax(at, report); found.converged || found.stopped) newton = std::move(found);
    }
    int placements = 0;
    if (newton.converged) newton = place_at_minimum_norm(at, std::move(newton), placements, report);
    report.measures = newton.measures;
    if (newton.converged) {
      problem_.commit(at);
      report.floating = problem_.globalisation().floating();
      if (placements == max_placements && !report.floating.empty())
        report.floating += fmt::format(" (after {} attempts its position may be inaccurate)", placements);
      if (options_.predicts) predictor_.add(x, at.x(), report.time, end);
      fields::copy(at.x(), x);
      committed = at;
      done += size;
      relaxed = false;
      committed_dt_ = end - report.time;
      report.time = t = end;
      ++report.substeps;
      size *= 2;
      continue;
    }
    at = committed;
    report.stopped = newton.stopped;
    if (report.stopped) return report;
    if (!newton.floating.empty()) floating = newton.floating;
    report.reason = fmt::format("t = {:.6g}, dt = {:.3g}: {}", end, end - report.time, newton.reason);
    report.oscillating = newton.oscillating;
    const bool gives_up = is_hopeless(report);
    if (gives_up) report.reason += fmt::format("; more than {} linear solves failed", max_failed_solves);
    if (size == 1 || gives_up) {
      if (committed_dt_ > 0) problem_.set_time(report.time, committed_dt_);  // time of x
      if (const auto where = problem_.globalisation().where(report.oscillating); !where.empty())
        report.reason += "; faces that oscillate between contact states: " + where;
      if (!floating.empty())
        report.reason =
            "no equilibrium found: in the last iterates " + floating + ", and nothing constrains it; " + report.reason;
      return report;
    }
    size /= 2;
    ++report.cuts;
  }
  report.converged = true;
  return report;
}

}  // namespace sprekk::solve
