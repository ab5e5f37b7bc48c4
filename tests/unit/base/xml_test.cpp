#include "base/xml.hpp"

#include <Tpetra_Core.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "array.hpp"
#include "base/value.hpp"
#include "message.hpp"

namespace sprekk::base {
namespace {

using Teuchos::Array;
using Teuchos::ParameterList;

std::string scene(const std::string& inside) { return "<ParameterList name=\"Sprekk\">" + inside + "</ParameterList>"; }
std::string parameter(const std::string& type, const std::string& value) {
  return scene("<ParameterList name=\"S\"><Parameter name=\"a b\" type=\"" + type + "\" value=\"" + value +
               "\"/></ParameterList>");
}
ParameterList parse(const std::string& text) { return parse_xml(text, "scene.xml", "Sprekk"); }
std::string refusal(const std::string& text) {
  return message_of([&] { parse(text); });
}
template <class T>
T value(const std::string& type, const std::string& text) {
  return parse(parameter(type, text)).sublist("S").get<T>("a b");
}

TEST(Xml, values_have_their_types) {
  EXPECT_EQ(value<int>("int", "-3"), -3);
  EXPECT_EQ(value<long long>("long long", "99999999999"), 99999999999LL);
  EXPECT_EQ(value<double>("double", "1e-3"), 1e-3);
  EXPECT_EQ(value<double>("double", "infinite"), INFINITY);
  EXPECT_EQ(value<bool>("bool", "true"), true);
  EXPECT_EQ(value<std::string>("string", "x &lt; 1 &amp;&amp; &quot;y&quot; > 'z'"), "x < 1 && \"y\" > 'z'");
  EXPECT_EQ(value<Array<int>>("Array(int)", "{1, 2}"), array<int>({1, 2}));
  EXPECT_EQ(value<Array<double>>("Array(double)", "{}"), Array<double>());
  EXPECT_EQ(value<Array<std::string>>("Array(string)", "{atan2(x, y), c}"), array<std::string>({"atan2(x, y)", "c"}));
  EXPECT_EQ(parse("\xEF\xBB\xBF<?xml version='1.0'?>\r\n<!-- c -->" + scene("")).numParams(), 0);
}

TEST(Xml, values_that_are_not_of_their_type_are_refused) {
  const std::string place = "scene.xml: Sprekk > S > \"a b\": ";
  EXPECT_EQ(refusal(parameter("double", "1.0abc")), place + "is \"1.0abc\", not a number: unknown unit \"abc\"");
  EXPECT_EQ(refusal(parameter("int", "99999999999")),
            place + "is \"99999999999\", too large for an int; use type=\"long long\"");
  const std::vector<std::array<const char*, 2>> wrong = {{"double", "abc"},
                                                         {"double", ""},
                                                         {"double", "1,5"},
                                                         {"double", "nan"},
                                                         {"double", "1e999"},
                                                         {"int", "1.5"},
                                                         {"int", "0x10"},
                                                         {"int", ""},
                                                         {"long long", "1e3"},
                                                         {"bool", "yes"},
                                                         {"bool", "1"},
                                                         {"Array(int)", "{1, 2.5}"},
                                                         {"Array(double)", "{1, 2x}"},
                                                         {"Array(double)", "1, 2"},
                                                         {"Array(double)", "{1 2}"},
                                                         {"Array(double)", "{1, 2"},
                                                         {"Array(double)", "{1,,2}"},
                                                         {"Array(string)", "{a, f(b}"}};
  for (const auto& [type, text] : wrong) {
    const std::string message = refusal(parameter(type, text));
    EXPECT_EQ(message.substr(0, place.size()), place);
    EXPECT_CONTAINS(message, ", not ");
  }
  const std::string message = refusal(parameter("dobule", "1"));
  EXPECT_CONTAINS(message, place + "has the unknown type \"dobule\"; types are \"int\", ");
  EXPECT_CONTAINS(message, ". Did you mean \"double\"?");
}

TEST(Xml, structure_that_is_not_a_parameter_list_is_refused) {
  const auto expect = [](const std::string& inside, const std::string& message) {
    EXPECT_EQ(refusal(scene(inside)), "scene.xml: Sprekk" + message);
  };
  const std::string a = "<Parameter name=\"a\" type=\"int\" value=\"1\"/>";
  expect(a + a, " > \"a\": occurs twice");
  expect("<ParameterList name=\"a\"/>" + a, " > \"a\": occurs twice");
  expect(a + "<ParameterList name=\"a\"/>", " > \"a\": occurs twice");
  expect("<ParameterList name=\"b\"/><ParameterList name=\"b\"/>", " > \"b\": occurs twice");
  expect("<ParameterList/>", ": has a <ParameterList> without a name");
  expect("<Parameter type=\"int\" value=\"1\"/>", ": has a <Parameter> without a name");
  expect("<Parameter name=\"a\" value=\"1\"/>", " > \"a\": has no type=\"...\"");
  expect("<Parameter name=\"a\" type=\"int\"/>", " > \"a\": has no value=\"...\"");
  expect("<foo/>", ": has an element <foo>, expected <Parameter> or <ParameterList>");
  expect("<ParameterList name=\"b\">some text</ParameterList>",
         " > b: has the text \"some text\", expected elements only");
  expect("<Parameter name=\"a\" type=\"int\" value=\"1\"><foo/></Parameter>",
         " > \"a\": a <Parameter> cannot have elements inside");
}

TEST(Xml, all_defects_are_reported_or_kept_in_their_places) {
  const std::string text = scene(
      "<foo/><Parameter name=\"a\" type=\"int\" value=\"x\"/><Parameter name=\"b\" type=\"int\" value=\"1\"/>"
      "<ParameterList name=\"S\">text<Parameter name=\"c\" value=\"1\"/></ParameterList><ParameterList name=\"b\"/>");
  const std::vector<std::string> errors = {
      "scene.xml: Sprekk: has an element <foo>, expected <Parameter> or <ParameterList>",
      "scene.xml: Sprekk > \"a\": is \"x\", not an integer", "scene.xml: Sprekk > \"b\": occurs twice",
      "scene.xml: Sprekk > S: has the text \"text\", expected elements only",
      "scene.xml: Sprekk > S > \"c\": has no type=\"...\""};
  const std::string refused = refusal(text);
  for (const auto& error : errors) EXPECT_CONTAINS(refused, error);
  EXPECT_EQ(std::count(refused.begin(), refused.end(), '\n'), 4);
  const auto list = parse_xml(text, "scene.xml", "Sprekk", Defects::keep);
  EXPECT_EQ(unreadable(list).size(), errors.size());
  EXPECT_EQ(list.get<Unreadable>("b").message, errors[2]);
  EXPECT_TRUE(list.sublist("S").isType<Unreadable>("c"));
}

TEST(Xml, processing_instructions_are_passed_over) {
  EXPECT_EQ(parse("<?xml version=\"1.0\"?>\n<?xml-model href=\"sprekk.rng\" "
                  "schematypens=\"http://relaxng.org/ns/structure/1.0\"?>\n<!-- c -->" +
                  parameter("int", "3"))
                .sublist("S")
                .get<int>("a b"),
            3);
}

TEST(Xml, the_outermost_list_must_be_the_right_one) {
  EXPECT_EQ(refusal("<Parameters name=\"Sprekk\"/>"),
            "scene.xml: the outermost element is <Parameters>, must be <ParameterList>");
  EXPECT_EQ(refusal("<ParameterList name=\"Sprek\"/>"),
            "scene.xml: the outermost list is called \"Sprek\", must be <ParameterList name=\"Sprekk\">");
  EXPECT_CONTAINS(refusal("<ParameterList/>"), "is called \"\"");
}

TEST(Xml, text_that_is_not_well_formed_is_refused_with_its_line) {
  EXPECT_EQ(refusal(""), "scene.xml: is empty");
  EXPECT_EQ(refusal(" \n\t"), "scene.xml: is empty");
  EXPECT_EQ(
      refusal("<ParameterList name=\"Sprekk\">\n<Parameter name=\"a\" type=\"int\" value=\"1\">\n</ParameterList>"),
      "scene.xml: not well-formed XML: line 3: document not well-formed: end element tag = 'ParameterList' did not "
      "match start element 'Parameter' from line 2");
  const std::string elf(
      "\x7f"
      "ELF\x00\x01\x02\xff\xfe",
      9);
  EXPECT_EQ(refusal(elf), "scene.xml: line 1: byte 0xff is not UTF-8; save the file in this encoding");
  for (const std::string& text : {std::string(300, '<'), "no xml" + scene(""), scene("") + "x", scene("") + scene(""),
                                  scene("<!-- "), scene("&foo;"), scene("<a b></a>")})
    EXPECT_CONTAINS(refusal(text), "scene.xml: not well-formed XML: ");
}

TEST(Xml, nesting_is_limited) {
  const auto nested = [](int depth, const std::string& name) {
    std::string text;
    for (int i = 0; i < depth; ++i) text = "<ParameterList name=\"" + name + "\">" + text + "</ParameterList>";
    return scene(text);
  };
  for (const char* name : {"a", "/>"}) {
    EXPECT_EQ(parse(nested(500, name)).numParams(), 1);
    EXPECT_EQ(refusal(nested(5000, name)), "scene.xml: has more than 1000 elements inside of each other");
  }
  std::string siblings;
  for (int i = 0; i < 2000; ++i) siblings += "<!-- <a> --><ParameterList name='" + std::to_string(i) + "'/>";
  EXPECT_EQ(parse(scene(siblings)).numParams(), 2000);
}

TEST(Xml, every_truncated_file_is_refused) {
  const std::string text = parameter("double", "1.5");
  for (std::size_t n = 0; n < text.size(); ++n) EXPECT_EQ(refusal(text.substr(0, n)).substr(0, 11), "scene.xml: ") << n;
}

TEST(Xml, no_changed_byte_does_harm) {
  const std::string text = "<?xml version=\"1.0\"?><!-- c -->\n" + parameter("Array(double)", "{1, 2}");
  for (std::size_t i = 0; i < text.size(); ++i)
    for (const char c : {'<', '>', '"', '\'', '&', '/', '\0', ' ', '{', ',', 'x', '\xff'}) {
      std::string changed = text;
      changed[i] = c;
      try {
        parse(changed);
      } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()).substr(0, 11), "scene.xml: ");
      }
    }
}

