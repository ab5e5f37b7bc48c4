// Numbers, indices and arrays of kernels. This header requires Kokkos but no other part of Trilinos.
#pragma once

#include <Kokkos_Core.hpp>

namespace sprekk {

using Real = double;
using LocalIndex = int;         ///< index on this rank
using GlobalIndex = long long;  ///< index in the whole problem

/// Execution space of kernels. Programs that compare back ends define another one.
#ifndef SPREKK_EXECUTION
#define SPREKK_EXECUTION Kokkos::DefaultExecutionSpace
#endif
using Execution = SPREKK_EXECUTION;

/// Device array; the last index is contiguous.
template <class T>
using View = Kokkos::View<T, Kokkos::LayoutRight, Execution>;

/// Device array, read-only in kernels.
template <class T>
using ConstView = typename Kokkos::View<T, Kokkos::LayoutRight, Execution>::const_type;

}  // namespace sprekk
