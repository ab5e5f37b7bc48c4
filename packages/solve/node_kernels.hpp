// What the kernels on blocks of nodes share.
#pragma once

#include <type_traits>

#include "base/check.hpp"

namespace sprekk::solve {

/// work(height, width) with the sizes of a block as constants of compile time; false if there is no code for them.
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

/// The same where there must be code for them.
template <class Work>
void with_sizes(int height, int width, const Work& work) {
  SPREKK_CHECK(try_sizes(height, width, work), "multigrid: no code for blocks of {} x {} numbers", height, width);
}

}  // namespace sprekk::solve
