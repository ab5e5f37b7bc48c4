// Extrapolation of states to the end of the next step.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "fields/block_problem.hpp"

namespace sprekk::solve {

/// Mean rates of change of the last substeps. After a rejected step the last state is that of an earlier substep.
class Predictor {
 public:
  /// Saves the mean rate of a substep from x0, the state at `begin`, to x, the state at `end`.
  void add(const fields::BlockVector& x0, const fields::BlockVector& x, Real begin, Real end) {
    std::rotate(rates_.begin(), rates_.end() - 1, rates_.end());
    const Real dt = end - begin;
    rates_[0] = Rate{begin, end, fields::create_like(x)};
    for (std::size_t b = 0; b < x.size(); ++b) rates_[0]->change[b]->update(1 / dt, *x[b], -1 / dt, *x0[b], 0);
  }

  /// Returns the state at t + dt for the state x at t, extrapolated by the polynomial through the states at t and at
  /// the starts of the last three substeps at most. The correction of x + dt r, with the rate r of the substep that
  /// ends at t, is at most half as large as dt r in each block. Empty if r is unknown. Collective.
  fields::BlockVector predict(const fields::BlockVector& x, Real t, Real dt) const {
    std::vector<const Rate*> last;
    std::vector<Real> times{t};
    for (const auto& rate : rates_) {
      if (!rate || rate->end != times.back() || times.size() > max_degree) continue;
      last.push_back(&*rate);
      times.push_back(rate->begin);
    }
    if (last.empty()) return {};
    const auto lagrange = [&](std::size_t k) {
      Real product = 1;
      for (std::size_t j = 0; j < times.size(); ++j)
        if (j != k) product *= (t + dt - times[j]) / (times[k] - times[j]);
      return product;
    };
    auto predicted = fields::create_like(x);
    for (std::size_t b = 0; b < x.size(); ++b) {
      const auto& rate = *last[0]->change[b];
      fields::Vector correction(rate, Teuchos::Copy);
      correction.scale(-1);
      Real weight = 0;
      for (std::size_t j = last.size(); j-- > 0;) {
        weight += lagrange(j + 1);
        correction.update(weight * (times[j + 1] - times[j]) / dt, *last[j]->change[b], 1);
      }
      const Real size = correction.norm2(), largest = max_correction * rate.norm2();
      predicted[b]->update(1, *x[b], dt, rate, 0);
      if (size > 0) predicted[b]->update(dt * std::min<Real>(1, largest / size), correction, 1);
    }
    return predicted;
  }

 private:
  static constexpr Real max_correction = 0.5;
  static constexpr std::size_t max_degree = 3;
  struct Rate {
    Real begin, end;  // times of the substep
    fields::BlockVector change;
  };
  std::array<std::optional<Rate>, 4> rates_;  // the last substep first
};

}  // namespace sprekk::solve
