#include "solve/iterates.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace sprekk::solve {
namespace {

constexpr std::size_t memory = 3, patience = 5, trial_period = 10, short_steps = 4;
constexpr int lately = 5;
constexpr Real min_way = 0.5, swing_damping = 0.3;

}  // namespace

void Iterates::restart() {
  since_ = merits_.size();
  cycle_ = false;
  visited_.clear();
}

void Iterates::accept(const Iterate& iterate) {
  if (iterate.of_other_f) merits_.clear();
  merits_.push_back(iterate.merit);
  if (iterate.of_other_f) restart();
  steps_.push_back(iterate.step);
  compare(iterate.states);
  changed_ = iterate.pattern != pattern_;
  pattern_ = iterate.pattern;
  const auto seen = visited_.find(pattern_);
  if (seen != visited_.end() && iterate.merit >= seen->second && !iterate.lagged) cycle_ = true;
  visited_[pattern_] = iterate.merit;
  note_progress(iterate.lagged);
}

void Iterates::compare(const std::vector<char>& states) {
  const int now = static_cast<int>(merits_.size()) - 1;
  last_change_.resize(states.size(), 0);
  n_changes_.resize(states.size(), 0);
  swinging_.assign(states.size(), 0);
  for (std::size_t k = 0; k < states.size() && now > 0; ++k) {
    if (states[k] == states_[k]) continue;
    int& last = last_change_[k];
    if (last > 0 && last >= now - 2) swinging_[k] = swing_damping;
    last = now;
    ++n_changes_[k];
  }
  states_ = states;
}

void Iterates::note_progress(bool lagged) {
  const bool first = merits_.size() == since_ + 1;
  if (first || changed_ || lagged || merits_.back() < 0.5 * best_) progress_ = merits_.size();
  best_ = first ? merits_.back() : std::min(best_, merits_.back());
}

Real Iterates::limit(bool lagged) const {
  if (merits_.size() <= since_) return std::numeric_limits<Real>::infinity();
  if (cycle_ || lagged) return merits_.back();
  return *std::max_element(merits_.end() - std::min(memory, merits_.size() - since_), merits_.end());
}

bool Iterates::swings() const {
  return std::any_of(swinging_.begin(), swinging_.end(), [](Real damping) { return damping > 0; });
}

std::vector<char> Iterates::changed_lately() const {
  std::vector<char> changed;
  for (int last : last_change_) changed.push_back(last > 0 && last + lately > static_cast<int>(merits_.size()));
  return changed;
}

bool Iterates::stagnate(bool storage) const {
  if (storage && steps_.size() >= short_steps &&
      std::accumulate(steps_.end() - short_steps, steps_.end(), 0.0) < min_way)
    return true;
  if (merits_.size() < trial_period) return false;
  const auto recent = merits_.end() - patience;
  return *std::min_element(recent, merits_.end()) > 0.5 * *std::min_element(merits_.begin(), recent);
}

bool Iterates::stagnate_without_lag() const { return merits_.size() > progress_ + trial_period; }

}  // namespace sprekk::solve
