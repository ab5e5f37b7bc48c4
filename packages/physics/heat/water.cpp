#include "physics/heat/water.hpp"

#include <cmath>

#include "base/host_table.hpp"

namespace sprekk::physics {

namespace {

constexpr Real critical_temperature = 647.096, critical_density = 322;  // K, kg/m^3

}  // namespace

Real water_density(Real T) {
  const Real x = std::cbrt(1 - T / critical_temperature);
  return critical_density *
         (1 + 1.99274064 * x + 1.09965342 * std::pow(x, 2) - 0.510839303 * std::pow(x, 5) -
          1.75493479 * std::pow(x, 16) - 45.5170352 * std::pow(x, 43) - 6.74694450e5 * std::pow(x, 110));
}

Real water_viscosity(Real T) { return water_viscosity(T, water_density(T)); }

/// Evaluates equations (11) and (12) of R12-08.
Real water_viscosity(Real T, Real density) {
  const Real t = T / critical_temperature;
  const Real dilute = 100 * std::sqrt(t) / (1.67752 + 2.20462 / t + 0.6366564 / (t * t) - 0.241605 / (t * t * t));
  struct Term {
    int i, j;
    Real H;
  };
  constexpr Term terms[] = {{0, 0, 5.20094e-1},  {1, 0, 8.50895e-2},  {2, 0, -1.08374},    {3, 0, -2.89555e-1},
                            {0, 1, 2.22531e-1},  {1, 1, 9.99115e-1},  {2, 1, 1.88797},     {3, 1, 1.26613},
                            {5, 1, 1.20573e-1},  {0, 2, -2.81378e-1}, {1, 2, -9.06851e-1}, {2, 2, -7.72479e-1},
                            {3, 2, -4.89837e-1}, {4, 2, -2.57040e-1}, {0, 3, 1.61913e-1},  {1, 3, 2.57399e-1},
                            {0, 4, -3.25372e-2}, {3, 4, 6.98452e-2},  {4, 5, 8.72102e-3},  {3, 6, -4.35673e-3},
                            {5, 6, -5.93264e-4}};
  Real sum = 0;
  for (const auto& [i, j, H] : terms) sum += H * std::pow(1 / t - 1, i) * std::pow(density / critical_density - 1, j);
  return 1e-6 * dilute * std::exp(density / critical_density * sum);
}

laws::FluidResponse response_of_water(Real reference) {
  constexpr int n = 351;
  constexpr Real step = (warmest_water - coldest_water) / (n - 1), nearby = 0.01;
  const auto density = [&](Real T) { return water_density(T) / water_density(reference); };
  const auto mobility = [&](Real T) { return water_viscosity(reference) / water_viscosity(T); };
  const base::HostTable<Real**> knots("water", n, 4);
  for (int k = 0; k < n; ++k) {
    const Real T = coldest_water + k * step;
    const auto put = [&](int column, const auto& of) {
      knots(k, column) = of(T);
      knots(k, column + 1) = step * (of(T + nearby) - of(T - nearby)) / (2 * nearby);
    };
    put(0, density);
    put(2, mobility);
  }
  laws::FluidResponse response{.reference = reference, .first = coldest_water, .distance = step};
  response.knots = knots.on_device();
  return response;
}

}  // namespace sprekk::physics
