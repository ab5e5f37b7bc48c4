#include "base/xml.hpp"

#include <Teuchos_StringInputSource.hpp>
#include <Teuchos_XMLObject.hpp>
#include <fmt/ranges.h>
#include <algorithm>
#include <cstdlib>

#include "base/check.hpp"
#include "base/file.hpp"
#include "base/over_ranks.hpp"
#include "base/text.hpp"
#include "base/units.hpp"
#include "base/value.hpp"

namespace sprekk::base {

using Teuchos::ParameterList;
using Teuchos::XMLObject;

namespace {

constexpr std::size_t largest_file = std::size_t(64) << 20;  // bytes

/// Throws an Error for characters that the XML parser does not handle: invalid UTF-8, bytes 0, and references beyond
/// ASCII.
void check_characters(const std::string& text, const std::string& file) {
  const auto line = [&](std::size_t at) { return 1 + std::count(text.begin(), text.begin() + at, '\n'); };
  const auto bad = where_not_utf8(text);
  SPREKK_CHECK(!bad, "{}: line {}: byte 0x{:02x} is not UTF-8; save the file in this encoding", file, line(*bad),
               static_cast<unsigned char>(text[*bad]));
  SPREKK_CHECK(text.find('\0') == text.npos, "{}: line {}: has a byte 0; is this an XML file?", file,
               line(text.find('\0')));
  for (auto at = text.find("&#"); at != text.npos; at = text.find("&#", at + 2)) {
    const bool hexadecimal = text.compare(at + 2, 1, "x") == 0;
    const long code = std::strtol(text.c_str() + at + 2 + hexadecimal, nullptr, hexadecimal ? 16 : 10);
    const auto reference = text.substr(at, text.find(';', at) + 1 - at).substr(0, 12);
    SPREKK_CHECK(code >= 32 || code == 9 || code == 10 || code == 13,
                 "{}: line {}: has the character reference {}, which XML does not allow", file, line(at), reference);
    SPREKK_CHECK(code < 128, "{}: line {}: has the character reference {}; write the character itself", file, line(at),
                 reference);
  }
}

/// Returns the message of a Teuchos exception on one printable line, without source line and failed test.
std::string reason(const std::string& what) {
  const std::string test = "Throw test that evaluated to true:";
  std::string text = what;
  if (const auto at = text.find(test); at != text.npos) text = text.substr(std::min(text.find('\n', at), text.size()));
  text = trimmed(text);
  const std::string opening = "XML parse error at ";
  if (text.compare(0, opening.size(), opening) == 0) text = text.substr(opening.size());
  for (char& c : text)
    if (c == '\n')
      c = ' ';
    else if (static_cast<unsigned char>(c) < 32 || static_cast<unsigned char>(c) > 126)
      c = '?';
  return text;
}

/// Throws an Error if nested elements are so deep that recursion could exhaust the stack.
void check_depth(const std::string& text, const std::string& file) {
  constexpr int limit = 1000;
  int depth = 0;
  for (auto at = text.find('<'); at < text.size(); at = text.find('<', at)) {
    const auto begin = at++;
    if (text.compare(begin, 4, "<!--") == 0) {
      at = text.find("-->", at);
      continue;
    }
    for (char quote = 0; at < text.size() && (quote || text[at] != '>'); ++at)
      if (quote ? text[at] == quote : text[at] == '"' || text[at] == '\'') quote = quote ? 0 : text[at];
    const char first = text[begin + 1];
    const bool opens = first != '/' && first != '!' && first != '?' && text[at - 1] != '/';
    depth += opens ? 1 : first == '/' ? -1 : 0;
    SPREKK_CHECK(depth <= limit, "{}: has more than {} elements inside of each other", file, limit);
  }
}

/// Converts the children of an XML element. An unreadable child becomes an Unreadable with a message that begins with
/// `place`. A child without a name gets a name that begins with "<".
class Converter {
 public:
  static void fill(ParameterList& list, const XMLObject& element, const std::string& place) {
    for (int i = 0; i < element.numContentLines(); ++i) {
      const std::string text(trimmed(element.getContentLine(i)));
      if (!text.empty())
        refuse(list, fmt::format("<text {}>", i),
               fmt::format("{}: has the text \"{}\", expected elements only", place, shortened(text)));
    }
    for (int i = 0; i < element.numChildren(); ++i) {
      const auto& child = element.getChild(i);
      if (!is_known(child))
        refuse(list, fmt::format("<child {}>", i),
               fmt::format("{}: has an element <{}>, expected <Parameter> or <ParameterList>", place, child.getTag()));
      else if (!child.hasAttribute("name"))
        refuse(list, fmt::format("<child {}>", i), fmt::format("{}: has a <{}> without a name", place, child.getTag()));
      else
        add(list, child, place);
    }
  }

 private:
  static bool is_known(const XMLObject& child) {
    return child.getTag() == "Parameter" || child.getTag() == "ParameterList";
  }

  static void refuse(ParameterList& list, const std::string& name, const std::string& message) {
    list.remove(name, false);
    list.set(name, Unreadable{message});
  }

