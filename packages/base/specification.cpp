#include "base/specification.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/text.hpp"

namespace sprekk::base {

namespace {

/// Escapes a text for a cell of a Markdown table.
std::string cell(const std::string& text) {
  std::string escaped;
  for (char c : text) escaped += c == '|' ? std::string("\\|") : std::string(1, c);
  return escaped;
}

std::string row(const EntrySpecification& entry) {
  const bool numeric = entry.type.find("double") != std::string::npos || entry.type.find("int") != std::string::npos;
  std::string allowed = !entry.choices.empty() ? quoted_list(entry.choices)
                        : numeric              ? entry.bounds.text()
                                               : std::string("any");
  if (entry.bounds.size()) allowed += ", " + entry.bounds.length_text();
  return fmt::format("| {} | {} | {} | {} | {} | {} |\n", entry.name.empty() ? "NAME" : entry.name, entry.type,
                     cell(entry.unit), cell(entry.value), cell(allowed), cell(entry.meaning));
}

nlohmann::ordered_json json_of(const SectionSpecification& section) {
  nlohmann::ordered_json all{{"name", section.name}, {"meaning", section.meaning}};
  auto& entries = all["entries"] = nlohmann::ordered_json::array();
  for (const auto& entry : section.entries)
    entries.push_back({{"name", entry.name},
                       {"type", entry.type},
                       {"unit", entry.unit},
                       {"default", entry.value},
                       {"meaning", entry.meaning},
                       {"bounds", entry.bounds.text()},
                       {"length", entry.bounds.length_text()},
                       {"required", entry.required},
                       {"choices", entry.choices}});
  auto& sections = all["sections"] = nlohmann::ordered_json::array();
  for (const auto& inner : section.sections) sections.push_back(json_of(inner));
  all["open"] = section.open;
  return all;
}

}  // namespace

std::string to_json(const SectionSpecification& section) { return json_of(section).dump(1); }

std::string to_markdown(const SectionSpecification& section, const std::string& path) {
  std::string rows, inner;
  for (const auto& entry : section.entries) rows += row(entry);
  for (const auto& child : section.sections) {
    if (child.open)
      rows += fmt::format("| {} | section | - | as it is | any | {} |\n", child.name.empty() ? "NAME" : child.name,
                          cell(child.meaning));
    else
      inner += to_markdown(child, fmt::format("{} > {}", path, child.name.empty() ? "NAME" : child.name));
  }
  // A section that contains only sections has no heading.
  if (section.meaning.empty() && rows.empty()) return inner;
  std::string text = fmt::format("## {}\n\n", path);
  if (!section.meaning.empty()) text += section.meaning + "\n\n";
  if (!rows.empty())
    text += "| name | type | unit | default | allowed | meaning |\n|---|---|---|---|---|---|\n" + rows + "\n";
  return text + inner;
}

}  // namespace sprekk::base
