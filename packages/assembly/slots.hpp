// Descriptions of the unknowns and rows of local operators.
#pragma once

#include "base/view.hpp"

namespace sprekk::assembly {

/// Slot of `Count` groups of `Width` adjacent unknowns of one field.
template <int Count, int Width>
struct Slot {
  static constexpr int count = Count, width = Width, size = Count * Width;
};

/// Fields that a local operator reads or writes: one slot each, consecutive in the local arrays of the operator.
template <class... S>
struct Slots {
  static constexpr int n = sizeof...(S);
  static constexpr int size = (S::size + ... + 0);
  KOKKOS_INLINE_FUNCTION static constexpr int count(int i) {
    const int values[] = {S::count...};
    return values[i];
  }
  KOKKOS_INLINE_FUNCTION static constexpr int width(int i) {
    const int values[] = {S::width...};
    return values[i];
  }
  KOKKOS_INLINE_FUNCTION static constexpr int offset(int i) {
    const int values[] = {S::size...};
    int sum = 0;
    for (int k = 0; k < i; ++k) sum += values[k];
    return sum;
  }
};

}  // namespace sprekk::assembly
