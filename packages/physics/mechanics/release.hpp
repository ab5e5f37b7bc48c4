// Forces that are out of balance where a scene changes, let go little by little.
#pragma once

#include "assembly/module.hpp"

#include <memory>

namespace sprekk::physics {

/// Adds -(1 - s(t)) r to the rows of momentum, with r their residual at the time `begin`, where a changed system takes
/// over the state of another one, and s growing from 0 there to 1 at `end`: after an excavation r is the traction of
/// what was taken away on its walls. History: r of each field, "of FIELD", N.
std::unique_ptr<assembly::Module> make_release(Real begin, Real end);

}  // namespace sprekk::physics
