// Extrapolation of states to the end of the next step.
#pragma once

#include <algorithm>
#include <array>
#include <optional>

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

  /// Returns x + dt r for the state x at t. r is the mean rate of the next substep: that of the substep that ends at t,
  /// extrapolated linearly from the middles of this substep and the one before. The correction of each block is at most
  /// half as large as the rate. Empty if the rate of the substep that ends at t is unknown. Collective.
  fields::BlockVector predict(const fields::BlockVector& x, Real t, Real dt) const {
    const auto last =
        std::find_if(rates_.begin(), rates_.end(), [&](const auto& rate) { return rate && rate->end == t; });
    if (last == rates_.end()) return {};
    const auto before =
        std::find_if(last + 1, rates_.end(), [&](const auto& rate) { return rate && rate->end == (*last)->begin; });
    auto predicted = fields::create_like(x);
    for (std::size_t b = 0; b < x.size(); ++b) {
      const auto& rate = *(*last)->change[b];
      predicted[b]->update(1, *x[b], dt, rate, 0);
      if (before == rates_.end()) continue;
      fields::Vector difference(rate, Teuchos::Copy);
      difference.update(-1, *(*before)->change[b], 1);
      const Real steps = (t - (*before)->begin) / 2, size = difference.norm2(),
                 weight = (dt + t - (*last)->begin) / (2 * steps);
      if (size > 0) predicted[b]->update(dt * std::min(weight, max_correction * rate.norm2() / size), difference, 1);
    }
    return predicted;
  }

 private:
  static constexpr Real max_correction = 0.5;
  struct Rate {
    Real begin, end;  // times of the substep
    fields::BlockVector change;
  };
  std::array<std::optional<Rate>, 3> rates_;  // the last substep first
};

}  // namespace sprekk::solve
