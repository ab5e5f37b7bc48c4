// Common parts of warnings about mechanical input.
#pragma once

#include "base/check.hpp"
#include "base/sample.hpp"

namespace sprekk::physics {

/// Calls look() and ignores errors of expressions, which the first affected step reports. Not collective.
template <class Look>
void looking(const Look& look) {
  try {
    look();
  } catch (const Error&) {
  }
}

constexpr std::size_t most_times = 12;  ///< at which expressions of t are evaluated, see base::sample_of()

}  // namespace sprekk::physics
