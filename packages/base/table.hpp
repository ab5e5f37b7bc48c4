// Piecewise linear functions of one argument.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/types.hpp"

namespace sprekk::base {

class Section;

/// Points (arguments[i], values[i]), joined by straight lines; not defined outside of them.
struct Table {
  std::vector<Real> arguments, values;

  void describe(Section& section);

  /// What is wrong with the points: fewer than two, lengths that differ, values that are not finite, arguments that do
  /// not increase strictly; empty if nothing is.
  std::string defect() const;

  /// The value at `argument`. Throws an Error with the argument and the range if it lies outside.
  Real operator()(Real argument) const;
};

/// Tables by the names under which expressions call them.
using Tables = std::map<std::string, Table>;

}  // namespace sprekk::base