ParameterList all_types() {
  ParameterList list("Sprekk");
  list.set("int", -3)
      .set("long", 1234567890123LL)
      .set("third", 1.0 / 3.0)
      .set("infinite", double(INFINITY))
      .set("bool", false);
  list.set("text", std::string("a < b & \"c\" 'd' > \xc3\xb8"));
  list.set("ints", array<int>({1, 2})).set("doubles", array<double>({0.1, 1e300})).set("none", Array<int>());
  list.set("texts", array<std::string>({"atan2(x, y)", "a, b", "", " padded ", "say \"hi\", you", "(", "\"quoted\""}));
  list.sublist("Inner \"one\"").sublist("Innermost").set("a.b", 1);
  list.sublist("Empty");
  return list;
}

TEST(Xml, what_is_written_reads_back_the_same) {
  const auto list = all_types();
  const auto again = parse(to_xml(list));
  EXPECT_EQ(to_xml(again), to_xml(list));
  EXPECT_EQ(again.get<double>("third"), 1.0 / 3.0);
  EXPECT_EQ(again.get<double>("infinite"), INFINITY);
  EXPECT_EQ(again.get<std::string>("text"), list.get<std::string>("text"));
  EXPECT_EQ(again.get<Array<std::string>>("texts"), list.get<Array<std::string>>("texts"));
  EXPECT_EQ(again.get<Array<double>>("doubles"), list.get<Array<double>>("doubles"));
  EXPECT_EQ(again.sublist("Inner \"one\"").sublist("Innermost").get<int>("a.b"), 1);
  EXPECT_TRUE(again.isSublist("Empty"));
  ParameterList pointer("Sprekk");
  pointer.set("p", RCP<int>());
  EXPECT_CONTAINS(message_of([&] { to_xml(pointer); }), "Sprekk > \"p\": is of type");
}

