#include "assembly/relaxation.hpp"

#include <algorithm>
#include <cmath>

namespace sprekk::assembly {
namespace {

constexpr int n_fast = 5;  // iterates before it goes carefully
constexpr Real steepest = -100, most_down = 2;
constexpr Real memory = 0.25, longest_memory = 0.8, memory_of_turns = 0.6;
constexpr Real shorter = 0.7, longer = 1.2, shortest = 0.02;

}  // namespace

void Relaxation::start(std::vector<Real> y) {
  y_ = std::move(y);
  past_.resize(y_.size());
  before_.clear();
}

/// How far a number moves whose g is `away`, and was `answered` farther after the last move by `moved`.
Real Relaxation::step(Past& past, Real away, Real moved, Real answered) const {
  const bool careful = n_ > n_fast, turned = moved * away < 0;
  const Real share = longest_memory - (longest_memory - memory) * std::pow(memory_of_turns, past.n_turns);
  const Real remembered = turned ? 2 * past.slope - 0.5 : share * past.slope;
  past.slope = std::clamp(std::min(moved != 0 ? answered / moved : 0, remembered), steepest, Real(0));
  const Real step = std::max(away / (1 - past.slope), -most_down);
  if (!careful) return step;
  past.n_turns += turned;
  past.longest = turned ? std::max(shorter * past.longest, shortest) : std::min(longer * past.longest, Real(1));
  return std::clamp(step, -past.longest, past.longest);
}

void Relaxation::follow(const std::vector<Real>& g) {
  ++n_;
  auto next = y_;
  for (std::size_t k = 0; k < g.size(); ++k) {
    const bool first = before_.empty();
    next[k] += step(past_[k], g[k] - y_[k], first ? 0 : y_[k] - before_[k], first ? 0 : g[k] - led_to_[k]);
  }
  before_ = y_;
  led_to_ = g;
  y_ = next;
}

}  // namespace sprekk::assembly
