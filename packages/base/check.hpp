// Checks, and errors that all ranks throw.
#pragma once

#include "base/types.hpp"

#include <fmt/format.h>

#include <functional>
#include <stdexcept>
#include <string>

namespace sprekk {

/// Error that a user can understand and correct. Format of the message: "where: what is wrong; what is allowed".
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

namespace base {

/// Runs `work` on every rank. If it throws on any rank, all ranks throw an Error with the message of the lowest failing
/// rank, so no rank waits forever. Collective.
void collectively(const Comm& comm, const std::function<void()>& work);

}  // namespace base
}  // namespace sprekk

/// Throws an Error if the condition is false, in all builds: SPREKK_CHECK(n > 0, "cells must be positive, got {}", n);
#define SPREKK_CHECK(condition, ...)                                   \
  do {                                                                 \
    if (!(condition)) throw ::sprekk::Error(fmt::format(__VA_ARGS__)); \
  } while (false)
