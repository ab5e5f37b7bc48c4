// How each type of parameter is read from an entry of a parameter list, and written to it.
#pragma once

#include <Teuchos_ParameterList.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/bounds.hpp"
#include "base/expression.hpp"

namespace sprekk::base {

/// Where a value comes from, what it may be, and what is wrong with it.
struct Reading {
  std::string place;  ///< `scene.xml: Sprekk > Time > "end"`
  std::string
      unit;  ///< that numbers are kept in, "-" for none; "m, Pa" if the elements of an array have different ones
  const Bounds& bounds;
  std::shared_ptr<const Tables> tables;  ///< that expressions may call; null: they are not compiled
  const Expression::Named& named;        ///< the same
  std::vector<std::string>& errors;

  void fail(const std::string& suffix, const std::string& what) { errors.push_back(place + suffix + ": " + what); }
};

/// Converts an entry to the type of `target` and checks the bounds; on an error, which goes to reading.errors, `target`
/// stays what it was. A number may be written as an integer, as a quantity of any unit that measures the same, and,
/// both in a string, as "infinite" where the bounds allow it.
void decode(const Teuchos::ParameterEntry& entry, Reading reading, double& target);
void decode(const Teuchos::ParameterEntry& entry, Reading reading, int& target);
void decode(const Teuchos::ParameterEntry& entry, Reading reading, long long& target);
void decode(const Teuchos::ParameterEntry& entry, Reading reading, bool& target);
void decode(const Teuchos::ParameterEntry& entry, Reading reading, std::string& target);
void decode(const Teuchos::ParameterEntry& entry, Reading reading, std::vector<double>& target);
void decode(const Teuchos::ParameterEntry& entry, Reading reading, std::vector<int>& target);
void decode(const Teuchos::ParameterEntry& entry, Reading reading, std::vector<std::string>& target);
/// A number, a quantity, or a string with an expression; bounds are checked of constants only.
void decode(const Teuchos::ParameterEntry& entry, Reading reading, Expression& target);
void decode(const Teuchos::ParameterEntry& entry, Reading reading, std::vector<Expression>& target);

/// Sets list[name] such that decode turns it back into `value`.
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

/// The name of the type in the reference.
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

/// An optional entry that is absent stays empty, and is not written.
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
