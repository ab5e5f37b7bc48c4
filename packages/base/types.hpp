// The few types that every package speaks.
#pragma once

#include <Kokkos_Core.hpp>
#include <Teuchos_Comm.hpp>
#include <Teuchos_RCP.hpp>

namespace sprekk {

using Real = double;
using LocalIndex = int;         ///< an index on this rank
using GlobalIndex = long long;  ///< an index in the whole problem

using Comm = Teuchos::Comm<int>;
using Teuchos::RCP;
using Teuchos::rcp;

using Execution = Kokkos::DefaultExecutionSpace;

/// A device array; the last index is contiguous.
template <class T>
using View = Kokkos::View<T, Kokkos::LayoutRight, Execution>;

/// A device array that a kernel only reads.
template <class T>
using ConstView = typename Kokkos::View<T, Kokkos::LayoutRight, Execution>::const_type;

}  // namespace sprekk
