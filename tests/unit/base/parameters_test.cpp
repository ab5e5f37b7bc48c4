#include "base/parameters.hpp"

#include <algorithm>
#include <cmath>

#include "array.hpp"
#include "base/value.hpp"
#include "base/xml.hpp"
#include "message.hpp"

namespace sprekk::base {
namespace {

using Teuchos::Array;
using Teuchos::ParameterList;

struct JointMaterial {
  double friction_coefficient = 0.6;
  double tangential_stiffness;
  std::optional<double> friction_angle;
  void describe(Section& s) {
    s.entry(friction_coefficient, "friction coefficient", "-", at_least(0.0), "Coulomb friction coefficient mu");
    s.required(tangential_stiffness, "tangential stiffness", "Pa/m", positive_or_infinite(), "K_t of the elastic part");
    s.entry(friction_angle, "friction angle", "degree", between(0.0, 90.0), "angle whose tangent is mu");
  }
};

struct Mesh {
  std::string type = "box";
  std::vector<int> cells = {4, 4};
  std::vector<double> size = {1, 1};
  bool simplices = false;
  void describe(Section& s) {
    s.choice(type, "type", {"box", "file"}, "where the mesh comes from");
    s.entry(cells, "cells", "-", positive().size(2), "cells along x, y");
    s.entry(size, "size", "m", positive(), "edges");
    s.entry(simplices, "simplices", "-", "cut a|b into simplices");
    if (s.complete() && cells.size() != size.size()) s.fail("size", "must be as long as \"cells\"");
  }
};

struct Output {
  std::vector<std::string> fields;
  void describe(Section& s) { s.entry(fields, "fields", "-", "fields to write"); }
};

struct Time {
  double end = 1;
  int steps = 10;
  long long seed = 5;
  void describe(Section& s) {
    s.entry(end, "end", "s", positive(), "time at which the run ends");
    s.entry(steps, "steps", "-", at_least(1), "number of steps");
    s.entry(seed, "seed", "-", "seed of random numbers");
    if (s.complete() && end < 1e-3 * steps) s.fail("steps are too many for this end");
  }
};

struct Load {
  double magnitude;
  void describe(Section& s) { s.required(magnitude, "magnitude", "Pa", "size of the load"); }
};

struct Loads {
  Load load;
  void describe(Section& s) { s.section(load, "Load", "the only one"); }
};

struct Scene {
  Mesh mesh;
  Time time;
  std::map<std::string, JointMaterial> materials;
  std::map<std::string, Table> tables;
  std::optional<Output> output;
  ParameterList muelu;
  std::string solver = "auto";
  std::vector<Expression> displacement;
  Expression pressure = 2.5;
  void describe(Section& s) {
    s.section(mesh, "Mesh", "the mesh");
    s.section(time, "Time", "time steps");
    s.named_sections(materials, "Materials", "one section per material");
    s.named_sections(tables, "Tables", "functions of one argument");
    s.section(output, "Output", "what is written");
    s.passthrough(muelu, "MueLu", "handed to MueLu untouched");
    s.choice(solver, "solver", {"auto", "direct", "iterative"}, "linear solver");
    s.entry(displacement, "displacement", "m", any(), "prescribed components");
    s.entry(pressure, "pressure", "Pa", at_least(0), "on the faces");
  }
};

ParameterList complete_scene() {
  ParameterList list("Sprekk");
  list.set("solver", "direct");
  list.set("pressure", "1e5*t");
  list.set("displacement", array<std::string>({"0", "-0.1*ramp(t)"}));
  list.sublist("Mesh").set("cells", array<int>({3, 2})).set("size", array<int>({6, 1}));
  list.sublist("Time").set("end", 2).set("seed", 12345678901234LL);
  list.sublist("Materials").sublist("joint").set("tangential stiffness", "infinite").set("friction angle", 0.1);
  list.sublist("Materials").sublist("fault").set("tangential stiffness", 1.0 / 3.0);
  list.sublist("Tables").sublist("ramp").set("arguments", array<double>({0, 1})).set("values", array<int>({0, 1}));
  list.sublist("Output").set("fields", array<std::string>({"jump"}));
  list.sublist("MueLu").set("coarse: max size", 100).sublist("smoother: params").set("sweeps", 2);
  return list;
}

std::string errors_of(const ParameterList& list) {
  return message_of([&] { read<Scene>(list, "xml/slip.xml", "Sprekk"); });
}

/// Returns the errors of a valid scene after setting one entry of the section at `path`.
template <class T>
std::string errors_with(const std::vector<std::string>& path, const std::string& name, const T& value) {
  ParameterList list = complete_scene();
  ParameterList* section = &list;
  for (const auto& part : path) section = &section->sublist(part);
  section->set(name, value);
  return errors_of(list);
}

TEST(Parameters, long_lists_of_errors_end_with_a_count) {
  const auto message = [](std::size_t n) {
    return message_of([&] { throw_errors(std::vector<std::string>(n, "x")); });
  };
  EXPECT_NO_THROW(throw_errors({}));
  EXPECT_EQ(message(2), "x\nx");
  const auto text = message(500);
  EXPECT_EQ(std::count(text.begin(), text.end(), 'x'), 20);
  EXPECT_NE(text.find("\nand 480 more errors"), text.npos);
}

TEST(Parameters, are_read_into_their_targets) {
  auto scene = read<Scene>(complete_scene(), "xml/slip.xml", "Sprekk");
  EXPECT_EQ(scene.solver, "direct");
  EXPECT_EQ(scene.mesh.type, "box");
  EXPECT_EQ(scene.mesh.cells, (std::vector<int>{3, 2}));
  EXPECT_EQ(scene.mesh.size, (std::vector<double>{6, 1}));
  EXPECT_EQ(scene.time.end, 2.0);
  EXPECT_EQ(scene.time.steps, 10);
  EXPECT_EQ(scene.time.seed, 12345678901234LL);
  ASSERT_EQ(scene.materials.size(), 2u);
  EXPECT_TRUE(std::isinf(scene.materials["joint"].tangential_stiffness));
  EXPECT_EQ(scene.materials["joint"].friction_angle, 0.1);
  EXPECT_EQ(scene.materials["fault"].friction_coefficient, 0.6);
  EXPECT_EQ(scene.materials["fault"].friction_angle, std::nullopt);
  ASSERT_TRUE(scene.output);
  EXPECT_EQ(scene.output->fields, std::vector<std::string>{"jump"});
  EXPECT_EQ(scene.muelu.sublist("smoother: params").get<int>("sweeps"), 2);
  ASSERT_EQ(scene.displacement.size(), 2u);
  scene.displacement[1].compile(std::make_shared<Tables>(scene.tables));
  EXPECT_DOUBLE_EQ(scene.displacement[1]({}, 0.5), -0.05);
}

TEST(Parameters, keep_their_defaults_when_absent) {
  const auto scene = read<Scene>(ParameterList(), "f", "Sprekk");
  EXPECT_EQ(scene.solver, "auto");
  EXPECT_EQ(scene.pressure({}, 0), 2.5);
  EXPECT_EQ(scene.mesh.cells, (std::vector<int>{4, 4}));
  EXPECT_FALSE(scene.output);
  EXPECT_TRUE(scene.materials.empty());
}

TEST(Parameters, unknown_names_get_the_nearest_name_or_all) {
  EXPECT_EQ(errors_with({"Materials", "joint"}, "friction coeficient", 0.5),
            "xml/slip.xml: Sprekk > Materials > joint > \"friction coeficient\": unknown. "
            "Did you mean \"friction coefficient\"?");
  EXPECT_EQ(errors_with({"Time"}, "dilatancy", 0.5),
            "xml/slip.xml: Sprekk > Time > \"dilatancy\": unknown; allowed are \"end\", \"steps\", \"seed\"");
  EXPECT_EQ(errors_with({}, "Mehs", ParameterList()),
            "xml/slip.xml: Sprekk > \"Mehs\": unknown. Did you mean \"Mesh\"?");
  EXPECT_EQ(errors_with({"Mesh", "Inner"}, "a", 1).substr(0, 46), "xml/slip.xml: Sprekk > Mesh > \"Inner\": unknown");
}

TEST(Parameters, values_of_the_wrong_type_are_refused) {
  EXPECT_EQ(errors_with({"Time"}, "end", "soon"),
            "xml/slip.xml: Sprekk > Time > \"end\": is the string \"soon\", expected a number, e.g. type=\"double\"");
  EXPECT_CONTAINS(errors_with({"Time"}, "end", true), "is the boolean true, expected a number");
  EXPECT_CONTAINS(errors_with({"Time"}, "end", array<double>({1, 2})), "is the array {1, 2}, expected a number");
  EXPECT_CONTAINS(errors_with({"Time"}, "steps", 2.0), "is the number 2, expected an integer");
  EXPECT_CONTAINS(errors_with({"Time"}, "steps", 5000000000LL), "is 5000000000, too large for an int");
  EXPECT_CONTAINS(errors_with({"Time"}, "end", 1.0f), "is of type float, expected a number");
  EXPECT_CONTAINS(errors_with({"Mesh"}, "simplices", 1), "is the integer 1, expected true or false");
  EXPECT_CONTAINS(errors_with({"Mesh"}, "type", 1), "is the integer 1, expected a text");
  EXPECT_CONTAINS(errors_with({"Mesh"}, "cells", array<double>({1, 2})), "is the array {1, 2}, expected integers");
  EXPECT_CONTAINS(errors_with({"Mesh"}, "size", 1.0), "is the number 1, expected numbers");
  EXPECT_CONTAINS(errors_with({"Output"}, "fields", "jump"), "is the string \"jump\", expected texts");
  EXPECT_CONTAINS(errors_with({}, "displacement", "0"), "is the string \"0\", expected numbers or expressions");
  EXPECT_CONTAINS(errors_with({}, "pressure", false), "is the boolean false, expected a number or an expression");
}

TEST(Parameters, sections_and_entries_are_not_mixed_up) {
  EXPECT_EQ(errors_with({"Time", "steps"}, "a", 1),
            "xml/slip.xml: Sprekk > Time > \"steps\": is a section, expected an integer, e.g. type=\"int\"");
  ParameterList list("Sprekk");
  list.set("Mesh", 1).set("Materials", "a").set("Output", 2.0).set("MueLu", false);
  const std::string errors = errors_of(list);
  EXPECT_CONTAINS(errors,
                  "Sprekk > \"Mesh\": is the integer 1, expected a section, e.g. <ParameterList name=\"Mesh\">");
  EXPECT_CONTAINS(errors, "Sprekk > \"Materials\": is the string \"a\", expected a section");
  EXPECT_CONTAINS(errors, "Sprekk > \"Output\": is the number 2, expected a section");
  EXPECT_CONTAINS(errors, "Sprekk > \"MueLu\": is the boolean false, expected a section");
  EXPECT_EQ(std::count(errors.begin(), errors.end(), '\n'), 3);
  EXPECT_EQ(errors_with({"Materials"}, "rock", 1),
            "xml/slip.xml: Sprekk > Materials > \"rock\": is the integer 1, expected a section, e.g. "
            "<ParameterList name=\"rock\">");
}

TEST(Parameters, values_out_of_bounds_are_refused) {
  EXPECT_EQ(errors_with({"Materials", "joint"}, "friction coefficient", -1.0),
            "xml/slip.xml: Sprekk > Materials > joint > \"friction coefficient\": is -1, must be at least 0");
  EXPECT_CONTAINS(errors_with({"Materials", "joint"}, "friction angle", 91), "is 91, must be between 0 and 90");
  EXPECT_CONTAINS(errors_with({"Materials", "joint"}, "tangential stiffness", 0), "is 0, must be positive or infinite");
  EXPECT_CONTAINS(errors_with({"Materials", "joint"}, "friction coefficient", double(NAN)),
                  "is nan, must be at least 0");
  EXPECT_CONTAINS(errors_with({"Materials", "joint"}, "friction coefficient", double(INFINITY)),
                  "is infinite, must be at least");
  EXPECT_CONTAINS(errors_with({"Materials", "joint"}, "tangential stiffness", -double(INFINITY)),
                  "is -infinite, must be positive");
  EXPECT_CONTAINS(errors_with({"Time"}, "end", "infinite"), "is infinite, must be positive");
  EXPECT_CONTAINS(errors_with({"Time"}, "steps", 0), "is 0, must be at least 1");
  EXPECT_EQ(errors_with({"Mesh"}, "size", array<double>({1, -2})),
            "xml/slip.xml: Sprekk > Mesh > \"size\"[1]: is -2, must be positive (unit: m)");
  EXPECT_EQ(errors_with({"Mesh"}, "cells", array<int>({1, 2, 3})),
            "xml/slip.xml: Sprekk > Mesh > \"cells\": has 3 elements, must have 2 elements");
  EXPECT_CONTAINS(errors_with({}, "pressure", -5), "\"pressure\": is -5, must be at least 0");
  EXPECT_CONTAINS(errors_with({}, "pressure", "-5"), "\"pressure\": is -5, must be at least 0");
  EXPECT_CONTAINS(errors_with({}, "displacement", array<std::string>({"1", "infinite"})),
                  "\"displacement\"[1]: is infinite");
  EXPECT_CONTAINS(errors_with({}, "displacement", array<std::string>({"", "1"})), "\"displacement\"[0]: is empty");
  EXPECT_EQ(errors_with({}, "solver", "directt"),
            "xml/slip.xml: Sprekk > \"solver\": is \"directt\", must be one of \"auto\", \"direct\", \"iterative\". "
            "Did you mean \"direct\"?");
}

TEST(Parameters, required_ones_must_be_there) {
  ParameterList list("Sprekk");
  list.sublist("Materials").sublist("joint");
  EXPECT_EQ(errors_of(list),
            "xml/slip.xml: Sprekk > Materials > joint > \"tangential stiffness\" (Pa/m): missing; "
            "it is required: K_t of the elastic part");
}

TEST(Parameters, required_ones_are_missing_in_a_section_that_is_missing) {
  const auto errors = [](const ParameterList& list) { return message_of([&] { read<Loads>(list, "f", "R"); }); };
  ParameterList list;
  EXPECT_EQ(errors(list), "f: R > Load > \"magnitude\" (Pa): missing; it is required: size of the load");
  list.set("Load", 3);
  EXPECT_EQ(errors(list), "f: R > \"Load\": is the integer 3, expected a section, e.g. <ParameterList name=\"Load\">");
}

TEST(Parameters, contradictions_are_reported_by_describe) {
  EXPECT_EQ(errors_with({"Mesh"}, "size", array<double>({1, 2, 3})),
            "xml/slip.xml: Sprekk > Mesh > \"size\": must be as long as \"cells\"");
  EXPECT_EQ(errors_with({"Time"}, "steps", 3000), "xml/slip.xml: Sprekk > Time: steps are too many for this end");
  EXPECT_EQ(errors_with({"Tables", "ramp"}, "values", array<double>({1})),
            "xml/slip.xml: Sprekk > Tables > ramp: has 2 arguments but 1 value");
}

TEST(Parameters, all_errors_are_reported_at_once) {
  ParameterList list("Sprekk");
  list.set("solvr", "direct");
  list.sublist("Time").set("end", -1).set("steps", "many");
  list.sublist("Materials").sublist("joint").set("friction angle", 100);
  const std::string errors = errors_of(list);
  EXPECT_EQ(std::count(errors.begin(), errors.end(), '\n'), 4) << errors;
  for (const char* part : {"\"end\": is -1", "\"steps\": is the string", "\"tangential stiffness\" (Pa/m): missing",
                           "\"friction angle\": is 100", "\"solvr\": unknown"})
    EXPECT_CONTAINS(errors, part);
}

struct Loaded {
  Tables tables;
  Expression::Named expressions;
  Expression force = 1;
  std::vector<Expression> moved;
  ParameterList solver;
  void describe(Section& s) {
    s.named_sections(tables, "Tables", "functions");
    s.named_expressions(expressions, "Expressions", "by name");
    s.expressions_call(tables, expressions);
    s.required(force, "force", "N", positive(), "on the top");
    s.entry(moved, "moved", "m", any().or_word("free"), "of the side");
    s.passthrough(solver, "solver", "as it is");
  }
};

TEST(Parameters, expressions_are_compiled_with_the_tables) {
  ParameterList list;
  list.set("force", "2*f(t)").set("moved", array<std::string>({"free", "x"}));
  list.sublist("Tables").sublist("f").set("arguments", array<double>({0, 1})).set("values", array<int>({0, 4}));
  const auto loaded = read<Loaded>(list, "f", "R");
  EXPECT_EQ(loaded.force({}, 0.25), 2);
  EXPECT_EQ(loaded.moved[0].text(), "free");
  EXPECT_EQ(loaded.moved[1]({7, 0, 0}, 0), 7);
}

TEST(Parameters, expressions_call_each_other_by_name) {
  ParameterList list;
  list.set("force", "2*twice").set("moved", array<std::string>({"free", "limit"}));
  list.sublist("Expressions").set("twice", "2*once + f(0.25)").set("once", "x + t").set("limit", 3).set("unused", "y");
  list.sublist("Tables").sublist("f").set("arguments", array<double>({0, 1})).set("values", array<int>({0, 4}));
  auto loaded = read<Loaded>(list, "f", "R");
  EXPECT_EQ(loaded.force({7, 0, 0}, 1), 2 * (2 * 8 + 1));
  EXPECT_TRUE(loaded.moved[1].is_constant());
  EXPECT_EQ(loaded.moved[1]({}, 0), 3);
  const auto again = read<Loaded>(effective(loaded, "R"), "f", "R");  // the echo
  EXPECT_EQ(again.force({7, 0, 0}, 1), 2 * (2 * 8 + 1));
  EXPECT_EQ(again.expressions.size(), 4u);
}

TEST(Parameters, named_expressions_that_are_wrong_are_reported_once) {
  ParameterList list;
  list.set("force", "a + b + wrong + sin").set("moved", array<std::string>({"free"}));
  auto& named = list.sublist("Expressions");
  named.set("a", "1 + b").set("b", "c*2").set("c", "a").set("self", "self + 1").set("after", "a + wrong");
  named.set("wrong", "x + q").set("sin", "x").set("two words", "x").set("f", "x").set("unit", "3 m");
  list.sublist("Tables").sublist("f").set("arguments", array<double>({0, 1})).set("values", array<int>({0, 4}));
  const std::string errors = message_of([&] { read<Loaded>(list, "f", "R"); });
  for (const char* part :
       {"Expressions > \"a\": in \"1 + b\": calls itself: \"a\" calls \"b\" calls \"c\" calls \"a\"",
        "Expressions > \"self\": in \"self + 1\": calls itself: \"self\" calls \"self\"",
        "Expressions > \"wrong\": in \"x + q\": unknown name \"q\" at position 4",
        "Expressions > \"sin\": an expression must not be named \"sin\"",
        "Expressions > \"two words\": an expression \"two words\": a name must consist of letters",
        "Expressions > \"f\": is the name of a table, too", "Expressions > \"unit\": is \"3 m\", has the unit \"m\"",
        "\"force\": in \"a + b + wrong + sin\""})
    EXPECT_CONTAINS(errors, part);
  EXPECT_EQ(std::count(errors.begin(), errors.end(), '\n'), 7) << errors;
}

TEST(Parameters, all_expressions_that_are_wrong_are_reported_and_no_follow_ups) {
  ParameterList list;
  list.set("force", "2*f(t) +").set("moved", array<std::string>({"fre", "ramp(x)", "g(t)", "free", "hh(t)"}));
  list.sublist("solver").set("a", Unreadable{"f: R > solver > \"a\": is broken"});
  auto& tables = list.sublist("Tables");
  tables.sublist("ramp").set("arguments", array<double>({0, 1})).set("values", array<double>({0}));
  tables.sublist("f").set("arguments", array<double>({0, 1})).set("values", array<int>({0, 4}));
  tables.sublist("g").set("arguments", Unreadable{"f: R > Tables > g > \"arguments\": is broken"});
  tables.sublist("sin").set("arguments", array<double>({0, 1})).set("values", array<int>({0, 4}));
  const std::string errors = message_of([&] { read<Loaded>(list, "f", "R", {"known before"}); });
  EXPECT_EQ(errors.substr(0, 13), "known before\n");
  for (const char* part : {"Tables > ramp: has 2 arguments but 1 value", "Tables > g > \"arguments\": is broken",
                           "Tables > g > \"values\": missing", "must not be named \"sin\"",
                           "\"force\": in \"2*f(t) +\"", "\"moved\"[0]: in \"fre\": unknown name",
                           "\"moved\"[4]: in \"hh(t)\": unknown name", "solver > \"a\": is broken"})
    EXPECT_CONTAINS(errors, part);
  EXPECT_EQ(std::count(errors.begin(), errors.end(), '\n'), 8) << errors;
}

TEST(Parameters, expressions_remember_where_they_stand) {
  auto scene = read<Scene>(complete_scene(), "xml/slip.xml", "Sprekk");
  EXPECT_CONTAINS(message_of([&] { scene.displacement[1].compile(); }),
                  "xml/slip.xml: Sprekk > \"displacement\"[1]: in");
}

TEST(Parameters, the_echo_is_complete_and_reads_back) {
  auto scene = read<Scene>(complete_scene(), "xml/slip.xml", "Sprekk");
  const ParameterList echo = effective(scene, "Sprekk");
  EXPECT_EQ(echo.name(), "Sprekk");
  EXPECT_EQ(echo.sublist("Materials").sublist("fault").get<double>("friction coefficient"), 0.6);
  EXPECT_EQ(echo.sublist("Time").get<int>("steps"), 10);
  EXPECT_FALSE(echo.sublist("Materials").sublist("fault").isParameter("friction angle"));
  const std::string text = to_xml(echo);
  auto again = read<Scene>(parse_xml(text, "echo.xml", "Sprekk"), "echo.xml", "Sprekk");
  EXPECT_EQ(to_xml(effective(again, "Sprekk")), text);
  EXPECT_EQ(again.materials["fault"].tangential_stiffness, 1.0 / 3.0);
  EXPECT_TRUE(std::isinf(again.materials["joint"].tangential_stiffness));
  EXPECT_EQ(again.displacement[1].text(), "-0.1*ramp(t)");
  Scene fresh;
  auto reread = read<Scene>(effective(fresh, "Sprekk"), "f", "Sprekk");
  EXPECT_EQ(to_xml(effective(reread, "Sprekk")), to_xml(effective(fresh, "Sprekk")));
  EXPECT_FALSE(reread.output);
}

struct Checked {
  struct Part {
    Real width = 1;
    int n_calls = 0;  ///< no entry
    void describe(Section& s) { s.entry(width, "width", "m", positive(), ""); }
  };
  std::map<std::string, Part> parts;
  std::optional<Part> other;
  Expression load = 0;
  std::string kind = "a";
  Tables tables;
  Expression::Named named;
  void describe(Section& s) {
    s.named_expressions(named, "Expressions", "");
    s.expressions_call(tables, named);
    s.named_sections(parts, "parts", "");
    s.section(other, "other", "");
    s.entry(load, "load", "Pa", "");
    s.choice(kind, "kind", {"a", "b"}, "");
  }
};

TEST(Parameters, a_struct_is_checked_in_place) {
  Checked given;
  given.parts["one"].n_calls = 7;
  given.named["twice"] = Expression("2*t");
  given.load = Expression("twice + 1");
  const auto good = checked(given, "f", "R");
  EXPECT_TRUE(good.report.errors.empty());
  EXPECT_EQ(good.value.parts.at("one").n_calls, 7);  // a member that is no entry
  EXPECT_EQ(good.value.load({}, 3), 7);              // compiled
  given.parts["two"].width = -1;
  given.other.emplace().width = 0;
  given.load = Expression("thrice + 1");
  given.kind = "c";
  const auto bad = checked(given, "f", "R");
  ASSERT_EQ(bad.report.errors.size(), 4u);
  EXPECT_CONTAINS(bad.report.errors[0], "f: R > parts > two > \"width\": is -1, must be positive");
  EXPECT_CONTAINS(bad.report.errors[1], "f: R > other > \"width\": is 0, must be positive");
  EXPECT_CONTAINS(bad.report.errors[2], "f: R > \"load\": in \"thrice + 1\": unknown name");
  EXPECT_CONTAINS(bad.report.errors[3], "f: R > \"kind\": is \"c\", must be one of \"a\"");
  EXPECT_FALSE(bad.report.is_sound("R > parts > two"));
  EXPECT_TRUE(bad.report.is_sound("R > parts > one"));
}

TEST(Parameters, the_reference_names_everything) {
  const std::string text = to_markdown(specification<Scene>("Sprekk"), "Sprekk");
  for (const char* part :
       {"## Sprekk > Materials > NAME\n\none section per material\n\n| name | type | unit | default | allowed | "
        "meaning |",
        "| friction coefficient | double | - | 0.6 | at least 0 | Coulomb friction coefficient mu |",
        "| tangential stiffness | double | Pa/m | required | positive or infinite | K_t of the elastic part |",
        "| friction angle | double | degree | absent | between 0 and 90 | angle whose tangent is mu |",
        "| solver | string | - | auto | \"auto\", \"direct\", \"iterative\" | linear solver |",
        "| cells | Array(int) | - | {4, 4} | positive, 2 elements | cells along x, y |",
        "| simplices | bool | - | false | any | cut a\\|b into simplices |", "## Sprekk > Output\n\nwhat is written",
        "| MueLu | section |", "| pressure | double or expression (string) | Pa | 2.5 | at least 0 | on the faces |"})
    EXPECT_CONTAINS(text, part);
}

TEST(Bounds, say_what_they_allow) {
  EXPECT_EQ(any().text(), "finite");
  EXPECT_EQ(any().or_infinite().text(), "finite or infinite");
  EXPECT_EQ(greater_than(-1).below(2).text(), "greater than -1 and less than 2");
  EXPECT_EQ(positive().to(1).text(), "positive and at most 1");
  EXPECT_EQ(Bounds().to(3).text(), "at most 3");
  EXPECT_TRUE(Bounds().below(1).contains(0.999) && !Bounds().below(1).contains(1) && Bounds().to(1).contains(1));
  EXPECT_TRUE(!positive().contains(0) && at_least(0).contains(0) && !at_least(0).contains(-1e-300));
  EXPECT_TRUE(!any().contains(NAN) && !any().contains(INFINITY) && !any().or_infinite().contains(-INFINITY));
  EXPECT_TRUE(positive_or_infinite().contains(INFINITY) && !positive_or_infinite().contains(NAN));
}

}  // namespace
}  // namespace sprekk::base
