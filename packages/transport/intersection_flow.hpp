// Flow of a fluid in channels along the intersections of fractures, in 3D.
#pragma once

#include "assembly/constraints.hpp"
#include "assembly/module.hpp"
#include "laws/fluid.hpp"
#include "transport/carried.hpp"
#include "transport/fluid_change.hpp"
#include "transport/storage.hpp"

#include <array>
#include <memory>
#include <optional>
#include <vector>

namespace sprekk::transport {

/// Channel in all edges at which its fractures meet; without fractures in all intersections. The conductances of
/// several channels in one edge add up.
struct Channel {
  std::vector<int> fractures = {};  ///< indices into fracture_names, ascending
  Real conductance = 0;             ///< C = k A/mu, flow per pressure gradient, m^4/(Pa s)
  Real area = 0;                    ///< cross-sectional area A of the stored fluid, m^2
};

struct IntersectionFlowParameters {
  std::vector<Channel> channels;
  std::vector<assembly::DirichletCondition> constrained = {};  ///< conditions that prescribe "face pressure"
  laws::Fluid fluid = {};
  std::optional<FluidChange> change = {};  ///< the properties of the fluid are those of the mean u of both edges
  std::array<Real, 3> weight{};            ///< rho_0 g, N/m^3
};

/// Length of a channel on all ranks, m; 0 in 2D. Collective.
Real length_of(const Channel& channel, const mesh::Mesh& mesh);

/// Returns the edges with channels and the capacity `of_fluid`, per volume of fluid, times the area of their channels.
/// Not collective.
std::vector<EdgeCapacity> stored_in(const std::vector<Channel>& channels, const Capacity& of_fluid,
                                    const mesh::Mesh& mesh);

/// Creates the module of the flow along intersections, whose pressure is that of their ridges. For two edges a and b at
/// a point it adds q to the row of "face pressure" of a, and -q to that of b:
///   q = T (p_a - p_b + rho_0 g . (x_b - x_a)),   T = t_a t_b/sum t,   t = 2 C/length.
/// This is the flow through a point whose pressure is eliminated; the flows of each point add up to zero. If n borders
/// of fractures with a prescribed pressure end at the point, the pressure of the point is their mean: T = t_a/n for
/// each of them, and 0 between other edges. Other ends of channels are closed. For a compressible fluid see
/// laws::Fluid::drop().
///
/// Output: "channel flow" (facets, m^3/s, global components): the mean of the flows through both ends of an edge, along
/// the edge. Collective.
std::unique_ptr<assembly::Module> make_intersection_flow(const mesh::Mesh& mesh,
                                                         const IntersectionFlowParameters& parameters);

/// Creates the upwind advection of a quantity by this flow between ridges, see make_advection(). Collective.
std::unique_ptr<assembly::Module> make_intersection_advection(const mesh::Mesh& mesh,
                                                              const IntersectionFlowParameters& parameters,
                                                              const Carried& carried);

}  // namespace sprekk::transport
