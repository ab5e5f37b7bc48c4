// Scene files: XML parameter lists, read strictly.
#pragma once

#include <Teuchos_ParameterList.hpp>
#include <string>

#include "base/types.hpp"

namespace sprekk::base {

/// The parameter list in the file at `path`, whose outermost list must be called `root`. Rank 0 reads. Throws an Error
/// with the file and the line or the path in it if it cannot be read, is not well-formed XML, or has duplicate names,
/// elements or attributes or types that are unknown, or values that are not of their type. Collective.
Teuchos::ParameterList read_xml(const Comm& comm, const std::string& path, const std::string& root);

/// The same from text; `file` names it in messages. Not collective.
Teuchos::ParameterList parse_xml(const std::string& text, const std::string& file, const std::string& root);

/// Text that parse_xml turns back into exactly the same list. Throws an Error if an entry has a type that XML cannot
/// carry.
std::string to_xml(const Teuchos::ParameterList& list);

/// Rank 0 writes to_xml(list) to the file at `path`; every rank throws if that fails. Collective.
void write_xml(const Comm& comm, const Teuchos::ParameterList& list, const std::string& path);

/// Applies "Section.Inner section.entry name=value" to `list`; sections that are not there are added. The value keeps
/// the type of the entry that it replaces if it can be read as such, else it is the first it can be of int, double,
/// bool, {a, b} of int, double or string, and string. Throws an Error if the text has no "=", or its path ends at a
/// section or leads through an entry.
void apply_override(Teuchos::ParameterList& list, const std::string& text);

}  // namespace sprekk::base
