// The error of fluxes and pressures of a fluid, as far as the mesh is to blame.
#pragma once

#include "assembly/system.hpp"
#include "physics/flow/wells.hpp"
#include "physics/hybrid_error.hpp"

#include <memory>

namespace sprekk::physics {

/// HybridError of the system's pressures, with these functionals, by Functional::what:
/// pressure: of a well with a rate, Pa; or the mean over fractures. flow: into the rock and the fractures, m^3/s (2D:
/// m^2/s), from a well with a pressure, or through a boundary, of which the derivative is that where the pressure is
/// prescribed. A well in rock is told apart from the cells around it by its index W, see make_wells(), which makes up
/// for what they miss: the components of a well's cell and of those that share a corner with it are zero, and with such
/// wells functionals have no value: Error. Refers to the system. Collective.
std::unique_ptr<MeshError> make_flow_error(assembly::System& system, HybridErrorParameters parameters,
                                           WellsParameters wells);

}  // namespace sprekk::physics
