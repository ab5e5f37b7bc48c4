#include "solve/time_stepping.hpp"

#include <algorithm>

#include "base/check.hpp"
#include "base/parameters.hpp"

namespace sprekk::solve {
namespace {

constexpr Real first_tether = 10, weak_tether = 1e-3, least_tether = 1e-9, most_tether = 1e4;
constexpr Real weaker = 0.3, stronger = 10;
constexpr int most_tethers = 60, least_cuts = 3, most_settlings = 4;

struct Release {
  BlockProblem& problem;
  const Evaluation& x;
  ~Release() { problem.globalisation().tether(0, x); }
};

void append(const std::vector<LinearReport>& from, std::vector<LinearReport>& to) {
  to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

void TimeSteppingOptions::describe(base::Section& section) {
  section.entry(max_halvings, "maximum halvings", "-", base::between(0, 20),
                "maximum number of bisections of a failed step before the run ends");
  section.entry(tethers, "tethers", "-",
                "proximal continuation after a failed Newton solve: springs between the sides of fractures, gradually "
                "relaxed to zero; only after three bisections if shorter steps are easier to solve");
}

NewtonReport TimeStepper::solve(Evaluation& x, StepReport& report) {
  auto newton = newton_.solve(x);
  report.newton_iterations += newton.iterations;
  append(newton.linear_solves, report.linear_solves);
  return newton;
}

/// Proximal continuation. Springs (tethers) pull the sides of fractures to their present position. Newton's method
/// finds the state, from which new springs start, with a lower stiffness while Newton's method converges. The last
/// solve is without springs: after a weak spring or, if that fails, after the weakest. Thin layers yield to much
/// smaller forces.
NewtonReport TimeStepper::relax(Evaluation& x, StepReport& report) {
  auto place = x;
  const Release release{problem_, x};  // also if an evaluation throws
  Real stiffness = first_tether, enough = weak_tether;
  for (int k = 0; k < most_tethers && stiffness < most_tether; ++k) {
    const bool last = stiffness < enough;
    if (!problem_.globalisation().tether(last ? 0 : stiffness, place)) return {};
    auto newton = solve(x, report);
    if (newton.stopped || (last && (newton.converged || enough == least_tether))) return newton;
    (newton.converged ? place : x) = newton.converged ? x : place;
    if (last)
      enough = least_tether;
    else
      stiffness *= newton.converged ? weaker : stronger;
  }
  return {};
}

/// Moves floating bodies to their minimum-norm position and solves again, mostly without an iteration. If this solve
/// fails, x is restored: settle() cannot distinguish joints with very small differences.
NewtonReport TimeStepper::settle(Evaluation& x, NewtonReport newton, int& settlings, StepReport& report) {
  for (settlings = 0; settlings < most_settlings; ++settlings) {
    const auto found = x;
    if (!problem_.globalisation().settle(x)) break;
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
  std::string loose;  // floating bodies in the last failed substep that had some
  const long long tethered = problem_.stores() ? std::max(1LL, whole >> least_cuts) : whole;
  const auto time = [&](long long at) { return at == whole ? t_to : t_from + (t_to - t_from) * at / whole; };
  long long done = 0, size = whole;
  bool relaxed = false;  // since the last commit
  report.time = t_from;
  while (done < whole) {
    size = std::min(size, whole - done);
    const Real end = time(done + size);
    problem_.set_time(end, end - report.time);
    auto newton = solve(at, report);
    if (!newton.converged && !newton.stopped && !relaxed && options_.tethers && size <= tethered) {
      relaxed = true;
      at = committed;
      if (auto found = relax(at, report); found.converged || found.stopped) newton = std::move(found);
    }
    int settlings = 0;
    if (newton.converged) newton = settle(at, std::move(newton), settlings, report);
    report.measures = newton.measures;
    if (newton.converged) {
      problem_.commit(at);
      report.loose = problem_.globalisation().loose();
      if (settlings == most_settlings && !report.loose.empty())
        report.loose += fmt::format(" (after {} attempts its position may be inaccurate)", settlings);
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
    if (!newton.loose.empty()) loose = newton.loose;
    report.reason = fmt::format("t = {:.6g}, dt = {:.3g}: {}", end, end - report.time, newton.reason);
    report.unsettled = newton.unsettled;
    if (size == 1) {
      if (committed_dt_ > 0) problem_.set_time(report.time, committed_dt_);  // time of x
      if (const auto where = problem_.globalisation().where(report.unsettled); !where.empty())
        report.reason += "; faces that oscillate between contact states: " + where;
      if (!loose.empty())
        report.reason =
            "no equilibrium found: in the last iterates " + loose + ", and nothing constrains it; " + report.reason;
      return report;
    }
    size /= 2;
    ++report.cuts;
  }
  report.converged = true;
  return report;
}

}  // namespace sprekk::solve
