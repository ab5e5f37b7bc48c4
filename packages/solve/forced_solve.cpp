#include "solve/forced_solve.hpp"

#include <algorithm>

#include "base/over_ranks.hpp"

namespace sprekk::solve {
namespace {

constexpr Real first_accuracy = 1e-3, next_accuracy = 1e-2, safety = 1e-2;
constexpr Real accuracy_of_parts = 1e-8;  // and of steps with advected blocks, whose rows differ in size
constexpr int max_refinements = 20;       // more than powers of next_accuracy

void add(Real factor, const BlockVector& from, BlockVector& to) {
  for (std::size_t b = 0; b < to.size(); ++b) to[b]->update(factor, *from[b], 1);
}

}  // namespace

void ForcedSolve::jacobian(const fields::Evaluation& x) {
  problem_.jacobian(x);
  x_ = x;
  end_ = {};
}

void ForcedSolve::apply(const BlockVector& x, BlockVector& y) const {
  problem_.matrix().apply(x, y);
  for (std::size_t b = 0; b < x.size(); ++b) {
    const auto flags = problem_.constrained(b);
    const auto from = x[b]->getLocalViewDevice(Tpetra::Access::ReadOnly);
    const auto to = y[b]->getLocalViewDevice(Tpetra::Access::ReadWrite);
    Kokkos::parallel_for(
        "constrained rows", Kokkos::RangePolicy<Execution>(0, flags.extent(0)), KOKKOS_LAMBDA(LocalIndex i) {
          if (flags(i)) to(i, 0) = from(i, 0);
        });
  }
}

std::size_t ForcedSolve::states_after(const BlockVector& dx) {
  auto x = fields::create_like(dx);
  fields::copy(x_.x(), x);
  add(-1, dx, x);
  end_ = x;
  auto& globalisation = problem_.globalisation();
  return globalisation.state_hash(globalisation.states(end_));
}

Real ForcedSolve::accuracy_without_change(const BlockVector& b) {
  Real error = 0;
  for (const auto& measure : problem_.measures(x_, b)) error = std::max(error, measure.value);
  const Real ratio = error_ > 0 ? error / error_ : has_advected() ? 1 : 0;
  error_ = error;
  return safety * std::max(ratio * ratio, error > 0 ? enough_ / error : 0);
}

LinearReport ForcedSolve::solve(const BlockVector& b, BlockVector& dx, Real tolerance) {
  if (!solve_.forcing()) return solve_.solve(b, dx, tolerance, solve_.follows() ? accuracy_without_change(b) : 0);
  const Real most = has_advected() ? accuracy_of_parts : next_accuracy * first_accuracy;
  const Real state_accuracy = std::max(tolerance, std::min(most, accuracy_without_change(b)));
  auto& globalisation = problem_.globalisation();
  const auto states_before = globalisation.states(x_);
  if (base::on_all_ranks(*problem_.comm(), states_before.empty())) return solve_.solve(b, dx, state_accuracy);
  const auto before = globalisation.state_hash(states_before);
  Real requested = std::max(first_accuracy, tolerance);
  auto report = solve_.solve(b, dx, requested);
  if (requested == tolerance || !report.converged || report.residual <= tolerance) return report;
  auto r = fields::create_like(b), correction = fields::create_like(b);
  auto states = states_after(dx);
  for (int k = 0; k < max_refinements && report.converged && report.residual > tolerance && requested > tolerance;
       ++k) {
    requested =
        states == before ? state_accuracy : std::max(next_accuracy * std::min(requested, report.residual), tolerance);
    if (report.residual <= requested) break;
    apply(dx, r);
    for (std::size_t i = 0; i < r.size(); ++i) r[i]->update(1, *b[i], -1);
    const auto more = solve_.solve(r, correction, requested / report.residual);
    report.iterations += more.iterations;
    report.residual *= more.residual;
    report.converged = more.converged;
    report.reason = more.reason;
    if (!more.converged) break;
    add(1, correction, dx);
    const auto refined = states_after(dx);
    if (refined == states) break;
    states = refined;
  }
  return report;
}

LinearReport ForcedSolve::solve_part(Part part, const BlockVector& b, BlockVector& dx) {
  const auto clear_other = [&](BlockVector& v) {
    for (std::size_t i = 0; i < v.size(); ++i)
      if (problem_.blocks()[i].advected != (part == Part::advected)) v[i]->putScalar(0);
  };
  auto of_part = fields::create_like(b);
  fields::copy(b, of_part);
  clear_other(of_part);
  const Real accuracy = solve_.forcing() ? std::max(accuracy_of_parts, tolerance()) : tolerance();
  const auto report = solve_.solve_part(part, of_part, dx, accuracy);
  if (report.converged) clear_other(dx);
  return report;
}

}  // namespace sprekk::solve
