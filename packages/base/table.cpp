#include "base/table.hpp"

#include <algorithm>
#include <cmath>

#include "base/check.hpp"
#include "base/parameters.hpp"
#include "base/text.hpp"

namespace sprekk::base {

void Table::describe(Section& section) {
  section.required(arguments, "arguments", "-", any(), "arguments of the table, strictly increasing");
  section.required(values, "values", "-", any(), "values of the function at the arguments, with linear interpolation");
  const std::string problem = defect();
  if (section.complete() && !problem.empty()) section.fail(problem);
}

std::string Table::defect() const {
  if (arguments.size() != values.size())
    return fmt::format("has {} but {}", counted(arguments.size(), "argument"), counted(values.size(), "value"));
  if (arguments.size() < 2) return fmt::format("has {}, needs at least 2", counted(arguments.size(), "point"));
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (!std::isfinite(arguments[i]) || !std::isfinite(values[i]))
      return fmt::format("point {} is ({}, {}), must be finite", i, arguments[i], values[i]);
    if (i > 0 && !(arguments[i] > arguments[i - 1]))
      return fmt::format("arguments must increase strictly, but argument {} is {} after {}", i, arguments[i],
                         arguments[i - 1]);
  }
  return "";
}

Real Table::operator()(Real argument) const {
  SPREKK_CHECK(argument >= arguments.front() && argument <= arguments.back(), "argument {} is outside of [{}, {}]",
               argument, arguments.front(), arguments.back());
  const auto above = std::upper_bound(arguments.begin() + 1, arguments.end() - 1, argument);
  const auto i = above - arguments.begin();
  const Real fraction = (argument - arguments[i - 1]) / (arguments[i] - arguments[i - 1]);
  return (1 - fraction) * values[i - 1] + fraction * values[i];
}

}  // namespace sprekk::base
