// Relative error of a time step due to its length.
#pragma once

#include "base/types.hpp"

#include <string>
#include <vector>

namespace sprekk::fields {

/// Relative error, of the order `order` in the step length.
struct StepError {
  static constexpr Real unknown = 0;  ///< value of `order` if it is unknown for this step
  std::string name;
  Real value = 0, order = 1;
};

using StepErrors = std::vector<StepError>;

}  // namespace sprekk::fields
