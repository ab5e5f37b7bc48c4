// Temperatures given in a scene.
#pragma once

#include "physics/heat/water.hpp"
#include "physics/scene.hpp"

namespace sprekk::physics {

inline bool is_water(Real T) { return T >= coldest_water && T <= warmest_water; }

/// Calls see(location in the scene, temperature) for all temperatures of a scene.
template <class See>
void for_each_temperature(const Scene& scene, const See& see) {
  if (scene.heat->initial_temperature) see("Heat > \"initial temperature\"", *scene.heat->initial_temperature);
  for (const auto& [name, well] : scene.heat->wells)
    see("Heat > Wells > " + name + " > \"temperature\"", well.temperature);
  for (const auto& [name, region] : scene.regions)
    if (region.temperature) see("Regions > " + name + " > \"temperature\"", *region.temperature);
  for (const auto& [name, condition] : scene.boundary_conditions)
    if (condition.temperature) see("Boundary conditions > " + name + " > \"temperature\"", *condition.temperature);
}

}  // namespace sprekk::physics
