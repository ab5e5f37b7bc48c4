// What the kernels on blocks of nodes share.
#pragma once

#include <type_traits>

#include "base/check.hpp"

namespace sprekk::solve {

/// work(height, width) with the sizes of a block as constants of compile time.
template <class Work>
void with_sizes(int height, int width, const Work& work) {
  const auto is = [&](auto h, auto w) {
    if (height != h() || width != w()) return false;
    work(h, w);
    return true;
  };
  constexpr std::integral_constant<int, 1> one;
  constexpr std::integral_constant<int, 2> two;
  constexpr std::integral_constant<int, 3> three;
  constexpr std::integral_constant<int, 6> six;
  const bool known = is(one, one) || is(two, two) || is(three, three) || is(six, six) || is(two, three) ||
                     is(three, two) || is(three, six) || is(six, three);
  SPREKK_CHECK(known, "multigrid: blocks of {} x {} numbers; allowed are 1, 2, 3 and 6 each", height, width);
}

}  // namespace sprekk::solve
