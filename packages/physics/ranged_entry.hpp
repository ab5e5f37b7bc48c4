// Entries that are expressions of the place.
#pragma once

#include "base/check.hpp"
#include "base/expression.hpp"
#include "base/parameters.hpp"
#include "base/text.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

namespace sprekk::physics {

/// An entry that may be an expression of x, y, z, and where its values must lie.
struct RangedEntry {
  const char* name;
  const base::Expression* value;  ///< null: not given
  Real least;
  bool itself = true;  ///< `least` is allowed
  Real limit = std::numeric_limits<Real>::infinity();

  RangedEntry(const char* name, const base::Expression& value, Real least, bool itself = true,
              Real limit = std::numeric_limits<Real>::infinity())
      : name(name), value(&value), least(least), itself(itself), limit(limit) {}
  RangedEntry(const char* name, const std::optional<base::Expression>& value, Real least, bool itself = true,
              Real limit = std::numeric_limits<Real>::infinity())
      : name(name), value(value ? &*value : nullptr), least(least), itself(itself), limit(limit) {}

  bool is_uniform() const { return !value || value->is_constant(); }

  /// Constant ones were checked when they were read.
  void check(const std::array<Real, 3>& x) const {
    if (is_uniform()) return;
    const Real v = (*value)(x, 0);
    SPREKK_CHECK((itself ? v >= least : v > least) && v < limit, "\"{}\" = {} is {} at ({}, {}, {}), must be {} {}{}",
                 name, base::shortened(value->text()), v, x[0], x[1], x[2], itself ? "at least" : "above", least,
                 std::isfinite(limit) ? fmt::format(" and below {}", limit) : "");
  }
};

inline bool is_zero(const base::Expression& value) { return value.is_constant() && value({}, 0) == 0; }

inline void check_constant_in_time(base::Section& s, const std::string& entry, const base::Expression& value) {
  if (!value.constant_in_time())
    s.fail(entry, fmt::format("is \"{}\"; it may depend on x, y, z, not on t", value.text()));
}

template <class Entries>
void check_constant_in_time(base::Section& s, const Entries& entries) {
  for (const RangedEntry& entry : entries)
    if (entry.value) check_constant_in_time(s, entry.name, *entry.value);
}

}  // namespace sprekk::physics
