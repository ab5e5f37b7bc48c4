// Advection of quantities that the fluid transports through rock and fractures.
#pragma once

#include "transport/carried.hpp"
#include "transport/fracture_flow.hpp"
#include "transport/stabilisation.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace sprekk::transport {

struct FlowInRock {
  HybridDiffusionParameters darcy;
  Stabilisation stabilisation = {};
};

/// Creates the upwind advection of a quantity u on cells and facets. For a cell K with faces i, and for a facet, it
/// adds
///   sum_i c q_i (u_i^ - u_K)   and   -sum_K c q_i (u_i^ - u_i),   u_i^ = u_K where q_i > 0, else u_i
/// with c = Carried::capacity and the outward flow q_i of HybridDiffusion and Stabilisation. The facet between two
/// cells is their upwind neighbour. Since the fluid mass is balanced, this equals the balance of c u times the mass.
/// The rows contain differences only: a uniform u stays uniform, even with an inaccurate flow solution. Outflow through
/// a boundary without a condition on u carries u_K. So does inflow: the row of its facet receives -c q_i (u_i - u_K).
/// Cell and facet then exchange u as by a conductance -c q_i. Without this term, u_i would be extrapolated from the
/// interior and carried back into the cell, and small differences would grow fast from step to step.
///
/// `stored`: storage capacity of local cells per volume and unit of u, for Antidiffusion with implicit Euler; none:
/// upwind only. History variables: those of Antidiffusion and StabilisedFlow.
std::unique_ptr<assembly::Module> make_advection(mesh::Shape shape, const FlowInRock& flow, const Carried& carried,
                                                 const std::optional<std::vector<Real>>& stored = {});

/// Creates the advection along fractures with the flow of FractureFlow through ridges. All flows into a ridge mix
/// there. `widens`: apertures depend on "widening" of FractureOpening. `stored`: storage capacity of the filling of
/// local fracture faces, per volume.
std::unique_ptr<assembly::Module> make_fracture_advection(mesh::Shape shape, const FractureFlowParameters& flow,
                                                          const Carried& carried, bool widens,
                                                          const std::optional<std::vector<Real>>& stored = {});

}  // namespace sprekk::transport
