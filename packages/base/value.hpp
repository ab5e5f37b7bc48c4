// Entries of a parameter list as text, as they stand in the attributes of an XML file.
#pragma once

#include <Teuchos_ParameterList.hpp>
#include <ostream>
#include <string>
#include <vector>

namespace sprekk::base {

/// What stands in a list in place of something that could not be read.
struct Unreadable {
  std::string message;
};
inline bool operator==(const Unreadable& a, const Unreadable& b) { return a.message == b.message; }
inline std::ostream& operator<<(std::ostream& out, const Unreadable& entry) { return out << entry.message; }

/// The messages of all Unreadable entries of a list and its sublists.
std::vector<std::string> unreadable(const Teuchos::ParameterList& list);

/// Sets list[name] to the value that `text` is in `type`, one of int, long long, double, bool, string, Array(int),
/// Array(double), Array(string). A double with a unit becomes a Quantity, an array of doubles an Array<Quantity> if one
/// of them has a unit. Throws an Error "is "1.0abc", not a number ..." without a place.
void set_from_text(Teuchos::ParameterList& list, const std::string& name, const std::string& type,
                   const std::string& text);

/// The type under which set_from_text knows an entry; empty for a section and for any other type.
std::string type_of(const Teuchos::ParameterEntry& entry);

/// The text that set_from_text turns back into exactly the same entry, whose type_of is not empty.
std::string value_text(const Teuchos::ParameterEntry& entry);

/// For messages: `the string "soon"`, `the number 0.5`, `the array {1, 2}`, `a section`.
std::string describe(const Teuchos::ParameterEntry& entry);

}  // namespace sprekk::base
