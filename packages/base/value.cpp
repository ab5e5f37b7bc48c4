#include "base/value.hpp"

#include <Teuchos_Array.hpp>
#include <type_traits>

#include "base/check.hpp"
#include "base/text.hpp"
#include "base/units.hpp"

namespace sprekk::base {

namespace {

using Teuchos::Array;

/// Calls use(T(), "name of T") for every type that XML can represent.
template <class Use>
void for_each_type(const Use& use) {
  use(int(), "int");
  use((long long)(0), "long long");
  use(double(), "double");
  use(Quantity(), "double");
  use(bool(), "bool");
  use(std::string(), "string");
  use(Array<int>(), "Array(int)");
  use(Array<double>(), "Array(double)");
  use(Array<Quantity>(), "Array(double)");
  use(Array<std::string>(), "Array(string)");
}

void parse(const std::string& text, long long& value) {
  const auto number = parse_integer(text);
  SPREKK_CHECK(number, "is \"{}\", not an integer", shortened(text));
  value = *number;
}
void parse(const std::string& text, int& value) {
  long long wide = 0;
  parse(text, wide);
  value = static_cast<int>(wide);
  SPREKK_CHECK(value == wide, "is \"{}\", too large for an int; use type=\"long long\"", shortened(text));
}
void parse(const std::string& text, Quantity& value) {
  const auto number = parse_number(text);
  const auto quantity = number ? Quantity{*number, ""} : parse_quantity(text);
  SPREKK_CHECK(quantity, "is \"{}\", not a number in the range of a double{}", shortened(text), hint_on_digits(text));
  const std::string defect = number ? "" : defect_of_unit(quantity->unit);
  SPREKK_CHECK(defect.empty(), "is \"{}\", not a number: {}", shortened(text), shortened(defect));
  value = *quantity;
}
void parse(const std::string& text, bool& value) {
  const auto boolean = parse_boolean(text);
  SPREKK_CHECK(boolean, "is \"{}\", not true or false", shortened(text));
  value = *boolean;
}
void parse(const std::string& text, std::string& value) { value = text; }
template <class T>
void parse(const std::string& text, Array<T>& value) {
  const auto elements = parse_list(text);
  SPREKK_CHECK(elements, "is \"{}\", not a list like {{a, b, c}} with matching parentheses and quotes",
               shortened(text));
  for (const auto& element : *elements) {
    T one{};
    parse(element, one);
    value.push_back(one);
  }
}

std::string write(long long value) { return std::to_string(value); }
std::string write(int value) { return std::to_string(value); }
std::string write(double value) { return number_text(value); }
std::string write(const Quantity& value) { return quantity_text(value); }
std::string write(bool value) { return value ? "true" : "false"; }
std::string write(const std::string& value) { return value; }
/// Adds quotes if the element of a list requires them. A text with both kinds of quotes cannot be an element.
std::string element_text(const std::string& value) {
  const auto read_back = parse_list("{" + value + "}");
  if (read_back && read_back->size() == 1 && read_back->front() == value) return value;
  const char quote = value.find('"') == value.npos ? '"' : '\'';
  return quote + value + quote;
}
template <class T>
std::string write(const Array<T>& value) {
  std::string text;
  for (const auto& element : value) text += (text.empty() ? "" : ", ") + element_text(write(element));
  return "{" + text + "}";
}

template <class T>
void set(Teuchos::ParameterList& list, const std::string& name, const T& value) {
  list.set(name, value);
}
/// Sets a double, or an array of doubles, if there are no units.
void set(Teuchos::ParameterList& list, const std::string& name, const Quantity& value) {
  value.unit.empty() ? list.set(name, value.value) : list.set(name, value);
}
void set(Teuchos::ParameterList& list, const std::string& name, const Array<Quantity>& values) {
  Array<double> numbers;
  for (const auto& value : values)
    if (value.unit.empty()) numbers.push_back(value.value);
  numbers.size() == values.size() ? list.set(name, numbers) : list.set(name, values);
}

}  // namespace

void set_from_text(Teuchos::ParameterList& list, const std::string& name, const std::string& type,
                   const std::string& text) {
  bool known = false;
  std::vector<std::string> types;
  for_each_type([&](auto value, const char* candidate) {
    using T = decltype(value);
    if constexpr (!std::is_same_v<T, double> && !std::is_same_v<T, Array<double>>) {  // read as quantities
      types.push_back(candidate);
      if (type != candidate) return;
      parse(text, value);
      set(list, name, value);
      known = true;
    }
  });
  SPREKK_CHECK(known, "has the unknown type \"{}\"; types are {}{}", shortened(type), quoted_list(types),
               did_you_mean(type, types));
}

std::string type_of(const Teuchos::ParameterEntry& entry) {
  std::string type;
  for_each_type([&](const auto& value, const char* candidate) {
    if (entry.isType<std::decay_t<decltype(value)>>()) type = candidate;
  });
  return type;
}

std::string value_text(const Teuchos::ParameterEntry& entry) {
  std::string text;
  for_each_type([&](const auto& value, const char*) {
    using T = std::decay_t<decltype(value)>;
    if (entry.isType<T>()) text = write(Teuchos::getValue<T>(entry));
  });
  return text;
}

std::vector<std::string> unreadable(const Teuchos::ParameterList& list) {
  std::vector<std::string> messages;
  for (const auto& named_entry : list) {
    const auto& entry = named_entry.second;
    if (entry.isType<Unreadable>()) messages.push_back(Teuchos::getValue<Unreadable>(entry).message);
    if (!entry.isList()) continue;
    for (auto& message : unreadable(list.sublist(named_entry.first))) messages.push_back(std::move(message));
  }
  return messages;
}

std::string describe(const Teuchos::ParameterEntry& entry) {
  if (entry.isList()) return "a section";
  const std::string type = type_of(entry);
  if (type.empty()) return "of type " + entry.getAny(false).typeName();
  const std::string text = shortened(value_text(entry));
  if (type == "string") return fmt::format("the string \"{}\"", text);
  if (type == "bool") return "the boolean " + text;
  if (entry.isType<Quantity>()) return fmt::format("\"{}\"", text);
  if (type == "double") return "the number " + text;
  return (type[0] == 'A' ? "the array " : "the integer ") + text;
}

}  // namespace sprekk::base
