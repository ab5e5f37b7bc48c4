#include "physics/flow/wells_and_channels.hpp"

#include "base/names.hpp"
#include "physics/flow/flow.hpp"
#include "physics/scene.hpp"

#include <algorithm>
#include <cmath>

namespace sprekk::physics {

std::vector<transport::Well> wells_in(const Scene& scene, int dim) {
  std::vector<transport::Well> wells;
  for (const auto& [name, one] : scene.flow->wells) {
    wells.push_back({.name = name,
                     .points = {},
                     .radius = one.radius,
                     .skin = one.skin,
                     .rate = one.rate,
                     .pressure = one.pressure});
    for (std::size_t k = 0; k < one.points.size(); k += dim)
      std::copy_n(&one.points[k], dim, wells.back().points.emplace_back().begin());
  }
  return wells;
}

transport::Channel channel_of(const IntersectionSection& section, const Scene& scene, const mesh::Mesh& mesh) {
  const Real permeability_area = section.conductance(1);
  transport::Channel channel{.conductance = permeability_area / scene.flow->viscosity,
                             .area = std::sqrt(8 * M_PI * permeability_area)};
  for (const auto& name : section.fractures) channel.fractures.push_back(base::index_of(mesh.fracture_names, name));
  std::sort(channel.fractures.begin(), channel.fractures.end());
  return channel;
}

}  // namespace sprekk::physics
