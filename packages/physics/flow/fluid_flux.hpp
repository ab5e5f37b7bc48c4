// What estimates of errors need to know of the fluid's flow.
#pragma once

#include "laws/conduit.hpp"
#include "physics/flow/wells.hpp"
#include "physics/hybrid_flux.hpp"

#include <vector>

namespace sprekk::physics {

struct FluidFlux {
  HybridFluxParameters flux;
  std::vector<laws::Conduit> conduits;  ///< [local fracture face]
  WellsParameters wells;
};

/// Of a scene with Flow whose fluid nothing changes. Error, on every rank: another scheme than rt0. Collective.
FluidFlux fluid_flux(const Setting& setting);

}  // namespace sprekk::physics
