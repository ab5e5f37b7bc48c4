#include "assembly/relaxation.hpp"

#include <algorithm>
#include <cmath>

namespace sprekk::assembly {
namespace {

constexpr int n_unlimited = 4;  // number of steps before step limits apply
constexpr Real steepest = -100, max_down = 2;
constexpr Real share = 0.25, largest_share = 0.8, share_of_sign_changes = 0.6;
constexpr Real shorter = 0.7, longer = 1.2, shortest = 0.02;

}  // namespace

Real Relaxation::Number::step(Real residual, Real moved, Real change, bool limited) {
  const bool turned = moved * residual < 0;
  const Real retained = largest_share - (largest_share - share) * std::pow(share_of_sign_changes, n_sign_changes);
  const Real remembered = turned ? 2 * slope - 0.5 : retained * slope;
  slope = std::clamp(std::min(moved != 0 ? change / moved : 0, remembered), steepest, Real(0));
  const Real step = std::max(residual / (1 - slope), -max_down);
  if (!limited) return step;
  n_sign_changes += turned;
  step_limit = turned ? std::max(shorter * step_limit, shortest) : std::min(longer * step_limit, Real(1));
  return std::clamp(step, -step_limit, step_limit);
}

void Relaxation::start(std::vector<Real> y) {
  *this = {};
  y_ = std::move(y);
  numbers_.resize(y_.size());
}

void Relaxation::follow(const std::vector<Real>& g) {
  const bool first = last_y_.empty(), limited = ++n_steps_ > n_unlimited;
  auto next = y_;
  for (std::size_t k = 0; k < g.size(); ++k) {
    const Real moved = first ? 0 : y_[k] - last_y_[k], change = first ? 0 : g[k] - last_g_[k];
    next[k] += numbers_[k].step(g[k] - y_[k], moved, change, limited);
  }
  last_y_ = y_;
  last_g_ = g;
  y_ = next;
}

}  // namespace sprekk::assembly
