// Numbers with units.
#pragma once

#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>

#include "base/types.hpp"

namespace sprekk::base {

/// A number as it is written, with the unit that follows it: "30 GPa". No unit: the number is in the unit that the
/// entry is kept in.
struct Quantity {
  Real value = 0;
  std::string unit;
};
inline bool operator==(const Quantity& a, const Quantity& b) { return a.value == b.value && a.unit == b.unit; }
std::ostream& operator<<(std::ostream& out, const Quantity& quantity);  ///< as quantity_text

/// The number and the unit that `text` consists of, or nothing if it is no number followed by a letter; whether that
/// opens a unit, defect_of_unit tells.
std::optional<Quantity> parse_quantity(std::string_view text);

/// The text that parse_quantity turns back into exactly `quantity`.
std::string quantity_text(const Quantity& quantity);

/// What is wrong with the text of a unit, e.g. `unknown unit "GPaa". Did you mean "GPa"?`; empty if nothing is.
///
/// A unit is a product or quotient of powers, "kg/m^3", "kg/m3", "kg/(m*s^2)", of the symbols m, g, s, N, Pa, bar, psi,
/// J, W, rad, l (litre), D (darcy), P (poise) with or without a prefix n, u, m, c, k, M, G, and ft, in, micron, t, ksi,
/// min, h, hour, day, week, year (365.25 days), degree, deg. Degrees Celsius stand alone.
std::string defect_of_unit(const std::string& unit);

/// "; allowed are ..." with units that measure what `unit` does; empty for a pure number.
std::string units_like(const std::string& unit);

/// For messages about them.
constexpr const char* no_units_in_expressions =
    "a unit can only follow a number, not be within an expression: write the expression in SI units";

/// The number that `quantity` is in `unit`, "-" for none: 30 GPa is 3e10 in Pa, exactly the number that 30e9 is. Throws
/// an Error with the allowed units if it measures something else; angles are no pure numbers. Degrees
/// Celsius become K for entries in K: all of these are levels.
Real value_in(const std::string& unit, const Quantity& quantity);

}  // namespace sprekk::base
