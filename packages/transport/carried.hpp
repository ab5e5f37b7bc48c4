// Quantity transported by a fluid.
#pragma once

#include "base/expression.hpp"
#include "transport/fluid_change.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace sprekk::transport {

/// Quantity transported by a fluid. A fluid volume V at reference conditions carries `capacity` * u * V.
struct Carried {
  /// Boundary with u prescribed or given beyond a transfer resistance, only at cells of the region; empty: all.
  struct Prescribed {
    std::string boundary, region;
  };
  std::string field;  ///< u on cells; on facets the name has the prefix "face "
  Real capacity;
  std::string total, unit;                           ///< name and unit in results.json of the rate supplied by wells
  std::map<std::string, base::Expression> in_wells;  ///< [well] u(t) of the injected fluid; default: local u
  std::optional<FluidChange> change = {};            ///< effect on the fluid; at most one physics has one
  std::vector<Prescribed> prescribed = {};           ///< inflow elsewhere has the local u
};

}  // namespace sprekk::transport
