// Settings of the memory allocator.
#pragma once

#include <cstdlib>  // defines __GLIBC__
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace sprekk::base {

/// Makes the heap grow by many pages at once and retain freed memory for the next steps, so the kernel need not clear
/// pages again. Arrays above 32 MB are still returned to the system. Call it first in main(). No effect without glibc.
inline void keep_heap() {
#ifdef __GLIBC__
  constexpr int MB = 1 << 20;
  mallopt(M_MMAP_THRESHOLD, 32 * MB);
  mallopt(M_TRIM_THRESHOLD, 64 * MB);
  mallopt(M_TOP_PAD, 64 * MB);
#endif
}

}  // namespace sprekk::base
