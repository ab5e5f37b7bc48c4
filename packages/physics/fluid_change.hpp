// What a fluid carries and is changed by.
#pragma once

#include "base/expression.hpp"
#include "laws/fluid_response.hpp"

#include <optional>
#include <string>

namespace sprekk::physics {

struct FluidChange {
  std::string field;  ///< u on cells; on facets "face " before it
  laws::FluidResponse response;
  base::Expression initial = 0;  ///< u at the start
};

/// What a flow of mass to or from an entity is times for what the fluid there carries, and its derivative.
struct FlowFactor {
  bool changes = false;
  laws::FluidResponse response = {};
  ConstView<Real*> carried = {};  ///< u

  KOKKOS_INLINE_FUNCTION Real value(LocalIndex row) const { return changes ? response.flow(carried(row)).value : 1; }
  KOKKOS_INLINE_FUNCTION Real slope(LocalIndex row) const { return response.flow(carried(row)).slope; }
};

}  // namespace sprekk::physics
