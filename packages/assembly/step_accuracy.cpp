#include "assembly/step_accuracy.hpp"

#include "assembly/rows.hpp"

#include <algorithm>
#include <cmath>

namespace sprekk::assembly {

using fields::BlockVector;

namespace {

std::vector<char> balances(const Structure& structure) {
  std::vector<char> flags;
  for (const auto& unknown : structure.unknowns) flags.push_back(unknown.balance);
  return flags;
}

}  // namespace

StepAccuracy::StepAccuracy(const Structure& structure, Rates::Scheme scheme, const BlockVector& x, Real duration)
    : structure_(structure),
      rate_errors_(structure.mesh->comm, structure.layouts, balances(structure), scheme, x, duration),
      committed_x_(fields::create_like(x)),
      load_change_(2 * x.size(), 0) {
  fields::copy(x, committed_x_);
}

void StepAccuracy::commit(const BlockVector& x, Real dt, const State& state) {
  constexpr Real noise = 1e-8;  // relative limit for changes, above the errors of linear solves and Newton's method
  std::vector<Real> minimum;
  for (const auto& block : structure_.blocks) minimum.push_back(noise * block.kinematic_scale);
  auto errors = rate_errors_.of_step(x, dt, state.before > 0, minimum);
  const auto owned = rows_of(committed_x_);
  for (const auto& module : structure_.modules) {
    if (!module.errors) continue;
    const auto end = module.at(state);
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

Real StepAccuracy::bend(const std::function<BlockVector(Real)>& loads) {
  const auto first = loads(0), last = loads(1);
  const auto& blocks = structure_.blocks;
  std::vector<Real> noise;  // round-off of constant loads
  for (std::size_t b = 0; b < last.size(); ++b) {
    const auto& block = blocks[b % blocks.size()];
    const Real size = b < blocks.size() ? block.residual_scale : block.kinematic_scale;
    noise.push_back(1e-12 * (first[b]->norm2() + size * std::sqrt(static_cast<Real>(first[b]->getGlobalLength()))));
  }
  for (std::size_t b = 0; b < last.size(); ++b) last[b]->update(-1, *first[b], 1);
  std::vector<Real> bend(last.size(), 0);
  const Real off = std::sqrt(0.15);  // Gauss points: unlikely to coincide with a period of the loads
  for (const Real s : {0.5 - off, 0.5, 0.5 + off}) {
    const auto between = loads(s);
    for (std::size_t b = 0; b < last.size(); ++b) {
      between[b]->update(-1, *first[b], -s, *last[b], 1);
      bend[b] = std::max<Real>(bend[b], between[b]->norm2());
    }
  }
  Real largest = 0;
  for (std::size_t b = 0; b < last.size(); ++b) {
    load_change_[b] = std::max({load_change_[b], static_cast<Real>(last[b]->norm2()), bend[b]});
    if (bend[b] > noise[b]) largest = std::max(largest, bend[b] / load_change_[b]);
  }
  return largest;
}

std::vector<Real> StepAccuracy::memory() const {
  auto numbers = load_change_;
  for (const Real number : rate_errors_.memory()) numbers.push_back(number);
  return numbers;
}

void StepAccuracy::resume(const BlockVector& x, const std::vector<Real>& memory) {
  const auto n = std::min(load_change_.size(), memory.size());
  std::copy_n(memory.begin(), n, load_change_.begin());
  rate_errors_.resume({memory.begin() + static_cast<std::ptrdiff_t>(n), memory.end()});
  rate_errors_.begin(x);
  fields::copy(x, committed_x_);
  errors_.clear();
}

}  // namespace sprekk::assembly
