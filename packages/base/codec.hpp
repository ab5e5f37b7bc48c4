// Conversion between entries of a parameter list and C++ types.
#pragma once

#include <Teuchos_ParameterList.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/bounds.hpp"
#include "base/expression.hpp"

namespace sprekk::base {

/// Context of the conversion of an entry: its place, unit, bounds, and the list of errors.
struct Reading {
  std::string place;  ///< `scene.xml: Sprekk > Time > "end"`
  std::string unit;   ///< of stored numbers, "-" for none; "m, Pa": one for each element
  const Bounds& bounds;
  std::shared_ptr<const Tables> tables;  ///< callable from expressions; null: do not compile
  const Expression::Named& named;        ///< callable expressions
  std::vector<std::string>& errors;

  void fail(const std::string& suffix, const std::string& what) { errors.push_back(place + suffix + ": " + what); }
};

/// Converts an entry to the type of `target` and checks the bounds. On an error, appends a message to reading.errors
/// and leaves `target` unchanged. A number may also be an integer, a quantity in any compatible unit, or "infinite" if
/// the bounds allow it (both as strings).
void decode(const Teuchos::ParameterEntry& entry, Reading reading, double& target);
void decode(const Teuchos::ParameterEntry& entry, Reading reading, int& target);
void decode(const Teuchos::ParameterEntry& entry, Reading reading, long long& target);
void decode(const Teuchos::ParameterEntry& entry, Reading reading, bool& target);
void decode(const Teuchos::ParameterEntry& entry, Reading reading, std::string& target);
void decode(const Teuchos::ParameterEntry& entry, Reading reading, std::vector<double>& target);
void decode(const Teuchos::ParameterEntry& entry, Reading reading, std::vector<int>& target);
void decode(const Teuchos::ParameterEntry& entry, Reading reading, std::vector<std::string>& target);
/// Converts a number, a quantity, or a string with an expression. Bounds are checked for constants only.
void decode(const Teuchos::ParameterEntry& entry, Reading reading, Expression& target);
void decode(const Teuchos::ParameterEntry& entry, Reading reading, std::vector<Expression>& target);

/// Sets list[name] such that decode() reproduces `value`.
void encode(Teuchos::ParameterList& list, const std::string& name, double value);
void encode(Teuchos::ParameterList& list, const std::string& name, int value);
void encode(Teuchos::ParameterList& list, const std::string& name, long long value);
void encode(Teuchos::ParameterList& list, const std::string& name, bool value);
void encode(Teuchos::ParameterList& list, const std::string& name, const std::string& value);
void encode(Teuchos::ParameterList& list, const std::string& name, const std::vector<double>& value);
void encode(Teuchos::ParameterList& list, const std::string& name, const std::vector<int>& value);
void encode(Teuchos::ParameterList& list, const std::string& name, const std::vector<std::string>& value);
void encode(Teuchos::ParameterList& list, const std::string& name, const Expression& value);
void encode(Teuchos::ParameterList& list, const std::string& name, const std::vector<Expression>& value);

/// Name of the type in the parameter reference.
inline std::string type_name(const double&) { return "double"; }
inline std::string type_name(const int&) { return "int"; }
inline std::string type_name(const long long&) { return "long long"; }
inline std::string type_name(const bool&) { return "bool"; }
inline std::string type_name(const std::string&) { return "string"; }
inline std::string type_name(const std::vector<double>&) { return "Array(double)"; }
inline std::string type_name(const std::vector<int>&) { return "Array(int)"; }
inline std::string type_name(const std::vector<std::string>&) { return "Array(string)"; }
inline std::string type_name(const Expression&) { return "double or expression (string)"; }
inline std::string type_name(const std::vector<Expression>&) { return "Array(double) or expressions (Array(string))"; }

/// Overloads for optional entries. An absent entry stays empty and is not written.
template <class T>
void decode(const Teuchos::ParameterEntry& entry, Reading reading, std::optional<T>& target) {
  T value{};
  const auto n_errors = reading.errors.size();
  decode(entry, reading, value);
  if (reading.errors.size() == n_errors) target = std::move(value);
}
template <class T>
void encode(Teuchos::ParameterList& list, const std::string& name, const std::optional<T>& value) {
  if (value) encode(list, name, *value);
}
template <class T>
std::string type_name(const std::optional<T>&) {
  return type_name(T{});
}

}  // namespace sprekk::base
