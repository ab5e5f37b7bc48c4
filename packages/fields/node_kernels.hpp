// Shared parts of kernels on nodal blocks, and all compiler-dependent code: vector types, prefetching, wide
// instructions. Each has a fallback. The device code of these kernels has never been compiled.
#pragma once

#include "base/view.hpp"

#include <cstddef>
#include <cstdint>

namespace sprekk::fields {

#if defined(__GNUC__)  // also Clang
template <int n>
struct Pack {
  typedef Real Type __attribute__((vector_size(n * sizeof(Real)), aligned(alignof(Real)), may_alias));
};

/// Prefetches memory that will soon be read.
KOKKOS_FORCEINLINE_FUNCTION void prefetch(const void* address) { __builtin_prefetch(address); }

/// Index of the lowest set bit; bits must not be 0.
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

/// Array of n adjacent numbers in vectors of 4, 2 and 1.
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
  /// Computes += a x.
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

/// Search for columns in a list without duplicates. Fast if the columns are searched nearly in the order of the list.
struct Cursor {
  const LocalIndex* column;
  std::size_t n;
  std::size_t at = 0;  // first index of the next search

  /// Returns the index of a column, or n if it is not in the list.
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
/// Runs work() and all functions that it calls with AVX2 and FMA instructions.
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

/// Runs work() with AVX2 and FMA instructions if the processor supports them. For this purpose work() is compiled
/// twice.
template <class Work>
void in_widest_instructions(const Work& work) {
  if (has_wide_instructions())
    in_wide_instructions(work);
  else
    work();
}

}  // namespace sprekk::fields
