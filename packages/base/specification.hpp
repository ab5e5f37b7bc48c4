// Specification of the parameters of a program as data, and its output as Markdown, as JSON and as an XML schema.
#pragma once

#include <string>
#include <vector>

#include "base/bounds.hpp"

namespace sprekk::base {

/// Entry of a section.
struct EntrySpecification {
  std::string name;  ///< empty if user-defined
  std::string type, unit;
  std::string value;  ///< default, "absent" or "required"
  std::string meaning;
  Bounds bounds;
  bool required;
  std::vector<std::string> choices;  ///< all allowed values; empty: no restriction
};

/// Section with its entries and subsections.
struct SectionSpecification {
  std::string name;  ///< empty if user-defined
  std::string meaning;
  std::vector<EntrySpecification> entries;
  std::vector<SectionSpecification> sections;
  bool open = false;  ///< copied unchanged; any content
};

/// Returns Markdown with a table for each section and a row for each entry. `path` is the path of the section, "Sprekk
/// > Solver". User-defined names are printed as NAME.
std::string to_markdown(const SectionSpecification& section, const std::string& path);

/// Returns JSON with the members of both structs. `bounds` and `length` are texts, `default` is the value.
std::string to_json(const SectionSpecification& section);

/// Returns a RELAX NG schema (XML syntax) of files whose outermost list is any of `roots`. It contains names with
/// their meanings, types, choices, and required entries of present sections. It does not check bounds and duplicate
/// names.
std::string to_relax_ng(const std::vector<SectionSpecification>& roots);

}  // namespace sprekk::base
