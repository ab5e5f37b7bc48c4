// RELAX NG schema of a specification. The order of a parameter list is free, but the interleave of RELAX NG cannot
// distinguish elements of the same name. The content of a section with required entries a and b is therefore: optional
// elements, then either a and the content of a section that requires b, or b and the content of one that requires a.
#include <fmt/format.h>

#include <cctype>

#include "base/specification.hpp"
#include "base/text.hpp"

namespace sprekk::base {

namespace {

/// Attributes type (one of `types`) and value (matches a regular expression).
std::string typed(const std::vector<std::string>& types, const std::string& pattern) {
  std::string names;
  for (const auto& type : types) names += fmt::format("<value>{}</value>", type);
  return fmt::format(
      "    <group>\n      <attribute name=\"type\"><choice>{}</choice></attribute>\n"
      "      <attribute name=\"value\"><data type=\"string\"><param name=\"pattern\">{}</param></data></attribute>\n"
      "    </group>\n",
      names, xml_escaped(pattern));
}

std::string definition(const std::string& name, const std::string& content) {
  return fmt::format("  <define name=\"{}\">\n{}  </define>\n", name, content);
}

std::string choice(const std::string& content) { return "    <choice>\n" + content + "    </choice>\n"; }

std::string list_of(const std::string& pattern) { return fmt::format("\\s*\\{{({0}(,{0})*|\\s*)\\}}\\s*", pattern); }

const char* const integer = "\\s*[+\\-]?[0-9]+\\s*";
const char* const number = "\\s*([+\\-]?([0-9]+\\.?[0-9]*|\\.[0-9]+)([eE][+\\-]?[0-9]+)?|-?infinite)\\s*";
const char* const anything = "(.|\\n|\\r)*";

/// Definitions of the attributes of all entry types, with the names used by attributes_of().
std::string value_definitions() {
  const std::string any_list = std::string("\\s*\\{") + anything + "\\}\\s*";
  std::string text = definition("int", typed({"int", "long long"}, integer)) +
                     definition("bool", typed({"bool"}, "\\s*([tT][rR][uU][eE]|[fF][aA][lL][sS][eE])\\s*")) +
                     definition("string", typed({"string"}, anything)) +
                     definition("Array_int", typed({"Array(int)"}, list_of(integer))) +
                     definition("Array_string", typed({"Array(string)"}, any_list));
  for (const bool with_unit : {false, true}) {
    const std::string suffix = with_unit ? "_with_unit" : "";
    const std::string value = number + std::string(with_unit ? "([A-Za-z\u00b0\u00b5\u03bc][^,\\{\\}]*)?" : "");
    const std::string one = typed({"double", "int", "long long"}, value);
    const std::string many = typed({"Array(double)", "Array(int)"}, list_of(value));
    text += definition("double" + suffix, choice(one + typed({"string"}, value))) +
            definition("expression" + suffix, choice(one + typed({"string"}, anything))) +
            definition("Array_double" + suffix, many) +
            definition("Array_expression" + suffix, choice(many + typed({"Array(string)"}, any_list)));
  }
  return text;
}

std::string attributes_of(const EntrySpecification& entry) {
  if (!entry.choices.empty()) {
    std::string words;
    for (const auto& word : entry.choices) words += fmt::format("<value>{}</value>", xml_escaped(word));
    return fmt::format(
        "      <attribute name=\"type\"><value>string</value></attribute>\n"
        "      <attribute name=\"value\"><choice>{}</choice></attribute>\n",
        words);
  }
  const bool is_array = entry.type.compare(0, 5, "Array") == 0;
  std::string type = entry.type;
  if (type.find("expression") != type.npos) type = "expression";
  if (type == "long long") type = "int";
  for (const char* name : {"double", "int", "string"})
    if (type == fmt::format("Array({})", name)) type = name;
  const bool is_real = type == "double" || type == "expression";
  return fmt::format("      <ref name=\"{}{}{}\"/>\n", is_array ? "Array_" : "", type,
                     is_real && entry.unit != "-" ? "_with_unit" : "");
}

std::string element(const std::string& tag, const std::string& name, const std::string& meaning,
                    const std::string& content) {
  const std::string value = name.empty() ? "<text/>" : fmt::format("<value>{}</value>", xml_escaped(name));
  const std::string documentation =
      meaning.empty() ? "" : fmt::format("      <a:documentation>{}</a:documentation>\n", xml_escaped(meaning));
  return fmt::format("    <element name=\"{}\">\n{}      <attribute name=\"name\">{}</attribute>\n{}    </element>\n",
                     tag, documentation, value, content);
}

std::string reference_to(const std::string& name) { return fmt::format("      <ref name=\"{}\"/>\n", name); }

/// Converts a path like "Sprekk > Mesh" to a valid name of a definition.
std::string identifier(const std::string& path) {
  std::string name;
  for (char c : path) name += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  return name;
}

/// Definitions of a section and its subsections.
std::string section_definitions(const SectionSpecification& section, const std::string& path) {
  const std::string name = identifier(path);
  std::string optional, inner;
  std::vector<std::string> required;
  for (const auto& entry : section.entries) {
    const std::string one = element("Parameter", entry.name, entry.meaning, attributes_of(entry));
    entry.required ? required.push_back(one) : void(optional += one);
  }
  for (const auto& child : section.sections) {
    const std::string inside = path + "." + (child.name.empty() ? "NAME" : child.name);
    optional += child.open ? element("ParameterList", child.name, child.meaning, reference_to("anything"))
                           : reference_to(identifier(inside));
    if (!child.open) inner += section_definitions(child, inside);
  }
  std::string text = definition(name, element("ParameterList", section.name, section.meaning,
                                              reference_to(fmt::format("{}.{}", name, (1 << required.size()) - 1))));
  for (int needed = 0; needed < 1 << required.size(); ++needed) {
    std::string content =
                    optional.empty() ? "" : "    <zeroOrMore><ref name=\"" + name + ".optional\"/></zeroOrMore>\n",
                next;
    for (std::size_t i = 0; i < required.size(); ++i)
      if (needed >> i & 1)
        next += "    <group>\n" + reference_to(fmt::format("{}.required.{}", name, i)) +
                reference_to(fmt::format("{}.{}", name, needed & ~(1 << i))) + "    </group>\n";
    if (needed) content += choice(next);
    text += definition(fmt::format("{}.{}", name, needed), content.empty() ? "    <empty/>\n" : content);
  }
  if (!optional.empty()) text += definition(name + ".optional", choice(optional));
  for (std::size_t i = 0; i < required.size(); ++i)
    text += definition(fmt::format("{}.required.{}", name, i), required[i]);
  return text + inner;
}

}  // namespace

std::string to_relax_ng(const std::vector<SectionSpecification>& roots) {
  std::string text =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<grammar xmlns=\"http://relaxng.org/ns/structure/1.0\" "
      "xmlns:a=\"http://relaxng.org/ns/compatibility/annotations/1.0\" "
      "datatypeLibrary=\"http://www.w3.org/2001/XMLSchema-datatypes\">\n";
  std::string starts, sections;
  for (std::size_t i = 0; i < roots.size(); ++i) {
    const std::string path = fmt::format("root{}", i);
    starts += reference_to(path);
    sections += section_definitions(roots[i], path);
  }
  const std::string pair = "      <attribute name=\"type\"/>\n      <attribute name=\"value\"/>\n";
  return text + "  <start>\n" + choice(starts) + "  </start>\n" + value_definitions() +
         definition("anything", "    <zeroOrMore>\n" +
                                    choice(element("Parameter", "", "", pair) +
                                           element("ParameterList", "", "", reference_to("anything"))) +
                                    "    </zeroOrMore>\n") +
         sections + "</grammar>\n";
}

}  // namespace sprekk::base
