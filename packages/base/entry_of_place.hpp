// Scene entries that depend on the position.
#pragma once

#include "base/check.hpp"
#include "base/expression.hpp"
#include "base/parameters.hpp"
#include "base/text.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace sprekk::base {

inline bool is_zero(const Expression& value) { return value.is_constant() && value({}, 0) == 0; }

inline void check_constant_in_time(Section& s, const std::string& entry, const Expression& value) {
  if (!value.constant_in_time())
    s.fail(entry, fmt::format("is \"{}\"; it may depend on the position, not on t", value.text()));
}
inline void check_constant_in_time(Section& s, const std::string& entry, const std::optional<Expression>& value) {
  if (value) check_constant_in_time(s, entry, *value);
}
inline void check_constant_in_time(Section& s, const std::string& entry, const std::vector<Expression>& values) {
  for (const auto& value : values) check_constant_in_time(s, entry, value);
}

/// Declares an entry that may depend on x, y, z, but not on t. T: Expression, optional Expression, or a vector of them.
template <class T>
void entry_of_place(Section& s, T& target, const std::string& name, const std::string& unit, const Bounds& bounds,
                    const std::string& meaning) {
  s.entry(target, name, unit, bounds, meaning);
  check_constant_in_time(s, name, target);
}

/// Value of an entry at x. Throws an Error if the value is out of bounds. Constants were checked when they were read.
inline Real value_at(const std::string& name, const Expression& value, const Bounds& bounds,
                     const std::array<Real, 3>& x) {
  const Real v = value(x, 0);
  SPREKK_CHECK(value.is_constant() || bounds.contains(v),
               "\"{}\" = {} is {:.6g} at ({:.6g}, {:.6g}, {:.6g}), must be {}", name, shortened(value.text()), v, x[0],
               x[1], x[2], bounds.text());
  return v;
}
/// The same for an entry of a section. Errors contain its location, "SCENE: Sprekk > SECTION".
inline Real value_at(const std::string& location, const std::string& name, const Expression& value,
                     const Bounds& bounds, const std::array<Real, 3>& x) {
  try {
    return value_at(name, value, bounds, x);
  } catch (const Error& error) {
    throw Error(location + ": " + error.what());
  }
}

}  // namespace sprekk::base
