// Entries shared by laws that depend on the slip rate.
#pragma once

#include "laws/kinds.hpp"

namespace sprekk::laws {

inline Entry evolution_distance_entry() {
  return Entry{"state evolution distance", "m", base::positive(), "slip distance L over which the state evolves"};
}
inline Entry initial_rate_entry() {
  return Entry{"initial slip rate", "m/s", base::positive(), "slip rate V_i at the start"};
}

}  // namespace sprekk::laws
