#include "base/codec.hpp"

#include <Teuchos_Array.hpp>
#include <cmath>
#include <limits>
#include <type_traits>

#include "base/check.hpp"
#include "base/text.hpp"
#include "base/units.hpp"
#include "base/value.hpp"

namespace sprekk::base {

using Teuchos::Array;
using Teuchos::ParameterEntry;
using Teuchos::ParameterList;

namespace {

/// Calls use(value) and returns true if the entry is of type T.
template <class T, class Use>
bool if_type(const ParameterEntry& entry, const Use& use) {
  if (!entry.isType<T>()) return false;
  use(Teuchos::getValue<T>(entry));
  return true;
}

void wrong_type(const ParameterEntry& entry, Reading& reading, const std::string& expected) {
  reading.fail("", fmt::format("is {}, expected {}", describe(entry), expected));
}

bool inside(Reading& reading, const std::string& suffix, Real value) {
  constexpr Real smallest = std::numeric_limits<Real>::min();
  const bool is_lost = value != 0 && std::abs(value) < smallest;  // denormal: fewer digits, and 1/value may be infinite
  if (is_lost)
    reading.fail(suffix, fmt::format("is {}, too small for a double; give 0, or at least {:.3g}", value, smallest));
  if (is_lost || reading.bounds.contains(value)) return !is_lost;
  const bool has_unit = reading.unit != "-" && reading.unit.find(',') == std::string::npos;
  reading.fail(suffix, fmt::format("is {}, must be {}{}", number_text(value), reading.bounds.text(),
                                   has_unit ? fmt::format(" (unit: {})", reading.unit) : ""));
  return false;
}

bool length_fits(Reading& reading, std::size_t n) {
  if (!reading.bounds.size() || *reading.bounds.size() == n) return true;
  reading.fail("", fmt::format("has {}, must have {}", counted(n, "element"), reading.bounds.length_text()));
  return false;
}

std::string index(std::size_t i) { return fmt::format("[{}]", i); }

/// Calls use() with the quantity converted to `unit`. If the conversion fails, reports an error.
template <class Use>
void convert(Reading& reading, const std::string& suffix, const std::string& unit, const Quantity& value,
             const Use& use) {
  std::optional<Real> number;
  try {
    number = value_in(unit, value);
  } catch (const Error& error) {
    return reading.fail(suffix, fmt::format("is \"{}\", {}", shortened(quantity_text(value)), error.what()));
  }
  use(*number);
}

/// Unit of one element. The units of elements are separated by ", ".
std::string unit_of_element(const std::string& units, std::size_t i) {
  std::size_t begin = 0;
  for (std::size_t end; i > 0 && (end = units.find(", ", begin)) != units.npos; --i) begin = end + 2;
  return units.substr(begin, units.find(", ", begin) - begin);
}

template <class From, class T>
bool decode_array(const ParameterEntry& entry, Reading& reading, std::vector<T>& target) {
  return if_type<Array<From>>(entry, [&](const Array<From>& values) {
    const auto n_errors = reading.errors.size();
    length_fits(reading, values.size());
    std::vector<T> numbers;
    const auto add = [&](T number) {
      if (inside(reading, index(numbers.size()), static_cast<Real>(number))) numbers.push_back(number);
    };
    for (int i = 0; i < values.size(); ++i)
      if constexpr (std::is_same_v<From, Quantity>)
        convert(reading, index(i), reading.unit, values[i], add);
      else
        add(values[i]);
    if (reading.errors.size() == n_errors) target = std::move(numbers);
  });
}

template <class T>
bool decode_integer(const ParameterEntry& entry, Reading& reading, T& target) {
  const auto use = [&](long long value) {
    if (value != static_cast<T>(value))
      reading.fail("", fmt::format("is {}, too large for an int", value));
    else if (inside(reading, "", static_cast<Real>(value)))
      target = static_cast<T>(value);
  };
  return if_type<int>(entry, use) || if_type<long long>(entry, use);
}

/// Creates an expression from a number, a quantity or a text.
void decode_expression(Reading& reading, const std::string& suffix, const std::string&, Real value,
                       Expression& target) {
  if (inside(reading, suffix, value)) target = Expression(value);
}
void decode_expression(Reading& reading, const std::string& suffix, const std::string& unit, const Quantity& value,
                       Expression& target) {
  convert(reading, suffix, unit, value, [&](Real v) { decode_expression(reading, suffix, unit, v, target); });
}
void decode_expression(Reading& reading, const std::string& suffix, const std::string& unit, const std::string& text,
                       Expression& target) {
  if (const auto number = parse_number(text)) return decode_expression(reading, suffix, unit, *number, target);
  if (const auto quantity = parse_quantity(text)) {  // no expression begins like a quantity
    const std::string defect = defect_of_unit(quantity->unit);
    if (defect.empty()) return decode_expression(reading, suffix, unit, *quantity, target);
    const bool calculates = quantity->unit.find_first_of("*+-(") != std::string::npos;
    return reading.fail(
        suffix, calculates
                    ? fmt::format("is \"{}\": {}; {}", shortened(text), shortened(defect), no_units_in_expressions)
                    : fmt::format("is \"{}\", neither an expression nor a number with a unit: {}{}", shortened(text),
                                  shortened(defect), units_like(unit)));
  }
  if (const auto hint = hint_on_digits(text); !hint.empty())
    return reading.fail(suffix, fmt::format("is \"{}\", neither a number nor an expression{}", shortened(text), hint));
  try {
    Expression expression(text, reading.place + suffix);
    if (reading.tables && reading.bounds.word() != text) expression.compile(reading.tables, reading.named);
    if (expression.is_constant() && !inside(reading, suffix, expression({}, 0))) return;
    target = expression;
  } catch (const Error& error) {
    reading.errors.push_back(error.what());
  }
}

template <class From>
bool decode_expressions(const ParameterEntry& entry, Reading& reading, std::vector<Expression>& target) {
  return if_type<Array<From>>(entry, [&](const Array<From>& values) {
    const auto n_errors = reading.errors.size();
    length_fits(reading, values.size());
    std::vector<Expression> expressions(values.size());
    for (int i = 0; i < values.size(); ++i)
      decode_expression(reading, index(i), unit_of_element(reading.unit, i), values[i], expressions[i]);
    if (reading.errors.size() == n_errors) target = std::move(expressions);
  });
}

}  // namespace

void decode(const ParameterEntry& entry, Reading reading, double& target) {
  const auto use = [&](Real value) {
    if (inside(reading, "", value)) target = value;
  };
  const auto use_quantity = [&](const Quantity& quantity) { convert(reading, "", reading.unit, quantity, use); };
  if (if_type<double>(entry, use) || if_type<int>(entry, use) || if_type<long long>(entry, use)) return;
  if (if_type<Quantity>(entry, use_quantity)) return;
  std::string hint;
  if (entry.isType<std::string>()) {
    const auto& text = Teuchos::getValue<std::string>(entry);
    if (text == "infinite") return use(*parse_number(text));
    const auto quantity = parse_quantity(text);
    const auto defect = quantity ? defect_of_unit(quantity->unit) : "";
    if (quantity && defect.empty()) return use_quantity(*quantity);
    if (quantity)
      return reading.fail("", fmt::format("is \"{}\", no number with a unit: {}{}", shortened(text), shortened(defect),
                                          units_like(reading.unit)));
    hint = hint_on_digits(text);
  }
  wrong_type(entry, reading, "a number, e.g. type=\"double\"" + hint);
}

void decode(const ParameterEntry& entry, Reading reading, int& target) {
  if (!decode_integer(entry, reading, target)) wrong_type(entry, reading, "an integer, e.g. type=\"int\"");
}

void decode(const ParameterEntry& entry, Reading reading, long long& target) {
  if (!decode_integer(entry, reading, target)) wrong_type(entry, reading, "an integer, e.g. type=\"long long\"");
}

void decode(const ParameterEntry& entry, Reading reading, bool& target) {
  if (!if_type<bool>(entry, [&](bool value) { target = value; }))
    wrong_type(entry, reading, "true or false with type=\"bool\"");
}

void decode(const ParameterEntry& entry, Reading reading, std::string& target) {
  if (!if_type<std::string>(entry, [&](const std::string& value) { target = value; }))
    wrong_type(entry, reading, "a text with type=\"string\"");
}

void decode(const ParameterEntry& entry, Reading reading, std::vector<double>& target) {
  const bool done = decode_array<double>(entry, reading, target) || decode_array<int>(entry, reading, target) ||
                    decode_array<Quantity>(entry, reading, target);
  if (!done) wrong_type(entry, reading, "numbers, e.g. type=\"Array(double)\" value=\"{1, 2}\"");
}

void decode(const ParameterEntry& entry, Reading reading, std::vector<int>& target) {
  if (!decode_array<int>(entry, reading, target))
    wrong_type(entry, reading, "integers, e.g. type=\"Array(int)\" value=\"{1, 2}\"");
}

void decode(const ParameterEntry& entry, Reading reading, std::vector<std::string>& target) {
  const auto use = [&](const Array<std::string>& values) {
    if (length_fits(reading, values.size())) target.assign(values.begin(), values.end());
  };
  if (!if_type<Array<std::string>>(entry, use))
    wrong_type(entry, reading, "texts, e.g. type=\"Array(string)\" value=\"{a, b}\"");
}

void decode(const ParameterEntry& entry, Reading reading, Expression& target) {
  const auto use = [&](const auto& value) { decode_expression(reading, "", reading.unit, value, target); };
  const bool done = if_type<double>(entry, use) || if_type<int>(entry, use) || if_type<Quantity>(entry, use) ||
                    if_type<std::string>(entry, use);
  if (!done) wrong_type(entry, reading, "a number or an expression, e.g. type=\"string\" value=\"-0.1*t\"");
}

void decode(const ParameterEntry& entry, Reading reading, std::vector<Expression>& target) {
  const bool done =
      decode_expressions<double>(entry, reading, target) || decode_expressions<int>(entry, reading, target) ||
      decode_expressions<Quantity>(entry, reading, target) || decode_expressions<std::string>(entry, reading, target);
  if (!done) wrong_type(entry, reading, "numbers or expressions, e.g. type=\"Array(string)\" value=\"{0, -0.1*t}\"");
}

void encode(ParameterList& list, const std::string& name, double value) { list.set(name, value); }
void encode(ParameterList& list, const std::string& name, int value) { list.set(name, value); }
void encode(ParameterList& list, const std::string& name, long long value) { list.set(name, value); }
void encode(ParameterList& list, const std::string& name, bool value) { list.set(name, value); }
void encode(ParameterList& list, const std::string& name, const std::string& value) { list.set(name, value); }
void encode(ParameterList& list, const std::string& name, const std::vector<double>& value) {
  list.set(name, Array<double>(value));
}
void encode(ParameterList& list, const std::string& name, const std::vector<int>& value) {
  list.set(name, Array<int>(value));
}
void encode(ParameterList& list, const std::string& name, const std::vector<std::string>& value) {
  list.set(name, Array<std::string>(value));
}

void encode(ParameterList& list, const std::string& name, const Expression& value) {
  if (const auto number = parse_number(value.text()))
    list.set(name, *number);
  else
    list.set(name, value.text());
}

void encode(ParameterList& list, const std::string& name, const std::vector<Expression>& value) {
  Array<std::string> texts;
  for (const auto& expression : value) texts.push_back(expression.text());
  list.set(name, texts);
}

}  // namespace sprekk::base