  static void add(ParameterList& list, const XMLObject& child, const std::string& place) {
    const std::string name = child.getAttribute("name"), entry = fmt::format("{} > \"{}\"", place, name);
    if (list.isParameter(name)) return refuse(list, name, entry + ": occurs twice");
    if (child.getTag() == "ParameterList") return fill(list.sublist(name), child, place + " > " + name);
    try {
      SPREKK_CHECK(child.numChildren() == 0, "a <Parameter> cannot have elements inside");
      for (const char* attribute : {"type", "value"})
        SPREKK_CHECK(child.hasAttribute(attribute), "has no {}=\"...\"", attribute);
      set_from_text(list, name, child.getAttribute("type"), child.getAttribute("value"));
    } catch (const Error& error) {
      refuse(list, name, entry + ": " + error.what());
    }
  }
};

void write_list(std::string& text, const ParameterList& list, const std::string& name, const std::string& indent) {
  text += fmt::format("{}<ParameterList name=\"{}\">\n", indent, xml_escaped(name));
  for (const auto& named_entry : list) {
    const auto& key = named_entry.first;
    const auto& entry = named_entry.second;
    if (entry.isList()) {
      write_list(text, list.sublist(key), key, indent + "  ");
      continue;
    }
    const std::string type = type_of(entry);
    SPREKK_CHECK(!type.empty(), "{} > \"{}\": is {}, which XML cannot carry", list.name(), key, describe(entry));
    text += fmt::format("{}  <Parameter name=\"{}\" type=\"{}\" value=\"{}\"/>\n", indent, xml_escaped(key), type,
                        xml_escaped(value_text(entry)));
  }
  text += indent + "</ParameterList>\n";
}

/// Returns the first name in a path like "Time.step.size": the longest one in `list`, else the text before the first
/// ".".
std::string first_name(const ParameterList& list, const std::string& path) {
  std::string name;
  for (const auto& named_entry : list) {
    const auto& key = named_entry.first;
    const bool opens = path == key || path.compare(0, key.size() + 1, key + ".") == 0;
    if (opens && key.size() > name.size()) name = key;
  }
  return name.empty() ? path.substr(0, path.find('.')) : name;
}

bool set_if_it_is(ParameterList& list, const std::string& name, const std::string& type, const std::string& value) {
  try {
    set_from_text(list, name, type, value);
  } catch (const Error&) {
    return false;
  }
  return true;
}

/// True for a text like "25 GPa", which can replace a number.
bool is_quantity_in_text(const Teuchos::ParameterEntry& entry) {
  if (!entry.isType<std::string>()) return false;
  const auto quantity = parse_quantity(Teuchos::getValue<std::string>(entry));
  return quantity && defect_of_unit(quantity->unit).empty();
}

void set_value(ParameterList& list, const std::string& name, const std::string& value) {
  std::vector<std::string> types = {"int", "double", "bool", "Array(int)", "Array(double)", "Array(string)", "string"};
  const auto* entry = list.getEntryPtr(name);
  if (entry && !is_quantity_in_text(*entry)) types.insert(types.begin(), type_of(*entry));
  for (const auto& type : types)
    if (set_if_it_is(list, name, type, value)) return;
}

}  // namespace

ParameterList parse_xml(const std::string& text, const std::string& file, const std::string& root, Defects defects) {
  const std::string byte_order_mark = "\xEF\xBB\xBF";
  const bool marked = text.compare(0, 3, byte_order_mark) == 0;
  SPREKK_CHECK(!trimmed(text).empty(), "{}: is empty", file);
  check_characters(text, file);
  check_depth(text, file);
  XMLObject element;
  try {
    element = Teuchos::StringInputSource(marked ? text.substr(3) : text).getObject();
  } catch (const std::exception& error) {
    throw Error(fmt::format("{}: not well-formed XML: {}", file, reason(error.what())));
  }
  SPREKK_CHECK(element.getTag() == "ParameterList", "{}: the outermost element is <{}>, must be <ParameterList>", file,
               element.getTag());
  const std::string name = element.hasAttribute("name") ? std::string(element.getAttribute("name")) : "";
  SPREKK_CHECK(name == root, "{}: the outermost list is called \"{}\", must be <ParameterList name=\"{}\">", file, name,
               root);
  ParameterList list(root);
  Converter::fill(list, element, file + ": " + root);
  const auto errors = unreadable(list);
  SPREKK_CHECK(errors.empty() || defects == Defects::keep, "{}", fmt::join(errors, "\n"));
  return list;
}

ParameterList read_xml(const Comm& comm, const std::string& path, const std::string& root, Defects defects) {
  std::string text;
  collectively(comm, [&] {
    if (comm.getRank() == 0) text = read_file(path, "an XML file", largest_file, {});
  });
  text = of_rank(comm, 0, text);
  ParameterList list;
  collectively(comm, [&] { list = parse_xml(text, path, root, defects); });
  return list;
}

std::string to_xml(const ParameterList& list) {
  std::string text;
  write_list(text, list, list.name(), "");
  return text;
}

void apply_override(ParameterList& list, const std::string& text) {
  const auto equals = text.find('=');
  SPREKK_CHECK(equals != text.npos, "override \"{}\": has no \"=\", expected Section.entry=value", shortened(text));
  std::string path(trimmed(text.substr(0, equals)));
  const std::string value(trimmed(text.substr(equals + 1)));
  ParameterList* section = &list;
  for (;;) {
    const std::string name = first_name(*section, path);
    SPREKK_CHECK(!name.empty(), "override \"{}\": has an empty name, expected Section.entry=value", shortened(text));
    if (name == path) break;
    SPREKK_CHECK(!section->isParameter(name) || section->isSublist(name), "override \"{}\": \"{}\" is not a section",
                 shortened(text), shortened(name));
    section = &section->sublist(name);
    path.erase(0, name.size() + 1);
  }
  SPREKK_CHECK(!section->isSublist(path), "override \"{}\": \"{}\" is a section, expected the name of an entry in it",
               shortened(text), shortened(path));
  set_value(*section, path, value);
}

std::vector<std::string> apply_overrides(ParameterList& list, const std::string& file,
                                         const std::vector<std::string>& texts) {
  std::vector<std::string> errors;
  for (const auto& text : texts) try {
      apply_override(list, text);
    } catch (const Error& error) {
      errors.push_back(file + ": " + error.what());
    }
  return errors;
}

}  // namespace sprekk::base
