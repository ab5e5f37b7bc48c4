#include "base/xml.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <Teuchos_StringInputSource.hpp>
#include <Teuchos_XMLObject.hpp>
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "base/check.hpp"
#include "base/text.hpp"
#include "base/value.hpp"

namespace sprekk::base {

using Teuchos::ParameterList;
using Teuchos::XMLObject;

namespace {

std::string read_file(const std::string& path) {
  SPREKK_CHECK(std::filesystem::exists(path), "{}: there is no such file", path);
  SPREKK_CHECK(!std::filesystem::is_directory(path), "{}: is a folder, expected an XML file", path);
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (file.peek() != std::ifstream::traits_type::eof()) text << file.rdbuf();
  SPREKK_CHECK(file && text, "{}: cannot be read", path);
  SPREKK_CHECK(text.str().size() < std::size_t(std::numeric_limits<int>::max()), "{}: is too large", path);
  return text.str();
}

/// What a Teuchos exception says, without the source line and the test that threw it, on one printable line.
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

/// Refuses elements so deep inside of each other that recursion would exhaust the stack.
void check_depth(const std::string& text, const std::string& file) {
  constexpr int limit = 1000;
  int depth = 0;
  for (std::size_t i = 0; i + 1 < text.size(); ++i) {
    if (text[i] == '<' && std::isalpha(static_cast<unsigned char>(text[i + 1]))) ++depth;
    if ((text[i] == '<' && text[i + 1] == '/') || (text[i] == '/' && text[i + 1] == '>')) --depth;
    SPREKK_CHECK(depth <= limit, "{}: has more than {} elements inside of each other", file, limit);
  }
}

/// Converts the children of an XML element; every message opens with `place`.
class Converter {
 public:
  static void fill(ParameterList& list, const XMLObject& element, const std::string& place) {
    for (int i = 0; i < element.numContentLines(); ++i)
      SPREKK_CHECK(trimmed(element.getContentLine(i)).empty(), "{}: has the text \"{}\", expected elements only", place,
                   std::string(trimmed(element.getContentLine(i))));
    for (int i = 0; i < element.numChildren(); ++i) add(list, element.getChild(i), place);
  }

 private:
  static void add(ParameterList& list, const XMLObject& child, const std::string& place) {
    const std::string& tag = child.getTag();
    SPREKK_CHECK(tag == "Parameter" || tag == "ParameterList",
                 "{}: has an element <{}>, expected <Parameter> or <ParameterList>", place, tag);
    SPREKK_CHECK(child.hasAttribute("name"), "{}: has a <{}> without a name", place, tag);
    const std::string name = child.getAttribute("name");
    SPREKK_CHECK(!list.isParameter(name), "{} > \"{}\": occurs twice", place, name);
    if (tag == "ParameterList") return fill(list.sublist(name), child, place + " > " + name);
    const std::string entry = fmt::format("{} > \"{}\"", place, name);
    SPREKK_CHECK(child.numChildren() == 0, "{}: a <Parameter> cannot have elements inside", entry);
    for (const char* attribute : {"type", "value"})
      SPREKK_CHECK(child.hasAttribute(attribute), "{}: has no {}=\"...\"", entry, attribute);
    try {
      set_from_text(list, name, child.getAttribute("type"), child.getAttribute("value"));
    } catch (const Error& error) {
      throw Error(entry + ": " + error.what());
    }
  }
};

std::string escaped(const std::string& text) {
  std::string result;
  for (char c : text) switch (c) {
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '&':
        result += "&amp;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  return result;
}

void write_list(std::string& text, const ParameterList& list, const std::string& name, const std::string& indent) {
  text += fmt::format("{}<ParameterList name=\"{}\">\n", indent, escaped(name));
  for (const auto& named_entry : list) {
    const auto& key = named_entry.first;
    const auto& entry = named_entry.second;
    if (entry.isList()) {
      write_list(text, list.sublist(key), key, indent + "  ");
      continue;
    }
    const std::string type = type_of(entry);
    SPREKK_CHECK(!type.empty(), "{} > \"{}\": is {}, which XML cannot carry", list.name(), key, describe(entry));
    text += fmt::format("{}  <Parameter name=\"{}\" type=\"{}\" value=\"{}\"/>\n", indent, escaped(key), type,
                        escaped(value_text(entry)));
  }
  text += indent + "</ParameterList>\n";
}

/// The first name in a path like "Time.step.size": the longest that `list` has, else what is before the first ".".
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

void set_value(ParameterList& list, const std::string& name, const std::string& value) {
  std::vector<std::string> types = {"int", "double", "bool", "Array(int)", "Array(double)", "Array(string)", "string"};
  if (const auto* entry = list.getEntryPtr(name)) types.insert(types.begin(), type_of(*entry));
  for (const auto& type : types)
    if (set_if_it_is(list, name, type, value)) return;
}

}  // namespace

ParameterList parse_xml(const std::string& text, const std::string& file, const std::string& root) {
  const std::string byte_order_mark = "\xEF\xBB\xBF";
  const bool marked = text.compare(0, 3, byte_order_mark) == 0;
  SPREKK_CHECK(!trimmed(text).empty(), "{}: is empty", file);
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
  return list;
}

ParameterList read_xml(const Comm& comm, const std::string& path, const std::string& root) {
  std::string text;
  collectively(comm, [&] {
    if (comm.getRank() == 0) text = read_file(path);
  });
  int length = static_cast<int>(text.size());
  Teuchos::broadcast(comm, 0, 1, &length);
  text.resize(length);
  Teuchos::broadcast(comm, 0, length, text.data());
  ParameterList list;
  collectively(comm, [&] { list = parse_xml(text, path, root); });
  return list;
}

std::string to_xml(const ParameterList& list) {
  std::string text;
  write_list(text, list, list.name(), "");
  return text;
}

void write_xml(const Comm& comm, const ParameterList& list, const std::string& path) {
  collectively(comm, [&] {
    if (comm.getRank() != 0) return;
    const std::string text = to_xml(list);
    std::ofstream file(path);
    file << text << std::flush;
    SPREKK_CHECK(file, "{}: cannot be written", path);
  });
}

void apply_override(ParameterList& list, const std::string& text) {
  const auto equals = text.find('=');
  SPREKK_CHECK(equals != text.npos, "override \"{}\": has no \"=\", expected Section.entry=value", text);
  std::string path(trimmed(text.substr(0, equals)));
  const std::string value(trimmed(text.substr(equals + 1)));
  ParameterList* section = &list;
  for (;;) {
    const std::string name = first_name(*section, path);
    SPREKK_CHECK(!name.empty(), "override \"{}\": has an empty name, expected Section.entry=value", text);
    if (name == path) break;
    SPREKK_CHECK(!section->isParameter(name) || section->isSublist(name), "override \"{}\": \"{}\" is not a section",
                 text, name);
    section = &section->sublist(name);
    path.erase(0, name.size() + 1);
  }
  SPREKK_CHECK(!section->isSublist(path), "override \"{}\": \"{}\" is a section, expected the name of an entry in it",
               text, path);
  set_value(*section, path, value);
}

}  // namespace sprekk::base
