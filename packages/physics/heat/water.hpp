// Liquid water at saturation.
#pragma once

#include "laws/fluid_response.hpp"

namespace sprekk::physics {

/// Where it is tabulated, K: from the triple point to 350 degrees Celsius.
constexpr Real coldest_water = 273.16, warmest_water = 623.15;

/// Density, kg/m^3: IAPWS SR1-86 (1992), of saturated liquid; Wagner and Pruss (1993). Below 0.1 % off what IAPWS-95
/// has.
Real water_density(Real T);
/// Viscosity, Pa s: IAPWS R12-08 without the enhancement at the critical point, at that density; below 2 % off the
/// measurements.
Real water_viscosity(Real T);
Real water_viscosity(Real T, Real density);
/// Both over those at a temperature, in steps of 1 K, constant outside of the table.
laws::FluidResponse response_of_water(Real reference);

}  // namespace sprekk::physics
