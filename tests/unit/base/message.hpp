// Message of the Error that a call throws.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "base/check.hpp"

namespace sprekk::base {

/// Returns the message of the Error that `call` throws. The test fails if `call` throws no Error.
template <class Call>
std::string message_of(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  } catch (const std::exception& error) {
    ADD_FAILURE() << "threw something else than an Error: " << error.what();
    return "";
  }
  ADD_FAILURE() << "threw nothing";
  return "";
}

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != text.npos; }

}  // namespace sprekk::base

#define EXPECT_CONTAINS(text, part) EXPECT_PRED2(sprekk::base::contains, text, part)
