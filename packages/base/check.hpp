// Two kinds of checks and errors that every rank sees.
#pragma once

#include "base/types.hpp"

#include <fmt/format.h>

#include <functional>
#include <stdexcept>
#include <string>

namespace sprekk {

/// An error that a user can understand and mend. What: "where: what is wrong; what is allowed".
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

namespace base {

/// Runs `work` on every rank and then, if it threw on any, throws an Error with the text of the lowest failing rank on
/// all of them, so that no rank is left waiting. Collective.
void collectively(const Comm& comm, const std::function<void()>& work);

}  // namespace base
}  // namespace sprekk

/// A check that is always on: SPREKK_CHECK(n > 0, "cells must be positive, got {}", n);
#define SPREKK_CHECK(condition, ...)                                   \
  do {                                                                 \
    if (!(condition)) throw ::sprekk::Error(fmt::format(__VA_ARGS__)); \
  } while (false)

/// The same for inner loops of host code; only in builds with SPREKK_DEBUG_CHECKS.
#ifdef SPREKK_DEBUG_CHECKS
#define SPREKK_DEBUG_CHECK(condition, ...) SPREKK_CHECK(condition, __VA_ARGS__)
#else
#define SPREKK_DEBUG_CHECK(condition, ...) \
  do {                                     \
  } while (false)
#endif
