#include "base/units.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <ostream>
#include <vector>

#include "base/check.hpp"
#include "base/text.hpp"

namespace sprekk::base {

namespace {

/// Unit factor 10^ten m^a kg^b s^c rad^d K^e with the powers a, b, c, d, e.
struct Unit {
  std::array<Real, 5> powers;
  Real ten;
  Real factor;
};

struct Symbol {
  const char* name;
  bool takes_prefix;
  Unit unit;
};

constexpr Real degree = 3.14159265358979323846 / 180, day = 86400;
constexpr Unit length{{1, 0, 0, 0, 0}, 0, 1}, mass{{0, 1, 0, 0, 0}, 0, 1}, force{{1, 1, -2, 0, 0}, 0, 1};
constexpr Unit time_in(Real seconds) { return {{0, 0, 1, 0, 0}, 0, seconds}; }
constexpr Unit angle_in(Real radians) { return {{0, 0, 0, 1, 0}, 0, radians}; }
constexpr Unit pressure_in(Real ten) { return {{-1, 1, -2, 0, 0}, ten, 1}; }

constexpr Real foot = 0.3048, inch = foot / 12, darcy = 9.869232667160128e-13;  // 1 cP cm^2/s/atm
constexpr Real psi = 4.4482216152605 / (inch * inch);                           // pound-force per square inch
constexpr std::array<Symbol, 41> symbols{{{"m", true, length},
                                          {"micron", false, {length.powers, -6, 1}},
                                          {"microns", false, {length.powers, -6, 1}},
                                          {"g", true, {mass.powers, -3, 1}},
                                          {"t", false, {mass.powers, 3, 1}},
                                          {"s", true, time_in(1)},
                                          {"N", true, force},
                                          {"Pa", true, pressure_in(0)},
                                          {"bar", true, pressure_in(5)},
                                          {"J", true, {{2, 1, -2, 0, 0}, 0, 1}},
                                          {"D", true, {{2, 0, 0, 0, 0}, 0, darcy}},
                                          {"darcy", true, {{2, 0, 0, 0, 0}, 0, darcy}},
                                          {"md", false, {{2, 0, 0, 0, 0}, -3, darcy}},
                                          {"l", true, {{3, 0, 0, 0, 0}, -3, 1}},
                                          {"L", true, {{3, 0, 0, 0, 0}, -3, 1}},
                                          {"P", true, {{-1, 1, -1, 0, 0}, -1, 1}},
                                          {"ft", false, {{1, 0, 0, 0, 0}, 0, foot}},
                                          {"in", false, {{1, 0, 0, 0, 0}, 0, inch}},
                                          {"psi", true, {{-1, 1, -2, 0, 0}, 0, psi}},
                                          {"ksi", false, {{-1, 1, -2, 0, 0}, 3, psi}},
                                          {"W", true, {{2, 1, -3, 0, 0}, 0, 1}},
                                          {"K", false, {{0, 0, 0, 0, 1}, 0, 1}},
                                          {"rad", true, angle_in(1)},
                                          {"degree", false, angle_in(degree)},
                                          {"degrees", false, angle_in(degree)},
                                          {"deg", false, angle_in(degree)},
                                          {"\u00b0", false, angle_in(degree)},
                                          {"min", false, time_in(60)},
                                          {"h", false, time_in(3600)},
                                          {"hour", false, time_in(3600)},
                                          {"hours", false, time_in(3600)},
                                          {"hr", false, time_in(3600)},
                                          {"d", false, time_in(day)},
                                          {"day", false, time_in(day)},
                                          {"days", false, time_in(day)},
                                          {"week", false, time_in(7 * day)},
                                          {"weeks", false, time_in(7 * day)},
                                          {"yr", false, time_in(365.25 * day)},
                                          {"yrs", false, time_in(365.25 * day)},
                                          {"year", false, time_in(365.25 * day)},
                                          {"years", false, time_in(365.25 * day)}}};

struct Prefix {
  const char* name;
  int ten;
};
constexpr std::array<Prefix, 10> prefixes{{{"", 0},
                                           {"G", 9},
                                           {"M", 6},
                                           {"k", 3},
                                           {"c", -2},
                                           {"m", -3},
                                           {"u", -6},
                                           {"\u00b5", -6},
                                           {"\u03bc", -6},
                                           {"n", -9}}};

/// Units listed in messages instead of the first symbol of a unit.
constexpr std::array<std::array<const char*, 6>, 11> offered{{{"Pa", "kPa", "MPa", "GPa", "bar", "psi"},
                                                              {"m", "km", "cm", "mm", "um", "ft"},
                                                              {"s", "min", "h", "day", "year"},
                                                              {"min", "s", "h", "day", nullptr},
                                                              {"N", "kN", "MN", nullptr, nullptr},
                                                              {"kg", "g", nullptr, nullptr, nullptr},
                                                              {"J", "kJ", "MJ", nullptr, nullptr},
                                                              {"W", "kW", "MW", nullptr, nullptr},
                                                              {"mD", "D", nullptr, nullptr, nullptr},
                                                              {"K", "\u00b0C", nullptr, nullptr, nullptr},
                                                              {"degree", "rad", nullptr, nullptr, nullptr}}};

/// 0 degrees Celsius in K, and names of this scale, which is not a multiple of K.
constexpr Real zero_celsius = 273.15;
constexpr std::array<std::string_view, 3> celsius{"\u00b0C", "degC", "\u2103"};

bool is_celsius(std::string_view name) { return std::find(celsius.begin(), celsius.end(), name) != celsius.end(); }

/// Replaces superscripts and dots by ASCII: "kg/m\u00b3" -> "kg/m^3", "Pa\u00b7s" and "Pa.s" -> "Pa*s". The dot of the
/// power 0.5 remains.
std::string plain(std::string text) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 6> written{{{"\u207b\u00b9", "^-1"},
                                                                                  {"\u207b\u00b2", "^-2"},
                                                                                  {"\u207b\u00b3", "^-3"},
                                                                                  {"\u00b2", "^2"},
                                                                                  {"\u00b3", "^3"},
                                                                                  {"\u00b7", "*"}}};
  for (const auto& [from, to] : written)
    for (auto at = text.find(from); at != text.npos; at = text.find(from, at + to.size()))
      text.replace(at, from.size(), to);
  for (auto at = text.find('.'); at != text.npos; at = text.find('.', at + 1))
    if (text.compare(at + 1, 1, "5") != 0) text[at] = '*';
  return text;
}

bool opens_symbol(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || static_cast<unsigned char>(c) >= 128;
}

/// Calls use(name, unit) for every symbol with each admissible prefix.
template <class Use>
void for_each_symbol(const Use& use) {
  for (const auto& symbol : symbols)
    for (const auto& prefix : prefixes) {
      if (prefix.ten != 0 && !symbol.takes_prefix) continue;
      Unit unit = symbol.unit;
      unit.ten += prefix.ten;
      use(std::string(prefix.name) + symbol.name, unit);
    }
}

Unit unit_called(const std::string& name) {
  std::optional<Unit> found;
  for_each_symbol([&](const std::string& candidate, const Unit& unit) {
    if (candidate == name && !found) found = unit;
  });
  if (found) return *found;
  if (is_celsius(name)) throw Error(fmt::format("\"{}\" can only stand alone, for an entry in K; write K here", name));
  std::vector<std::string> usual;  // common units only, e.g. not "Gs"
  for (const auto& row : offered)
    for (const char* unit : row)
      if (unit) usual.emplace_back(unit);
  throw Error(fmt::format("unknown unit \"{}\"{}", name, did_you_mean(name, usual)));
}

/// Returns a b^power.
Unit product(Unit a, const Unit& b, Real power) {
  for (std::size_t i = 0; i < a.powers.size(); ++i) a.powers[i] += power * b.powers[i];
  a.ten += power * b.ten;
  a.factor *= std::pow(b.factor, power);
  return a;
}

/// Parses a whole text as a unit. Throws an Error if it is invalid.
class UnitParser {
 public:
  explicit UnitParser(const std::string& text) : text_(plain(text)), given_(text) {}

