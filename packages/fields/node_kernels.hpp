// What kernels on blocks of nodes share, and all that depends on the compiler: vector types, prefetching, wide
// instructions, each with a fallback. Device code of these kernels has never been compiled.
#pragma once

#include "base/view.hpp"

#include <cstddef>
#include <cstdint>

namespace sprekk::fields {

#if defined(__GNUC__)  // Clang has them as well
template <int n>
struct Pack {
  typedef Real Type __attribute__((vector_size(n * sizeof(Real)), aligned(alignof(Real)), may_alias));
};

/// Asks memory for what will be read soon.
KOKKOS_FORCEINLINE_FUNCTION void prefetch(const void* address) { __builtin_prefetch(address); }

/// The number of the lowest bit that is set; there must be one.
KOKKOS_FORCEINLINE_FUNCTION std::size_t lowest_bit(std::uint64_t bits) { return __builtin_ctzll(bits); }
#else
template <int n>
struct Pack {
  struct Type {
    Real number[n];

    KOKKOS_FORCEINLINE_FUNCTION Type& operator+=(const Type& x) {
      for (int k = 0; k < n; ++k) number[k] += x.number[k];
      return *this;
    }
    KOKKOS_FORCEINLINE_FUNCTION friend Type operator*(Type a, const Type& b) {
      for (int k = 0; k < n; ++k) a.number[k] *= b.number[k];
      return a;
    }
    KOKKOS_FORCEINLINE_FUNCTION friend Type operator*(Real a, Type b) {
      for (int k = 0; k < n; ++k) b.number[k] *= a;
      return b;
    }
  };
};

KOKKOS_FORCEINLINE_FUNCTION void prefetch(const void*) {}

KOKKOS_FORCEINLINE_FUNCTION std::size_t lowest_bit(std::uint64_t bits) {
  std::size_t lowest = 0;
  for (; (bits & 1) == 0; bits >>= 1) ++lowest;
  return lowest;
}
#endif

/// n numbers that lie together, in vectors of 4, 2 and 1 of them.
template <int n>
struct Numbers {
  static constexpr int here = n >= 4 ? 4 : n >= 2 ? 2 : 1;
  using Vector = typename Pack<here>::Type;

  Vector head = {};
  Numbers<n - here> rest;

  KOKKOS_FORCEINLINE_FUNCTION void load(const Real* from) {
    head = *reinterpret_cast<const Vector*>(from);
    rest.load(from + here);
  }
  KOKKOS_FORCEINLINE_FUNCTION void load(const float* from) {
    Real numbers[here];
    for (int k = 0; k < here; ++k) numbers[k] = from[k];
    head = *reinterpret_cast<const Vector*>(numbers);
    rest.load(from + here);
  }
  KOKKOS_FORCEINLINE_FUNCTION void store(Real* to) const {
    *reinterpret_cast<Vector*>(to) = head;
    rest.store(to + here);
  }
  /// += a x
  KOKKOS_FORCEINLINE_FUNCTION void add(Real a, const Numbers& x) {
    head += a * x.head;
    rest.add(a, x.rest);
  }
};

template <>
struct Numbers<0> {
  KOKKOS_FORCEINLINE_FUNCTION void load(const Real*) {}
  KOKKOS_FORCEINLINE_FUNCTION void load(const float*) {}
  KOKKOS_FORCEINLINE_FUNCTION void store(Real*) const {}
  KOKKOS_FORCEINLINE_FUNCTION void add(Real, const Numbers&) {}
};

/// Finds columns in a list that has none twice: fast where they come in its order, or nearly so.
struct Cursor {
  const LocalIndex* column;
  std::size_t n;
  std::size_t at = 0;  // where the next one is looked for first

  /// n if it is not there.
  KOKKOS_FORCEINLINE_FUNCTION std::size_t find(LocalIndex wanted) {
    for (std::size_t looked_at = 0; looked_at < n; ++looked_at) {
      const std::size_t here = at;
      at = at + 1 < n ? at + 1 : 0;
      if (column[here] == wanted) return here;
    }
    return n;
  }
};

#if defined(__x86_64__) && defined(__GNUC__) && !defined(KOKKOS_ENABLE_CUDA) && !defined(KOKKOS_ENABLE_HIP) && \
    !defined(KOKKOS_ENABLE_SYCL)
#define SPREKK_WIDE_INSTRUCTIONS
/// work() with all that it calls, in instructions on four numbers at a time.
template <class Work>
__attribute__((target("avx2,fma"), flatten)) void in_wide_instructions(const Work& work) {
  work();
}
inline bool has_wide_instructions() { return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"); }
#else
template <class Work>
void in_wide_instructions(const Work& work) {
  work();
}
inline bool has_wide_instructions() { return false; }
#endif

/// work(), compiled a second time for processors with wider instructions than every x86-64 has, and run in these where
/// the present one has them.
template <class Work>
void in_widest_instructions(const Work& work) {
  if (has_wide_instructions())
    in_wide_instructions(work);
  else
    work();
}

}  // namespace sprekk::fields
