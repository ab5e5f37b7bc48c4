// Data of the fluid flow for error estimates.
#pragma once

#include "laws/conduit.hpp"
#include "transport/hybrid_flux.hpp"
#include "transport/wells.hpp"

#include <vector>

namespace sprekk::physics {

struct FluidFlux {
  transport::HybridFluxParameters flux;
  std::vector<laws::Conduit> conduits;  ///< [local fracture face]
  transport::WellsParameters wells;
};

/// Flow data of a scene with Flow and a fluid of constant properties. Throws an Error on every rank if the scheme is
/// not rt0. Collective.
FluidFlux fluid_flux(const Setting& setting);

}  // namespace sprekk::physics
