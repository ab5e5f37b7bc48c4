// How far a time step is off because it is as long as it is.
#pragma once

#include "base/types.hpp"

#include <string>
#include <vector>

namespace sprekk::fields {

/// A relative error, of order `order` in the length of steps.
struct StepError {
  static constexpr Real unknown = 0;  ///< an order: not known of this step
  std::string name;
  Real value = 0, order = 1;
};

using StepErrors = std::vector<StepError>;

}  // namespace sprekk::fields
