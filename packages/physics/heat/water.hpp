// Properties of liquid water at saturation.
#pragma once

#include "laws/fluid_response.hpp"

namespace sprekk::physics {

/// Range of the table, K: from the triple point to 350 degrees Celsius.
constexpr Real coldest_water = 273.16, warmest_water = 623.15;

/// Density of the saturated liquid, kg/m^3: IAPWS SR1-86 (1992); Wagner and Pruss (1993). Differs by less than 0.1 %
/// from IAPWS-95.
Real water_density(Real T);
/// Viscosity, Pa s: IAPWS R12-08 without critical enhancement, at water_density(T) or at the given density. Differs by
/// less than 2 % from measurements.
Real water_viscosity(Real T);
Real water_viscosity(Real T, Real density);
/// Density relative to that at `reference`, and inverse relative viscosity, tabulated in steps of 1 K. Both are
/// constant outside of the table.
laws::FluidResponse response_of_water(Real reference);

}  // namespace sprekk::physics
