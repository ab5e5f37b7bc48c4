// How a program takes memory from the system.
#pragma once

#include <cstdlib>  // defines __GLIBC__
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace sprekk::base {

/// The heap of the process grows by many pages at once, and keeps what steps free and take again: the kernel need not
/// clear them anew. Arrays above 32 MB are returned as ever. To be called first in main(); without glibc it
/// does nothing.
inline void keep_heap() {
#ifdef __GLIBC__
  constexpr int MB = 1 << 20;
  mallopt(M_MMAP_THRESHOLD, 32 * MB);
  mallopt(M_TRIM_THRESHOLD, 64 * MB);
  mallopt(M_TOP_PAD, 64 * MB);
#endif
}

}  // namespace sprekk::base
