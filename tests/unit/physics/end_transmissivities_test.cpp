// Transmissivities of a fracture face towards its ends.
#include "transport/present_conduits.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace sprekk::transport {
namespace {

laws::Conduit conduit(Real permeability) {
  return {.aperture = 1e-3, .minimum = 1e-5, .permeability = permeability, .viscosity = 1e-3, .compliance = 1e-10};
}

/// The mean over the pressures equals that of Simpson's rule, which is exact for the cubic law.
TEST(EndTransmissivities, AreMeansOverThePressure) {
  for (const Real permeability : {0.0, 1e-9}) {
    const auto along = conduit(permeability);
    const Real rise[] = {1.5e6, -2e6}, widening = 2e-4;
    const EndTransmissivities<2> t(along, widening, rise);
    for (int j = 0; j < 2; ++j) {
      const auto at = [&](Real part) { return along.transmissivity(widening + part * along.compliance * rise[j]); };
      EXPECT_NEAR(t.value[j] / ((at(0) + 4 * at(0.5) + at(1)) / 6), 1, 1e-12) << permeability;
    }
  }
}

/// Derivatives equal difference quotients, also where the ends differ by more than a factor of two. The correction then
/// decreases, and vanishes for very different ends.
TEST(EndTransmissivities, HaveTheirDerivatives) {
  for (const Real permeability : {0.0, 1e-9})
    for (const Real drop : {1e6, 8e6}) {
      const auto along = conduit(permeability);
      const std::array<Real, 3> at = {9 * drop / 10, -drop / 2, drop / 10};
      const auto values = [&](Real widening, const std::array<Real, 3>& rises) {
        const Real rise[] = {rises[0], rises[1], rises[2]};
        return EndTransmissivities<3>(along, widening, rise);
      };
      const auto t = values(0, at);
      for (int k = 0; k < 4; ++k) {
        const Real step = k == 3 ? 1e-8 : 1e2;
        auto more = at, less = at;
        if (k < 3) {
          more[k] += step;
          less[k] -= step;
        }
        const auto high = values(k == 3 ? step : 0, more), low = values(k == 3 ? -step : 0, less);
        for (int j = 0; j < 3; ++j) {
          const Real slope = (high.value[j] - low.value[j]) / (2 * step), scale = t.value[j] / (k == 3 ? 1e-3 : 1e7);
          EXPECT_NEAR((k == 3 ? t.by_widening[j] : t.by_rise[j][k]) / scale, slope / scale, 1e-6) << k << j << drop;
        }
      }
    }
}

/// Ends that differ by a large factor have the transmissivity of the face.
TEST(EndTransmissivities, AreThoseOfTheFaceAtAFront) {
  const auto along = conduit(0);
  const Real rise[] = {1e9, -9e6};
  for (const Real value : EndTransmissivities<2>(along, 0, rise).value)
    EXPECT_NEAR(value / along.transmissivity(), 1, 0.01);
}

/// A sealed face has the transmissivity of its film towards all ends; opened by more than the limit, that of `minimum`.
TEST(EndTransmissivities, AreThoseOfTheFilmOfASealedFace) {
  const laws::Conduit sealed{.minimum = 2e-6, .viscosity = 1e-3, .film = 1e-7};
  const Real rise[] = {1e9, -9e6}, film = 1e-21 / 12 / 1e-3, least = 8e-18 / 12 / 1e-3;
  for (const Real value : EndTransmissivities<2>(sealed, 0, rise).value) EXPECT_NEAR(value / film, 1, 1e-12);
  for (const Real value : EndTransmissivities<2>(sealed, 1e-13, rise).value) EXPECT_NEAR(value / least, 1, 1e-12);
}

}  // namespace
}  // namespace sprekk::transport
