// Names of the fields that contribute to the displacement.
#pragma once

#include "assembly/divergence.hpp"

namespace sprekk::physics {

inline constexpr assembly::VectorFields displacements{"displacement", "side bubble", "tip displacement"};

}  // namespace sprekk::physics
