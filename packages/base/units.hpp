// Numbers with units.
#pragma once

#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>

#include "base/types.hpp"

namespace sprekk::base {

/// Number as written, with its unit: "30 GPa". Without a unit, the number is in the unit of the entry.
struct Quantity {
  Real value = 0;
  std::string unit;
};
inline bool operator==(const Quantity& a, const Quantity& b) { return a.value == b.value && a.unit == b.unit; }
std::ostream& operator<<(std::ostream& out, const Quantity& quantity);  ///< as quantity_text

/// Returns the number and unit of `text`, or nothing unless it is a number followed by a letter. defect_of_unit()
/// checks the unit.
std::optional<Quantity> parse_quantity(std::string_view text);

/// Returns the text from which parse_quantity() reproduces exactly `quantity`.
std::string quantity_text(const Quantity& quantity);

/// Returns an error message for the text of a unit, e.g. `unknown unit "GPaa". Did you mean "GPa"?`, or "".
///
/// A unit is a product or quotient of powers of symbols: "kg/m^3", "kg/m3", "kg/(m*s^2)". With or without a prefix n,
/// u, m, c, k, M, G: m, g, s, N, Pa, bar, psi, J, W, rad, l (litre), D (darcy), P (poise). Without a prefix: ft, in,
/// micron, t, ksi, min, h, hour, day, week, year (365.25 days), degree, deg. Degrees Celsius are not part of products.
std::string defect_of_unit(const std::string& unit);

/// Returns "; allowed are ..." with units of the same dimension as `unit`; empty for a pure number.
std::string units_like(const std::string& unit);

/// Text for error messages.
constexpr const char* no_units_in_expressions =
    "a unit can only follow a number, not be within an expression: write the expression in SI units";

/// Converts `quantity` to `unit` ("-" for none): 30 GPa is 3e10 Pa, exactly equal to 30e9. Throws an Error with the
/// allowed units if the dimensions differ; an angle is not a pure number. Degrees Celsius are converted to K with the
/// offset of the scale.
Real value_in(const std::string& unit, const Quantity& quantity);

}  // namespace sprekk::base
