// Common parts of warnings about mechanical input.
#pragma once

#include "base/check.hpp"
#include "base/types.hpp"

#include <vector>

namespace sprekk::physics {

/// Calls look() and ignores errors of expressions, which the first affected step reports. Not collective.
template <class Look>
void looking(const Look& look) {
  try {
    look();
  } catch (const Error&) {
  }
}

/// At most twelve of the times, including the last one.
std::vector<Real> some_of(const std::vector<Real>& times);

}  // namespace sprekk::physics
