// Entry of the radiation damping of slip.
#pragma once

#include "laws/kinds.hpp"

namespace sprekk::laws {

/// Shear resistance per slip rate, Pa s/m, of the waves that slip radiates into the rock (Rice 1993).
inline Entry damping_entry() {
  return Entry{"radiation damping", "Pa*s/m", base::at_least(0),
               "shear traction eta per slip rate, by radiated waves: G/(2 c_s) with the shear wave speed c_s"}
      .or_else(0);
}

}  // namespace sprekk::laws
