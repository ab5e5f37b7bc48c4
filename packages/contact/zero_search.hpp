// Zero of a function of one variable, for values supplied one by one.
#pragma once

#include "base/types.hpp"

#include <cmath>

namespace sprekk::contact {

/// Search for the zero s > 0 of a non-decreasing function that is negative at s = 0. Steps that grow fourfold bracket
/// the zero. False position (Illinois: Dowell and Jarratt 1971) then reduces the value to a tenth of that at 0. For
/// other functions, even if they change between calls, the search ends at some s >= 0 after at most max_values values.
class ZeroSearch {
 public:
  static constexpr int max_values = 100;

  /// start: value at 0; no search unless negative. first > 0: first point to evaluate. reach: largest s.
  ZeroSearch(Real start, Real first, Real reach)
      : s(start < 0 ? first : 0), start_(start), reach_(reach), done_(!(start < 0) || lost()) {}

  Real s;  ///< next point to evaluate; after the end, the result
  bool done() const { return done_; }
  /// Returns whether there is no zero within reach, or the function is not finite.
  bool lost() const { return !(s <= reach_) || !std::isfinite(s); }

  /// Continues the search with the value of the function at s.
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
    const bool refined = bracketed_ && (std::abs(value) <= -0.1 * start_ || ++n_refined_ > max_refined);
    done_ = refined || ++n_values_ == max_values;
    if (done_) return;
    s = bracketed_ ? (low_ * at_high_ - high_ * at_low_) / (at_high_ - at_low_) : 4 * s;
    done_ = lost();
  }

 private:
  static constexpr int max_refined = 30;

  Real start_, reach_, low_ = 0, at_low_ = start_, high_ = 0, at_high_ = 0;
  int side_ = 0, n_refined_ = 0, n_values_ = 0;
  bool bracketed_ = false, done_;
};

}  // namespace sprekk::contact
