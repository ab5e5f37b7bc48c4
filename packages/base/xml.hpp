// Scene files: XML parameter lists, read strictly.
#pragma once

#include <Teuchos_ParameterList.hpp>
#include <string>
#include <vector>

#include "base/types.hpp"

namespace sprekk::base {

/// What becomes of duplicate names, unknown elements, attributes and types, and values that are not of their type: an
/// Error with a line for each of them, or an Unreadable in their places, of which base::read tells.
enum class Defects { refuse, keep };

/// The parameter list in the file at `path`, whose outermost list must be called `root`. Rank 0 reads. Throws an Error
/// with the file and the line or the path in it if it cannot be read, is larger than 64 MiB, not UTF-8, or not
/// well-formed XML. Collective.
Teuchos::ParameterList read_xml(const Comm& comm, const std::string& path, const std::string& root,
                                Defects defects = Defects::refuse);

/// The same from text; `file` names it in messages. Not collective.
Teuchos::ParameterList parse_xml(const std::string& text, const std::string& file, const std::string& root,
                                 Defects defects = Defects::refuse);

/// Text that parse_xml turns back into exactly the same list. Throws an Error if an entry has a type that XML cannot
/// carry.
std::string to_xml(const Teuchos::ParameterList& list);

/// Applies "Section.Inner section.entry name=value" to `list`; sections that are not there are added. The value keeps
/// the type of the entry that it replaces if it can be read as such, a text with a unit standing for a number, else it
/// is the first it can be of int, double, bool, {a, b} of int, double or string, and string. Throws an Error if the
/// text has no "=", or its path ends at a section or leads through an entry.
void apply_override(Teuchos::ParameterList& list, const std::string& text);

/// Applies all that can be applied to a list, in their order; of the others what apply_override throws, after `file`,
/// which the list was read from.
std::vector<std::string> apply_overrides(Teuchos::ParameterList& list, const std::string& file,
                                         const std::vector<std::string>& texts);

}  // namespace sprekk::base
