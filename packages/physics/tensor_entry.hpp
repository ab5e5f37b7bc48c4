// Entries that are a symmetric positive definite tensor.
#pragma once

#include "base/expression.hpp"
#include "laws/darcy.hpp"

#include <array>
#include <string>
#include <vector>

namespace sprekk::physics {

/// No component depends on the place.
bool is_uniform_tensor(const std::vector<base::Expression>& components);

/// From one value; XX, YY[, ZZ]; or XX, YY, XY in 2D, XX, YY, ZZ, XY, YZ, XZ in 3D. Throws an Error where it is not
/// positive definite.
laws::Mobility tensor_at(const std::string& name, const std::vector<base::Expression>& components, int dim,
                         const std::array<Real, 3>& x);

}  // namespace sprekk::physics
