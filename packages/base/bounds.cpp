#include "base/bounds.hpp"

#include <fmt/format.h>

#include <cmath>

#include "base/text.hpp"

namespace sprekk::base {

bool Bounds::contains(Real value) const {
  if (std::isinf(value)) return infinite_ && value > 0;
  if (low_is_open_ ? !(value > low_) : !(value >= low_)) return false;
  return high_is_open_ ? value < high_ : value <= high_;
}

std::string Bounds::text() const {
  const bool has_low = std::isfinite(low_), has_high = std::isfinite(high_);
  const auto low = number_text(low_), high = number_text(high_);
  const auto lower = low_ == 0 && low_is_open_ ? "positive" : (low_is_open_ ? "greater than " : "at least ") + low;
  const auto upper = (high_is_open_ ? "less than " : "at most ") + high;
  std::string text = "finite";
  if (has_low && has_high)
    text = low_is_open_ || high_is_open_ ? lower + " and " + upper : fmt::format("between {} and {}", low, high);
  else if (has_low || has_high)
    text = has_low ? lower : upper;
  if (infinite_) text += " or infinite";
  return word_.empty() ? text : fmt::format("{} or \"{}\"", text, word_);
}

std::string Bounds::length_text() const { return size_ ? counted(*size_, "element") : std::string(); }

}  // namespace sprekk::base
