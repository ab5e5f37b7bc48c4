// Gradual release of unbalanced forces after a change of the scene.
#pragma once

#include "assembly/module.hpp"

#include <memory>

namespace sprekk::physics {

/// Creates a module that adds -(1 - s(t)) r to the rows of momentum. r is their residual at the time `begin`, when a
/// changed system takes over a state. s grows from 0 at `begin` to 1 at `end`. After an excavation, r is the traction
/// of the removed rock on the new walls. History: r of each field, "of FIELD", N.
std::unique_ptr<assembly::Module> make_release(Real begin, Real end);

}  // namespace sprekk::physics
