// Block sizes with compiled code.
#pragma once

#include <type_traits>

#include "base/check.hpp"
#include "fields/node_kernels.hpp"

namespace sprekk::multigrid {

using fields::Cursor;
using fields::Numbers;

/// Calls work(height, width) with the block size as compile-time constants. Returns false if there is no code for this
/// size.
template <class Work>
bool try_sizes(int height, int width, const Work& work) {
  const auto is = [&](auto h, auto w) {
    if (height != h() || width != w()) return false;
    work(h, w);
    return true;
  };
  constexpr std::integral_constant<int, 1> one;
  constexpr std::integral_constant<int, 2> two;
  constexpr std::integral_constant<int, 3> three;
  constexpr std::integral_constant<int, 6> six;
  return is(one, one) || is(two, two) || is(three, three) || is(six, six) || is(two, three) || is(three, two) ||
         is(three, six) || is(six, three);
}

/// Calls work like try_sizes(), with the widest instructions. Throws an Error if there is no code for this size.
template <class Work>
void with_sizes(int height, int width, const Work& work) {
  bool found = false;
  fields::in_widest_instructions([&] { found = try_sizes(height, width, work); });
  SPREKK_CHECK(found, "multigrid: no code for blocks of {} x {} numbers", height, width);
}

}  // namespace sprekk::multigrid
