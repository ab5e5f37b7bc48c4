// Scene files: XML parameter lists with strict checks.
#pragma once

#include <Teuchos_ParameterList.hpp>
#include <string>
#include <vector>

#include "base/types.hpp"

namespace sprekk::base {

/// Treatment of duplicate names, unknown elements, attributes and types, and values of a wrong type. `refuse` throws
/// one Error with a line for each. `keep` puts an Unreadable in their place, which base::read reports.
enum class Defects { refuse, keep };

/// Reads the parameter list in the file at `path`. The outermost list must have the name `root`. Rank 0 reads the file.
/// Throws an Error with the file and the line or path in it if the file is unreadable, larger than 64 MiB, not UTF-8,
/// or not well-formed XML. Collective.
Teuchos::ParameterList read_xml(const Comm& comm, const std::string& path, const std::string& root,
                                Defects defects = Defects::refuse);

/// Reads the parameter list in a text; `file` is its name in messages. Throws as read_xml(). Not collective.
Teuchos::ParameterList parse_xml(const std::string& text, const std::string& file, const std::string& root,
                                 Defects defects = Defects::refuse);

/// Returns the text from which parse_xml() reproduces exactly the same list. Throws an Error if XML cannot represent
/// the type of an entry.
std::string to_xml(const Teuchos::ParameterList& list);

/// Applies "Section.Inner section.entry name=value" to `list` and adds missing sections. The value has the type of the
/// entry that it replaces, if possible. Otherwise it has the first possible type of int, double, bool, {a, b} of int,
/// double or string, and string. An existing text with a unit counts as a number. Throws an Error if the text has no
/// "=", or if its path ends at a section or passes through an entry.
void apply_override(Teuchos::ParameterList& list, const std::string& text);

/// Applies all valid overrides in their order. Returns the messages of the others, which begin with `file`, the name of
/// the list's file.
std::vector<std::string> apply_overrides(Teuchos::ParameterList& list, const std::string& file,
                                         const std::vector<std::string>& texts);

}  // namespace sprekk::base
