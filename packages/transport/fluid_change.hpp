// Field that the fluid transports and that changes the fluid properties.
#pragma once

#include "base/expression.hpp"
#include "laws/fluid_response.hpp"

#include <string>

namespace sprekk::transport {

struct FluidChange {
  std::string field;  ///< u on cells; on facets the name has the prefix "face "
  laws::FluidResponse response;
  base::Expression initial = 0;  ///< u at the start
};

/// Factor of a mass flow to or from an entity, for the field u of the fluid there, with its derivative.
struct FlowFactor {
  bool changes = false;
  laws::FluidResponse response = {};
  ConstView<Real*> carried = {};  ///< u of the entities

  KOKKOS_INLINE_FUNCTION Real value(LocalIndex row) const { return changes ? response.flow(carried(row)).value : 1; }
  KOKKOS_INLINE_FUNCTION Real slope(LocalIndex row) const { return response.flow(carried(row)).slope; }
};

}  // namespace sprekk::transport
