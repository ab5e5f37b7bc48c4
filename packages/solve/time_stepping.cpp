#include "solve/time_stepping.hpp"

#include <algorithm>

#include "base/check.hpp"
#include "base/parameters.hpp"

namespace sprekk::solve {
namespace {

void append(const std::vector<LinearReport>& from, std::vector<LinearReport>& to) {
  to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

void TimeSteppingOptions::describe(base::Section& section) {
  section.entry(max_halvings, "maximum halvings", "-", base::between(0, 20),
                "how often a step that fails is halved before the run ends");
}

StepReport TimeStepper::advance(BlockVector& x, Real& t, Real t_to) {
  StepReport report;
  auto committed = fields::create_like(x);
  fields::copy(x, committed);
  // in units of the smallest substep, so that substeps end exactly at t_to
  const long long whole = 1LL << options_.max_halvings;
  const Real t_from = t;
  std::string loose;  // in the last substep that failed and in which something was
  const auto time = [&](long long at) { return at == whole ? t_to : t_from + (t_to - t_from) * at / whole; };
  long long done = 0, size = whole;
  report.time = t_from;
  while (done < whole) {
    size = std::min(size, whole - done);
    const Real end = time(done + size);
    problem_.set_time(end, end - report.time);
    auto newton = newton_.solve(x);
    report.newton_iterations += newton.iterations;
    append(newton.linear_solves, report.linear_solves);
    if (newton.converged && problem_.settle(x)) {
      newton = newton_.solve(x);  // to the tolerance again: mostly no iteration
      report.newton_iterations += newton.iterations;
      append(newton.linear_solves, report.linear_solves);
    }
    report.measures = newton.measures;
    if (newton.converged) {
      problem_.commit(x);
      report.loose = problem_.loose();
      fields::copy(x, committed);
      done += size;
      committed_dt_ = end - report.time;
      report.time = t = end;
      ++report.substeps;
      size *= 2;
      continue;
    }
    fields::copy(committed, x);
    if (!newton.loose.empty()) loose = newton.loose;
    report.reason = fmt::format("t = {:.6g}, dt = {:.3g}: {}", end, end - report.time, newton.reason);
    report.unsettled = newton.unsettled;
    if (size == 1) {
      if (committed_dt_ > 0) problem_.set_time(report.time, committed_dt_);  // where x is
      if (const auto where = problem_.where(report.unsettled); !where.empty())
        report.reason += "; faces that keep changing between open, stick and slip: " + where;
      if (!loose.empty()) report.reason = "no equilibrium found: " + loose + ", and nothing holds it; " + report.reason;
      return report;
    }
    size /= 2;
    ++report.cuts;
  }
  report.converged = true;
  return report;
}

}  // namespace sprekk::solve
