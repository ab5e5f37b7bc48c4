// Conversion of entries of a parameter list to and from text, as in XML attributes.
#pragma once

#include <Teuchos_ParameterList.hpp>
#include <ostream>
#include <string>
#include <vector>

namespace sprekk::base {

/// Replaces an entry that could not be read.
struct Unreadable {
  std::string message;
};
inline bool operator==(const Unreadable& a, const Unreadable& b) { return a.message == b.message; }
inline std::ostream& operator<<(std::ostream& out, const Unreadable& entry) { return out << entry.message; }

/// Returns the messages of all Unreadable entries of a list and its sublists.
std::vector<std::string> unreadable(const Teuchos::ParameterList& list);

/// Sets list[name] to `text` converted to `type`: int, long long, double, bool, string, Array(int), Array(double) or
/// Array(string). A double with a unit becomes a Quantity. An array of doubles becomes an `Array<Quantity>` if an
/// element has a unit. Throws an Error such as "is "1.0abc", not a number ...", without a place.
void set_from_text(Teuchos::ParameterList& list, const std::string& name, const std::string& type,
                   const std::string& text);

/// Returns the type of an entry for set_from_text(); empty for a section and for any other type.
std::string type_of(const Teuchos::ParameterEntry& entry);

/// Returns the text from which set_from_text() reproduces exactly the same entry. type_of(entry) must not be empty.
std::string value_text(const Teuchos::ParameterEntry& entry);

/// Describes an entry for messages: `the string "soon"`, `the number 0.5`, `the array {1, 2}`, `a section`.
std::string describe(const Teuchos::ParameterEntry& entry);

}  // namespace sprekk::base