TEST(Xml, files_are_read_by_all_ranks) {
  const auto comm = Tpetra::getDefaultComm();
  const std::string path = fmt::format("{}/sprekk_xml_test_{}.xml", testing::TempDir(), comm->getSize());
  if (comm->getRank() == 0) std::ofstream(path) << to_xml(all_types());
  EXPECT_EQ(to_xml(read_xml(*comm, path, "Sprekk")), to_xml(all_types()));
  EXPECT_CONTAINS(message_of([&] { read_xml(*comm, path, "Other"); }), path + ": the outermost list");
  comm->barrier();
  if (comm->getRank() == 0) std::ofstream(path) << "<ParameterList";
  EXPECT_CONTAINS(message_of([&] { read_xml(*comm, path, "Sprekk"); }), path + ": not well-formed XML: line 1");
  if (comm->getRank() == 0) std::filesystem::resize_file(path, 0);
  EXPECT_EQ(message_of([&] { read_xml(*comm, path, "Sprekk"); }), path + ": is empty");
  if (comm->getRank() == 0) std::remove(path.c_str());
}

TEST(Xml, characters_that_the_parser_takes_amiss_are_refused) {
  const auto with = [](const std::string& name) {
    return refusal("<ParameterList name=\"Sprekk\">\n<ParameterList name=\"" + name + "\"/></ParameterList>");
  };
  EXPECT_NO_THROW(
      parse_xml(scene("<ParameterList name='r\xc3\xb8ck &#65;&#x42; \xe2\x82\xac \xf0\x9f\xaa\xa8'/>"), "f", "Sprekk"));
  EXPECT_EQ(with("r\xf8"
                 "ck"),
            "scene.xml: line 2: byte 0xf8 is not UTF-8; save the file in this encoding");
  for (const char* bad : {"\xc3", "\x80", "\xc0\x80", "\xe0\x80\x80", "\xed\xa0\x80", "\xf5\x80\x80\x80", "\xe2\x82"})
    EXPECT_CONTAINS(with(bad), "scene.xml: line 2: byte 0x");
  EXPECT_CONTAINS(with("r&#248;ck"), "scene.xml: line 2: has the character reference &#248;");
  EXPECT_CONTAINS(with("r&#xf8;ck"), "has the character reference &#xf8;");
  EXPECT_CONTAINS(with(std::string("a\0b", 3)), "scene.xml: line 2: has a byte 0");
}

