// The zero of a function of one variable that is told value by value.
#pragma once

#include "base/types.hpp"

#include <cmath>

namespace sprekk::contact {

/// The zero s > 0 of a function that does not fall and is below zero at s = 0: bracketed by steps that grow fourfold,
/// then by false position (Illinois: Dowell and Jarratt 1971), to a tenth of the value at 0.
/// Of another function, also of one that changes between calls, it takes some s >= 0: it ends after at most
/// most_values in any case.
class ZeroSearch {
 public:
  static constexpr int most_values = 100;

  /// `start`: the value at 0; no search unless it is below zero. `first` > 0: where to look first. `reach`: no zero is
  /// looked for beyond it.
  ZeroSearch(Real start, Real first, Real reach)
      : s(start < 0 ? first : 0), start_(start), reach_(reach), done_(!(start < 0) || lost()) {}

  Real s;  ///< where the function is to be evaluated next; at the end, the result
  bool done() const { return done_; }
  /// No zero within reach, or a function that is not finite.
  bool lost() const { return !(s <= reach_) || !std::isfinite(s); }

  /// `value`: of the function at s.
  void next(Real value) {
    if (done_) return;
    if (value < 0) {
      if (side_ < 0) at_high_ /= 2;
      low_ = s;
      at_low_ = value;
    } else {
      if (side_ > 0) at_low_ /= 2;
      high_ = s;
      at_high_ = value;
      bracketed_ = true;
    }
    side_ = value < 0 ? -1 : 1;
    const bool refined = bracketed_ && (std::abs(value) <= -0.1 * start_ || ++n_refined_ > most_refined);
    done_ = refined || ++n_values_ == most_values;
    if (done_) return;
    s = bracketed_ ? (low_ * at_high_ - high_ * at_low_) / (at_high_ - at_low_) : 4 * s;
    done_ = lost();
  }

 private:
  static constexpr int most_refined = 30;

  Real start_, reach_, low_ = 0, at_low_ = start_, high_ = 0, at_high_ = 0;
  int side_ = 0, n_refined_ = 0, n_values_ = 0;
  bool bracketed_ = false, done_;
};

}  // namespace sprekk::contact
