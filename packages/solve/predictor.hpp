// Extrapolation of states to the end of the next step.
#pragma once

#include <array>
#include <optional>

#include "fields/block_problem.hpp"

namespace sprekk::solve {

/// Rates of change of the last two substeps. After a rejected step the last state is that of the substep before.
class Predictor {
 public:
  /// Saves the rate of a substep of length dt from x0 to x, which is the state at t.
  void add(const fields::BlockVector& x0, const fields::BlockVector& x, Real t, Real dt) {
    rates_[1] = std::move(rates_[0]);
    rates_[0] = Rate{t, fields::create_like(x)};
    for (std::size_t b = 0; b < x.size(); ++b) rates_[0]->change[b]->update(1 / dt, *x[b], -1 / dt, *x0[b], 0);
  }

  /// Returns x + dt dx/dt for the state x at t; empty if the rate of the substep that ends at t is unknown.
  fields::BlockVector predict(const fields::BlockVector& x, Real t, Real dt) const {
    for (const auto& rate : rates_) {
      if (!rate || rate->end != t) continue;
      auto predicted = fields::create_like(x);
      for (std::size_t b = 0; b < x.size(); ++b) predicted[b]->update(1, *x[b], dt, *rate->change[b], 0);
      return predicted;
    }
    return {};
  }

 private:
  struct Rate {
    Real end;  // time at the end of the substep
    fields::BlockVector change;
  };
  std::array<std::optional<Rate>, 2> rates_;  // the last substep first
};

}  // namespace sprekk::solve
