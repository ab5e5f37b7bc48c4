// What a program knows of its parameters, as data, and as documents for people and for editors.
#pragma once

#include <string>
#include <vector>

#include "base/bounds.hpp"

namespace sprekk::base {

/// An entry of a section.
struct EntrySpecification {
  std::string name;  ///< empty if the user chooses it
  std::string type, unit;
  std::string value;  ///< the default, "absent" or "required"
  std::string meaning;
  Bounds bounds;
  bool required;
  std::vector<std::string> choices;  ///< if not empty, all allowed values
};

/// A section with its entries and sections.
struct SectionSpecification {
  std::string name;  ///< empty if the user chooses it
  std::string meaning;
  std::vector<EntrySpecification> entries;
  std::vector<SectionSpecification> sections;
  bool open = false;  ///< handed on as it is, anything may be inside
};

/// Markdown: for every section a table with one row for each entry. `path` leads to the section: "Sprekk > Solver".
/// Sections named by the user are called NAME.
std::string to_markdown(const SectionSpecification& section, const std::string& path);

/// A RELAX NG schema (XML syntax) of files whose outermost list is any of `roots`: names, types, words that are
/// choices, and required entries of the sections that are there; not bounds, nor that names occur once.
std::string to_relax_ng(const std::vector<SectionSpecification>& roots);

}  // namespace sprekk::base
