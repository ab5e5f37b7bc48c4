// Equally spaced elements of a list.
#pragma once

#include <cstddef>
#include <vector>

namespace sprekk::base {

/// Returns at most `maximum` elements at equal intervals, with the last one, in their order.
template <class T>
std::vector<T> sample_of(const std::vector<T>& all, std::size_t maximum) {
  std::vector<T> some;
  const std::size_t n = all.size(), stride = (n + maximum - 1) / maximum;
  for (std::size_t k = n == 0 ? 0 : (n - 1) % stride; k < n; k += stride) some.push_back(all[k]);
  return some;
}

}  // namespace sprekk::base
