// Errors of time steps.
#include "assembly/rate_errors.hpp"
#include "assembly/system.hpp"

#include <algorithm>
#include <cmath>

namespace sprekk::assembly {

using fields::BlockVector;

bool System::has_rates() const {
  return std::any_of(modules_.begin(), modules_.end(), [](const auto& m) { return m.declaration.stores; });
}

void System::watch_errors(Real duration) {
  const auto start = initial();
  std::vector<char> balances;
  for (const auto& unknown : unknowns_) balances.push_back(unknown.balance);
  rate_errors_ = std::make_unique<RateErrors>(comm(), layouts_, balances, scheme_, start, duration);
  load_change_.assign(2 * blocks_.size(), 0);
  committed_x_ = fields::create_like(start);
  fields::copy(start, committed_x_);
}

void System::resume_errors(const BlockVector& x, const std::vector<Real>& memory) {
  const auto n = std::min(load_change_.size(), memory.size());
  std::copy_n(memory.begin(), n, load_change_.begin());
  rate_errors_->resume({memory.begin() + static_cast<std::ptrdiff_t>(n), memory.end()});
  rate_errors_->begin(x);
  fields::copy(x, committed_x_);
  errors_.clear();
}

void System::forget_rates(bool jump) { rate_errors_->forget(jump); }

/// Updates the largest errors by those of the step to x. Requires ghosts of x and the histories before commit.
void System::find_errors(const BlockVector& x) {
  constexpr Real noise = 1e-8;  // relative limit for changes, above the errors of linear solves and Newton's method
  std::vector<Real> least;
  for (const auto& block : blocks_) least.push_back(noise * block.kinematic_scale);
  auto errors = rate_errors_->of_step(x, dt_, rates_.before > 0, least);
  const auto owned = rows(committed_x_);
  for (const auto& module : modules_) {
    if (!module.errors) continue;
    const auto end = state(module);
    auto begin = end;
    begin.x.assign(owned.begin(), owned.end());
    module.errors->step_errors(begin, end, errors);
  }
  fields::copy(x, committed_x_);
  for (const auto& error : errors) {
    const auto same = [&](const auto& other) { return other.name == error.name; };
    const auto found = std::find_if(errors_.begin(), errors_.end(), same);
    if (found == errors_.end())
      errors_.push_back(error);
    else if (error.value > found->value || error.order == fields::StepError::unknown)
      *found = error;
  }
}

namespace {

void take_prescribed(const ConstView<char*>& mask, const ConstView<Real*>& values, const View<Real*>& force,
                     const View<Real*>& value) {
  Kokkos::parallel_for(
      "prescribed", Kokkos::RangePolicy<Execution>(0, force.extent(0)), KOKKOS_LAMBDA(int i) {
        if (!mask(i)) return;
        force(i) = 0;
        value(i) = values(i);
      });
}

}  // namespace

/// Returns the loads of modules at time t and state x, [block], followed by the prescribed values, [block].
BlockVector System::loads(const BlockVector& x, Real t, Real dt) {
  set_time(t, dt);
  refresh_ghosts(x, false);
  auto all = fields::create_like(x), prescribed = fields::create_like(x);
  const auto views = rows(all), values = rows(prescribed);
  for (const auto& module : modules_) {
    if (module.has_constant_load()) continue;
    auto s = state(module);
    s.rate = 0;
    module->residual(s, views);
  }
  for (std::size_t b = 0; b < all.size(); ++b)
    if (!constraints_[b].conditions().empty())
      take_prescribed(constraints_[b].mask(), constraints_[b].values(), views[b], values[b]);
  all.insert(all.end(), prescribed.begin(), prescribed.end());
  return all;
}

Real System::bend_of_loads(const BlockVector& x, Real t, Real dt) {
  const Real begin = t - dt;
  const auto scales = scales_;  // the step to t may be rejected
  const auto first = loads(x, begin, dt), last = loads(x, t, dt);
  std::vector<Real> noise;  // round-off of constant loads
  for (std::size_t b = 0; b < last.size(); ++b) {
    const auto& block = blocks_[b % blocks_.size()];
    const Real size = b < blocks_.size() ? block.residual_scale : block.kinematic_scale;
    noise.push_back(1e-12 * (first[b]->norm2() + size * std::sqrt(static_cast<Real>(first[b]->getGlobalLength()))));
  }
  for (std::size_t b = 0; b < last.size(); ++b) last[b]->update(-1, *first[b], 1);
  std::vector<Real> bend(last.size(), 0);
  const Real off = std::sqrt(0.15);  // Gauss points: unlikely to coincide with a period of the loads
  for (const Real s : {0.5 - off, 0.5, 0.5 + off}) {
    const auto between = loads(x, begin + s * dt, dt);
    for (std::size_t b = 0; b < last.size(); ++b) {
      between[b]->update(-1, *first[b], -s, *last[b], 1);
      bend[b] = std::max<Real>(bend[b], between[b]->norm2());
    }
  }
  scales_ = scales;
  Real largest = 0;
  for (std::size_t b = 0; b < last.size(); ++b) {
    load_change_[b] = std::max({load_change_[b], static_cast<Real>(last[b]->norm2()), bend[b]});
    if (bend[b] > noise[b]) largest = std::max(largest, bend[b] / load_change_[b]);
  }
  return largest;
}

}  // namespace sprekk::assembly
