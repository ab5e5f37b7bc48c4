// Wells of a scene, and channels along intersections of its fractures.
#pragma once

#include "physics/physics.hpp"
#include "transport/intersection_flow.hpp"
#include "transport/wells.hpp"

#include <vector>

namespace sprekk::physics {

struct IntersectionSection;

std::vector<transport::Well> wells_in(const Scene& scene, int dim);

transport::Channel channel_of(const IntersectionSection& section, const Scene& scene, const mesh::Mesh& mesh);

}  // namespace sprekk::physics
