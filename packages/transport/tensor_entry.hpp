// Scene entries for symmetric positive definite tensors.
#pragma once

#include "base/expression.hpp"
#include "laws/darcy.hpp"

#include <array>
#include <string>
#include <vector>

namespace sprekk::transport {

/// Returns whether all components are independent of the position.
bool is_uniform_tensor(const std::vector<base::Expression>& components);

/// Tensor at x from 1 value, from XX, YY[, ZZ], or from XX, YY, XY in 2D and XX, YY, ZZ, XY, YZ, XZ in 3D. Throws an
/// Error if it is not positive definite.
laws::Mobility tensor_at(const std::string& name, const std::vector<base::Expression>& components, int dim,
                         const std::array<Real, 3>& x);

}  // namespace sprekk::transport
