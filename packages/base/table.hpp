// Piecewise linear functions of one argument.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/types.hpp"

namespace sprekk::base {

class Section;

/// Linear interpolation of the points (arguments[i], values[i]); undefined outside.
struct Table {
  std::vector<Real> arguments, values;

  void describe(Section& section);

  /// Returns an error message, or "". Errors: fewer than two points, different lengths, values that are not finite,
  /// arguments that do not increase strictly.
  std::string defect() const;

  /// Value at `argument`. Throws an Error with the argument and the range if it is outside.
  Real operator()(Real argument) const;
};

/// Tables by their names in expressions.
using Tables = std::map<std::string, Table>;

}  // namespace sprekk::base