TEST(Xml, files_that_cannot_be_read_are_an_error_on_all_ranks) {
  const auto comm = Tpetra::getDefaultComm();
  EXPECT_EQ(message_of([&] { read_xml(*comm, "no/such.xml", "Sprekk"); }), "no/such.xml: there is no such file");
  EXPECT_EQ(message_of([&] { read_xml(*comm, "/", "Sprekk"); }), "/: is a folder, expected an XML file");
  EXPECT_EQ(message_of([&] { read_xml(*comm, "/dev/zero", "Sprekk"); }),
            "/dev/zero: is a device, pipe or socket, expected an XML file");
  const std::string path = fmt::format("{}/sprekk_xml_test_{}.xml", testing::TempDir(), comm->getSize());
  if (comm->getRank() == 0) {
    std::ofstream file(path);
    std::filesystem::resize_file(path, std::uintmax_t(1) << 40);
  }
  EXPECT_EQ(message_of([&] { read_xml(*comm, path, "Sprekk"); }),
            path + ": has 1099511627776 bytes; an XML file may have 67108864");
  if (comm->getRank() == 0) std::remove(path.c_str());
}

ParameterList overridden(const std::string& text) {
  ParameterList list("Sprekk");
  list.sublist("Time").set("end", 2.0).set("steps", 5).set("scheme", "1").set("start", "3 h");
  list.sublist("Time").sublist("Adaptive steps").set("max. growth", 2.0);
  list.set("vector", array<double>({1, 2})).set("names", array<std::string>({"a"})).set("flag", true);
  apply_override(list, text);
  return list;
}

