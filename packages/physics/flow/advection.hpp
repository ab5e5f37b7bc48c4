// What a fluid carries along as it flows through rock and fractures.
#pragma once

#include "physics/flow/fracture_flow.hpp"
#include "physics/flow/stabilisation.hpp"
#include "physics/physics.hpp"

#include <memory>

namespace sprekk::physics {

struct FlowInRock {
  HybridDiffusionParameters darcy;
  Stabilisation stabilisation = {};
};

/// Adds to the rows of a carried quantity u on cells and facets, for a cell K with faces i,
///   sum_i c q_i (u_i^ - u_K)   and, on a facet,   -sum_K c q_i (u_i^ - u_i),   u_i^ = u_K where q_i > 0, else u_i
/// with the outward flow q_i of HybridDiffusion and of Stabilisation, and c = Carried::capacity: upwind, with the facet
/// between two cells as their neighbour. Since what flows is in balance, that is the balance of c u times the mass of
/// fluid; of differences only, so that nothing changes where u is uniform, however well the flow is solved. Where fluid
/// leaves through a boundary without a condition on u, it takes u_K along. `stored`: what local cells store per volume
/// and u, for Antidiffusion, with implicit Euler; empty: upwind alone. Histories: of Antidiffusion and of
/// StabilisedFlow.
std::unique_ptr<assembly::Module> make_advection(mesh::Shape shape, const FlowInRock& flow, const Carried& carried,
                                                 const std::vector<Real>& stored = {});

/// The same along fractures, with the flow of FractureFlow through ridges: all that ends in a ridge mixes there.
/// `widens`: as "widening" of PoroelasticCoupling has it. `stored`: by what fills local fracture faces, per volume.
std::unique_ptr<assembly::Module> make_fracture_advection(mesh::Shape shape, const FractureFlowParameters& flow,
                                                          const Carried& carried, bool widens,
                                                          const std::vector<Real>& stored = {});

}  // namespace sprekk::physics
