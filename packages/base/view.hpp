// Numbers, indices and arrays of kernels: all of Sprekk that needs Kokkos and nothing else of Trilinos.
#pragma once

#include <Kokkos_Core.hpp>

namespace sprekk {

using Real = double;
using LocalIndex = int;         ///< an index on this rank
using GlobalIndex = long long;  ///< an index in the whole problem

/// Where kernels run. Programs that compare back ends name another.
#ifndef SPREKK_EXECUTION
#define SPREKK_EXECUTION Kokkos::DefaultExecutionSpace
#endif
using Execution = SPREKK_EXECUTION;

/// A device array; the last index is contiguous.
template <class T>
using View = Kokkos::View<T, Kokkos::LayoutRight, Execution>;

/// A device array that a kernel only reads.
template <class T>
using ConstView = typename Kokkos::View<T, Kokkos::LayoutRight, Execution>::const_type;

}  // namespace sprekk
