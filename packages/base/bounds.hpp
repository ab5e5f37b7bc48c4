// Admissible values of a parameter.
#pragma once

#include <limits>
#include <optional>
#include <string>

#include "base/view.hpp"

namespace sprekk::base {

/// Interval of admissible numbers. For an array, it applies to each element, and the length may be prescribed:
/// base::between(0, 1).size(3). NaN is never admissible, infinity only after or_infinite().
class Bounds {
 public:
  Bounds& above(Real low) { return low_ = low, low_is_open_ = true, *this; }
  Bounds& from(Real low) { return low_ = low, low_is_open_ = false, *this; }
  Bounds& below(Real high) { return high_ = high, high_is_open_ = true, *this; }
  Bounds& to(Real high) { return high_ = high, high_is_open_ = false, *this; }
  Bounds& or_infinite() { return infinite_ = true, *this; }
  Bounds& or_word(const std::string& word) { return word_ = word, *this; }  ///< in expressions, e.g. "free"
  Bounds& size(std::size_t n) { return size_ = n, *this; }

  bool contains(Real value) const;
  std::optional<std::size_t> size() const { return size_; }
  const std::string& word() const { return word_; }

  std::string text() const;         ///< "at least 0"; "finite" without bounds
  std::string length_text() const;  ///< "3 elements"; empty if any length is allowed

 private:
  static constexpr Real infinity_ = std::numeric_limits<Real>::infinity();
  Real low_ = -infinity_, high_ = infinity_;
  bool low_is_open_ = true, high_is_open_ = true, infinite_ = false;
  std::optional<std::size_t> size_;
  std::string word_;
};

inline Bounds any() { return {}; }  ///< every finite number
inline Bounds at_least(Real low) { return Bounds().from(low); }
inline Bounds greater_than(Real low) { return Bounds().above(low); }
inline Bounds between(Real low, Real high) { return Bounds().from(low).to(high); }  ///< ends included
inline Bounds positive() { return greater_than(0); }
inline Bounds positive_or_infinite() { return positive().or_infinite(); }

}  // namespace sprekk::base