TEST(Override, keeps_the_type_of_the_entry) {
  EXPECT_EQ(overridden("Time.end=3").sublist("Time").get<double>("end"), 3.0);
  EXPECT_EQ(overridden("Time.steps = 7").sublist("Time").get<int>("steps"), 7);
  EXPECT_EQ(overridden("Time.scheme=2").sublist("Time").get<std::string>("scheme"), "2");
  EXPECT_EQ(overridden("vector={3, 4}").get<Array<double>>("vector"), array<double>({3, 4}));
  EXPECT_EQ(overridden("names={3, 4}").get<Array<std::string>>("names"), array<std::string>({"3", "4"}));
  EXPECT_EQ(overridden("flag=false").get<bool>("flag"), false);
  EXPECT_EQ(overridden("Time.Adaptive steps.max. growth=4")
                .sublist("Time")
                .sublist("Adaptive steps")
                .get<double>("max. growth"),
            4.0);
}

/// A number replaces a text with a unit ("5 s"); a text that is not a number stays a text.
TEST(Override, puts_a_number_in_place_of_a_text_with_a_unit) {
  EXPECT_EQ(overridden("Time.start=7").sublist("Time").get<int>("start"), 7);
  EXPECT_EQ(overridden("Time.start=7.5").sublist("Time").get<double>("start"), 7.5);
  EXPECT_EQ(overridden("Time.start=2*t").sublist("Time").get<std::string>("start"), "2*t");
}

TEST(Override, guesses_the_type_of_what_is_new) {
  EXPECT_EQ(overridden("a=1").get<int>("a"), 1);
  EXPECT_EQ(overridden("a=5000000000").get<double>("a"), 5e9);
  EXPECT_EQ(overridden("a=1e3").get<double>("a"), 1000.0);
  EXPECT_EQ(overridden("a=true").get<bool>("a"), true);
  EXPECT_EQ(overridden("a={1, 2}").get<Array<int>>("a"), array<int>({1, 2}));
  EXPECT_EQ(overridden("a={1, 2.5}").get<Array<double>>("a"), array<double>({1, 2.5}));
  EXPECT_EQ(overridden("a={1, max(x, t)}").get<Array<std::string>>("a"), array<std::string>({"1", "max(x, t)"}));
  EXPECT_EQ(overridden("New one.Inner.a b=x == 1").sublist("New one").sublist("Inner").get<std::string>("a b"),
            "x == 1");
  EXPECT_EQ(overridden("a=").get<std::string>("a"), "");
  EXPECT_EQ(overridden("Time.end=2*t").sublist("Time").get<std::string>("end"), "2*t");
}

TEST(Override, refuses_what_has_no_place) {
  const auto refusal = [](const std::string& text) { return message_of([&] { overridden(text); }); };
  EXPECT_CONTAINS(refusal("Time.end"), "override \"Time.end\": has no \"=\"");
  EXPECT_CONTAINS(refusal("=3"), "has an empty name");
  EXPECT_CONTAINS(refusal("Time.=3"), "has an empty name");
  EXPECT_CONTAINS(refusal("Time..end=3"), "has an empty name");
  EXPECT_CONTAINS(refusal("Time=3"), "\"Time\" is a section");
  EXPECT_CONTAINS(refusal("Time.end.x=3"), "\"end\" is not a section");
}

}  // namespace
}  // namespace sprekk::base