  Unit parse() {
    constexpr std::size_t longest = 40;  // limits the recursion into parentheses
    if (text_.size() > longest) fail();
    const Unit unit = factors();
    if (at_ != text_.size()) fail();
    return unit;
  }

 private:
  [[noreturn]] void fail() const { throw Error(fmt::format("\"{}\" is no unit like \"kg/m^3\"", given_)); }

  bool take(char c) {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
    if (at_ == text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }

  Unit factors() {
    const Unit first = base();
    Unit unit = product({{0, 0, 0, 0, 0}, 0, 1}, first, exponent());
    for (;;) {
      const int sign = take('*') ? 1 : take('/') ? -1 : 0;
      if (sign == 0) return unit;
      const Unit next = base();
      unit = product(unit, next, sign * exponent());
    }
  }

  Unit base() {
    if (take('(')) {
      const Unit inside = factors();
      if (!take(')')) fail();
      return inside;
    }
    const std::size_t begin = at_;
    while (at_ < text_.size() && opens_symbol(text_[at_])) ++at_;
    if (begin == at_) fail();
    return unit_called(text_.substr(begin, at_ - begin));
  }

  Real exponent() {
    const bool has_digit = at_ < text_.size() && text_[at_] >= '1' && text_[at_] <= '9';  // "m3"
    const bool is_power = !has_digit && take('^');
    if (!has_digit && !is_power) return 1;
    const int sign = is_power && take('-') ? -1 : 1;
    constexpr std::string_view half = "0.5";
    if (is_power && text_.compare(at_, half.size(), half) == 0) {
      at_ += half.size();
      return sign * 0.5;
    }
    if (at_ == text_.size() || text_[at_] < '1' || text_[at_] > '9') fail();
    return sign * (text_[at_++] - '0');
  }

  const std::string text_, given_;
  std::size_t at_ = 0;
};

/// Returns value 10^ten with a single rounding, like a number written with this exponent.
Real shifted(Real value, int ten) {
  std::string digits = number_text(value);
  if (const auto e = digits.find('e'); e != digits.npos) {
    ten += std::stoi(digits.substr(e + 1));
    digits.resize(e);
  }
  const auto result = parse_number(fmt::format("{}e{}", digits, ten));
  SPREKK_CHECK(result, "is {}e{}, outside of the range of a double", digits, ten);
  return *result;
}

std::vector<std::string> offers(const std::string& unit) {
  std::vector<std::string> names;
  for (const auto& row : offered) {
    const std::string first = row[0];
    const bool opens = unit.compare(0, first.size(), first) == 0;
    if (!opens || (unit.size() > first.size() && opens_symbol(unit[first.size()]))) continue;
    for (const char* name : row)
      if (name) names.push_back(name + unit.substr(first.size()));
  }
  return names;
}

}  // namespace

std::optional<Quantity> parse_quantity(std::string_view text) {
  text = trimmed(text);
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  Real value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
  const auto unit = trimmed(text.substr(end - text.data()));
  if (unit.empty() || !opens_symbol(unit[0])) return std::nullopt;
  return Quantity{value, std::string(unit)};
}

std::string quantity_text(const Quantity& quantity) {
  return number_text(quantity.value) + (quantity.unit.empty() ? "" : " " + quantity.unit);
}

std::ostream& operator<<(std::ostream& out, const Quantity& quantity) { return out << quantity_text(quantity); }

std::string units_like(const std::string& unit) {
  const auto names = offers(unit);
  return names.empty() ? "" : fmt::format("; allowed are {} and other units of the same quantity", quoted_list(names));
}

std::string defect_of_unit(const std::string& unit) {
  if (is_celsius(unit)) return "";
  try {
    UnitParser(unit).parse();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

namespace {

/// True if the unit contains t. A user may have meant the time.
bool has_tonne(const std::string& unit) {
  const auto is_letter = [&](std::size_t at) {
    return at < unit.size() && std::isalpha(static_cast<unsigned char>(unit[at]));
  };
  for (std::size_t at = 0; at < unit.size(); ++at)
    if (unit[at] == 't' && !is_letter(at + 1) && !(at > 0 && is_letter(at - 1))) return true;
  return false;
}

}  // namespace

Real value_in(const std::string& unit, const Quantity& quantity) {
  if (quantity.unit.empty()) return quantity.value;
  if (is_celsius(quantity.unit)) {
    SPREKK_CHECK(unit == "K", "has the unit \"{}\", which only entries in K have{}", quantity.unit, units_like(unit));
    return quantity.value + zero_celsius;
  }
  const Unit from = UnitParser(quantity.unit).parse();
  SPREKK_CHECK(unit != "-", "has the unit \"{}\", must be a number without a unit", quantity.unit);
  const Unit to = UnitParser(unit).parse();
  SPREKK_CHECK(from.powers == to.powers, "has the unit \"{}\"; allowed are {} and other units of the same quantity{}",
               quantity.unit, quoted_list(offers(unit)),
               has_tonne(quantity.unit) ? fmt::format("; t is the tonne here: {}", no_units_in_expressions) : "");
  const Real ten = from.ten - to.ten, whole = std::floor(ten);
  return shifted(quantity.value, static_cast<int>(whole)) * (std::pow(10, ten - whole) * from.factor / to.factor);
}

}  // namespace sprekk::base
