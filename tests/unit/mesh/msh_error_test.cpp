#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>

#include "msh_meshes.hpp"

namespace sprekk::mesh::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string refusal(const std::string& text, const MshOptions& options = fractures(1)) {
  return error_of([&] { parse_msh(text, "a.msh", options); });
}

struct Change {
  const char *from, *to;
  std::vector<const char*> message;  ///< parts of the message
};

void expect_refusals(const std::string& text, const std::vector<Change>& changes) {
  for (const auto& change : changes) {
    const auto message = refusal(replaced(text, change.from, change.to));
    EXPECT_THAT(message, HasSubstr("a.msh: ")) << change.from << " -> " << change.to;
    for (const char* part : change.message) EXPECT_THAT(message, HasSubstr(part)) << change.from << " -> " << change.to;
  }
}

/// Returns `two_squares` with the given lines in the section $Fractures.
std::string reported(const std::string& lines) {
  return replaced(two_squares, "$Nodes", "$Fractures\n" + lines + "$EndFractures\n$Nodes");
}

TEST(MshError, Fractures) {
  EXPECT_THAT(refusal(reported("1\n1 1\n")), HasSubstr("$Fractures, line 12: fracture 1: has 0 texts in quotes"));
  EXPECT_THAT(refusal(reported("1\n1 1 \"a\" \"friction\"\n")), HasSubstr("fracture 1: has 2 texts in quotes"));
  EXPECT_THAT(refusal(reported("1\n1 1 \"a\n")), HasSubstr("lacks a quotation mark"));
  EXPECT_THAT(refusal(reported("1\n1 x \"a\"\n")), HasSubstr("the number of an entity is \"x\""));
  EXPECT_THAT(refusal(reported("2\n1 1 \"a\"\n")), HasSubstr("must be an integer"));
  EXPECT_THAT(refusal(reported("2\n1 1 \"a\" \"mu\" \"1\"\n1 2 \"a\" \"mu\" \"2\"\n")),
              HasSubstr("\"a\" occurs twice with different entries"));
  auto both = fractures(1);
  both.fractures["west"];
  EXPECT_THAT(refusal(reported("2\n1 1 \"a\"\n2 2 \"a\"\n"), both),
              HasSubstr("\"a\" is in the sets \"f1\" and \"west\""));
  EXPECT_THAT(refusal(reported("1\n1 7 \"a\"\n")),
              HasSubstr("element 20: its entity 1 is no fracture of the set \"f1\""));
}

TEST(MshError, Files) {
  EXPECT_THAT(error_of([] { read_msh("no/such.msh"); }), HasSubstr("no/such.msh: there is no such file"));
  EXPECT_THAT(error_of([] { read_msh(tests::source_dir()); }), HasSubstr("is a folder"));
  EXPECT_THAT(refusal(""), HasSubstr("is empty"));
  EXPECT_THAT(refusal(" \n\n"), HasSubstr("is empty"));
  EXPECT_THAT(refusal("solid cube\n"), HasSubstr("line 1: found \"solid cube\""));
  EXPECT_THAT(refusal("$Nodes\n"), HasSubstr("expected $MeshFormat"));
  EXPECT_THAT(refusal("$NOD\n1\n"), HasSubstr("format 1"));
  EXPECT_THAT(refusal("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"), HasSubstr("has no nodes"));
}

TEST(MshError, TruncatedAnywhere) {
  for (const auto& text :
       {two_squares, two_squares_4, content_of("x_order1_v22_binary"), content_of("x_order1_v41_binary")}) {
    const auto end = text.rfind("$EndElements") + 12;
    for (std::size_t n = 0; n < end; ++n)
      EXPECT_THAT(refusal(text.substr(0, n), fractures(1)), HasSubstr("a.msh: ")) << n;
  }
}

TEST(MshError, Format) {
  expect_refusals(two_squares, {{"2.2 0 8", "4.0 0 8", {"$MeshFormat, line 2", "format 4.0", "2.2 and 4.1"}},
                                {"2.2 0 8", "3 0 8", {"format 3"}},
                                {"2.2 0 8", "1.0 0 8", {"format 1.0"}},
                                {"2.2 0 8", "2.2 0 4", {"2.2 0 4"}},
                                {"$EndMeshFormat", "$EndFormat", {"line 3", "expected $EndMeshFormat"}},
                                {"$Nodes", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes", {"occurs twice"}},
                                {"$EndNodes", "7 0 0 0\n$EndNodes", {"expected $EndNodes"}}});
  for (const char* name : {"x_order1_v22_binary", "x_order1_v41_binary"})
    EXPECT_THAT(refusal(replaced(content_of(name), std::string("\1\0\0\0", 4), std::string("\0\0\0\1", 4))),
                HasSubstr("another order of bytes"));
}

TEST(MshError, Numbers) {
  expect_refusals(two_squares, {{"6\n1 0 0 0", "-6\n1 0 0 0", {"$Nodes, line 11", "number of nodes is -6"}},
                                {"6\n1 0 0 0", "9223372036854775807\n1 0 0 0", {"cannot hold"}},
                                {"6\n1 0 0 0", "99999999999999999999\n1 0 0 0", {"must be an integer"}},
                                {"6\n1 0 0 0", "6.5\n1 0 0 0", {"\"6.5\", must be an integer"}},
                                {"\n5 1 1 0", "\n5 nan 1 0", {"$Nodes, line 16: node 5: x is \"nan\""}},
                                {"\n5 1 1 0", "\n5 1 inf 0", {"node 5: y is \"inf\""}},
                                {"\n5 1 1 0", "\n5 1 1,0 0", {"node 5: y is \"1,0\""}},
                                {"\n5 1 1 0", "\n5 1 1e200 0", {"node 5: y is 1e+200"}},
                                {"\n5 1 1 0", "\n4 1 1 0", {"node 4 occurs twice"}},
                                {"\n5 1 1 0", "\n-5 1 1 0", {"number of a node is -5"}},
                                {"\n4\n20 1", "\n4\n0 1", {"number of an element is 0"}},
                                {"\n4\n20 1", "\n1000\n20 1", {"$Elements, line 20", "number of elements is 1000"}},
                                {"1 1 2 5 4", "1 1 2 7 4", {"element 10 has node 7, which is not in $Nodes"}},
                                {"10 3 2 3 1", "10 3 -2 3 1", {"number of tags of an element is -2"}},
                                {"3\n1 1 \"f1\"", "3\n9 1 \"f1\"", {"physical group 1 of dimension 9"}},
                                {"\"f1\"", "f1", {"expected a name in quotes"}}});
  expect_refusals(two_squares_4, {{"0 2 1 0\n1 1", "0 2 1 100\n1 1", {"$Entities", "number of entities is 100"}},
                                  {"2 7 0 6\n", "2 7 0 7\n", {"$Nodes"}},
                                  {"1 6 1 6\n", "1 5 1 6\n", {"has 6 nodes although it announces 5"}},
                                  {"3 4 10 21", "3 5 10 21", {"has 4 elements although it announces 5"}},
                                  {"2 7 3 2\n", "2 8 3 2\n", {"entity 8 of dimension 2", "partitions"}},
                                  {"2 7 3 2\n", "1 1 3 2\n", {"in an entity of dimension 1"}}});
}

TEST(MshError, Elements) {
  expect_refusals(two_squares,
                  {{"10 3 2 3 1", "10 16 2 3 1", {"element 10: is a 8-node quadrilateral", "order 2 with"}},
                   {"10 3 2 3 1", "10 17 2 3 1", {"20-node hexahedron"}},
                   {"10 3 2 3 1", "10 6 2 3 1", {"6-node prism"}},
                   {"10 3 2 3 1", "10 7 2 3 1", {"5-node pyramid"}},
                   {"10 3 2 3 1", "10 26 2 3 1", {"4-node line"}},
                   {"10 3 2 3 1", "10 77 2 3 1", {"type 77"}},
                   {"10 3 2 3 1 1 2 5 4", "10 2 2 3 1 1 2 5", {"3-node triangle", "4-node quad", "one shape"}},
                   {"11 3 2 3 1", "11 3 2 0 1", {"element 11 is in no physical group"}},
                   {"10 3 2 3 1 1 2 5 4", "10 3 2 3 1 1 2 2 4", {"element 10 has node 2 twice"}},
                   {"\n4 0 1 0", "\n4 0.5 0 0", {"element 10 at (0, 0, 0) is twisted or not convex"}},
                   {"\n4 0 1 0\n5 1 1 0", "\n4 3 0 0\n5 4 0 0", {"element 10 at (0, 0, 0) has no volume"}},
                   {"10 3 2 3 1 1 2 5 4", "10 3 2 3 1 1 5 2 4", {"element 10", "twisted"}},
                   {"\n5 1 1 0", "\n5 1 1 0.1", {"z from 0 to 0.1"}}});
  EXPECT_THAT(
      refusal("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n2\n1 0 0 0\n2 1 0 0\n$EndNodes\n$Elements\n1\n1 1 0 1 "
              "2\n$EndElements\n"),
      HasSubstr("elements of dimension 1 at most"));
  EXPECT_EQ(refusal(replaced(two_squares_4, "7 0 0 0 2 1 0 1 3 0", "7 0 0 0 2 1 0 2 3 4 0")), "");
}

TEST(MshError, Conformity) {
  expect_refusals(two_squares,
                  {{"10 3 2 3 1 1 2 5 4", "10 3 2 3 1 2 3 6 5", {"elements 10 and 11 lie on the same side", "overlap"}},
                   {"\n6 2 1 0", "\n6 0.5 1 0", {"element 11", "twisted"}},
                   {"\n3 2 0 0", "\n3 0 0.1 0", {"twisted"}}});
  auto folded = replaced(two_squares, "\n3 2 0 0", "\n3 0.5 0 0");
  folded = replaced(folded, "\n6 2 1 0", "\n6 0.5 1 0");
  EXPECT_THAT(refusal(folded),
              HasSubstr("elements 10 and 11 lie on the same side of the face that they share at (1, 0.5, 0)"));

  auto torn = replaced(two_squares, "\n6\n1 0", "\n8\n7 1 0 0\n8 1 1 0\n1 0");
  torn = replaced(torn, "11 3 2 3 1 2 3 6 5", "11 3 2 3 1 7 3 6 8");
  EXPECT_THAT(refusal(torn), AllOf(HasSubstr("elements 10 and 11 touch at (1, 0.5, 0)"), HasSubstr("Coherence")));
}

TEST(MshError, ThreeCellsAtOneFace) {
  auto text = replaced(two_squares, "\n6\n1 0", "\n8\n7 3 0 0\n8 3 1 0\n1 0");
  text = replaced(text, "\n4\n20", "\n5\n12 3 2 3 1 2 7 8 5\n20");
  EXPECT_THAT(refusal(text), HasSubstr("elements 12, 10 and 11 share the face at (1, 0.5, 0)"));
}

TEST(MshError, MiddlesThatDiffer) {
  const auto text = [](const std::string& middle) {
    return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n10\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 .5 0 0\n6 1 .5 "
           "0\n7 .5 .5 "
           "0\n8 .5 1 0\n9 0 .5 0\n10 .5 .5 0\n$EndNodes\n$Elements\n2\n1 9 0 1 2 3 5 6 7\n2 9 0 1 3 4 " +
           middle + " 8 9\n$EndElements\n";
  };
  EXPECT_EQ(refusal(text("7"), {}), "");
  EXPECT_THAT(refusal(text("10"), {}), HasSubstr("elements 1 and 2 have the same corners but not the same nodes"));
}

TEST(MshError, FracturesAndBoundaries) {
  EXPECT_THAT(refusal(two_squares, {}),
              AllOf(HasSubstr("element 20 at (1, 0.5, 0) of the physical group \"f1\" lies inside"),
                    HasSubstr("list \"f1\" among the fractures")));
  MshOptions options;
  options.fractures["F-1"] = {};
  EXPECT_THAT(refusal(two_squares, options), AllOf(HasSubstr("fracture \"F-1\": unknown"),
                                                   HasSubstr("\"f1\", \"west\""), HasSubstr("Did you mean \"f1\"")));
  options.fractures = {{"old rock", {}}};
  EXPECT_THAT(refusal(two_squares, options), HasSubstr("has dimension 2; a fracture in this mesh has dimension 1"));
  options.fractures = {{"west", {}}, {"f1", {}}};
  EXPECT_THAT(refusal(two_squares, options),
              HasSubstr("element 21 at (0, 0.5, 0) of the fracture \"west\" lies on the boundary"));
  options.fractures = {{"f1", {Vector{0, 1, 0}, false}}};
  EXPECT_THAT(refusal(two_squares, options), HasSubstr("a.msh: fracture \"f1\": its normal"));
  expect_refusals(
      two_squares,
      {
          {"20 1 2 1 1 2 5", "20 1 2 1 1 2 4", {"element 20 at (1, 0, 0) of the physical group \"f1\" is no face"}},
          {"20 1 2 1 1 2 5", "20 1 2 2 1 2 5", {"the physical group has dimension 1 and no elements"}},
          {"21 1 2 2 2 1 4", "21 1 2 2 2 1 6", {"element 21", "\"west\" is no face of a cell"}},
      });
}

/// Returns three squares in a row. `first` and `second` are the groups of the two faces between them, a character
/// each.
std::string three_squares(const std::string& first, const std::string& second) {
  std::string elements;
  int n = 0;
  const auto add = [&](const std::string& groups, const std::string& nodes) {
    for (const char group : groups) elements += fmt::format("{} 1 2 {} 1 {}\n", 20 + n++, group, nodes);
  };
  add(first, "2 6");
  add(second, "7 3");
  return fmt::format(
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n1 1 \"f1\"\n1 2 \"f2\"\n1 3 \"all\"\n"
      "$EndPhysicalNames\n$Nodes\n8\n1 0 0 0\n2 1 0 0\n3 2 0 0\n4 3 0 0\n5 0 1 0\n6 1 1 0\n7 2 1 0\n8 3 1 0\n"
      "$EndNodes\n$Elements\n{}\n{}10 3 2 4 1 1 2 6 5\n11 3 2 4 1 2 3 7 6\n12 3 2 4 1 3 4 8 7\n$EndElements\n",
      n + 3, elements);
}

/// A face may be in several groups. The message names a set of fractures that is valid.
TEST(MshError, GroupsThatOverlap) {
  const auto listing = [](const std::vector<std::string>& names) {
    MshOptions options;
    for (const auto& name : names) options.fractures[name] = {};
    return options;
  };
  struct Case {
    const char *first, *second;
    std::vector<std::string> listed;
    const char* message;  // "" for none
    std::vector<std::string> right;
  };
  const std::vector<Case> cases = {
      {"13", "23", {"f1", "f2"}, "", {}},
      {"13", "23", {"all"}, "", {}},
      {"13", "23", {}, "; if these are fractures, list \"f1\", \"f2\" among the fractures;", {"f1", "f2"}},
      {"13", "23", {"f1"}, "; if these are fractures, list \"f2\" among the fractures;", {"f1", "f2"}},
      {"13", "3", {"f1"}, ", list \"all\" among the fractures and leave out \"f1\";", {"all"}},
      {"13",
       "3",
       {"f1", "all"},
       "is in the fractures \"all\" and \"f1\"; a face belongs to one fracture: leave out \"f1\"",
       {"all"}},
      {"31", "23", {"f1", "all"}, "one fracture: list \"f2\" among the fractures and leave out \"all\"", {"f1", "f2"}},
      {"12", "23", {}, "list \"all\", \"f1\" among", {"f2"}},
      {"12", "3", {"f1", "f2", "all"}, "leave out \"f2\"", {"f1", "all"}},
  };
  for (const auto& one : cases) {
    const auto text = three_squares(one.first, one.second);
    const auto message = refusal(text, listing(one.listed));
    SCOPED_TRACE(fmt::format("{} {}: {}", one.first, one.second, message));
    EXPECT_THAT(message, HasSubstr(one.message));
    EXPECT_EQ(message.empty(), *one.message == 0);
    const auto with_right = one.right.empty() ? "" : refusal(text, listing(one.right));
    EXPECT_EQ(with_right, "");
  }
}

/// A cell in several groups belongs to the smallest region contained in the others; regions with a name have priority.
TEST(MshError, RegionsThatOverlap) {
  const auto regions = [](const std::vector<std::string>& of_cells) {
    std::string elements;
    int n = 0;
    for (int cell = 0; cell < 2; ++cell)
      for (const char group : of_cells[cell])
        elements += fmt::format("{} 3 2 {} {} {}\n", 10 + n++, group, cell + 1, cell == 0 ? "1 2 5 4" : "2 3 6 5");
    auto text = replaced(two_squares, "10 3 2 3 1 1 2 5 4\n11 3 2 3 1 2 3 6 5\n", elements);
    text = replaced(text, "$Elements\n4\n", fmt::format("$Elements\n{}\n", n + 2));
    text = replaced(text, "$PhysicalNames\n3\n", "$PhysicalNames\n4\n2 4 \"sand\"\n");
    const auto mesh = parse_msh(text, "a.msh", fractures(1));
    std::vector<std::string> names;
    for (const int region : mesh.cell_region) names.push_back(mesh.region_names[region]);
    return names;
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(regions({"3", "4"}), (Names{"old rock", "sand"}));
  EXPECT_EQ(regions({"34", "3"}), (Names{"sand", "old rock"}));
  EXPECT_EQ(regions({"34", "34"}), (Names{"old rock", "old rock"}));
  EXPECT_EQ(regions({"73", "37"}), (Names{"old rock", "old rock"}));
  EXPECT_EQ(regions({"74", "78"}), (Names{"sand", "8"}));
  auto three = three_squares("3", "3");
  three = replaced(three, "11 3 2 4 1 2 3 7 6", "11 3 2 4 1 2 3 7 6\n13 3 2 5 1 2 3 7 6");
  three = replaced(replaced(three, "12 3 2 4 1", "12 3 2 5 1"), "$Elements\n5\n", "$Elements\n6\n");
  MshOptions all;
  all.fractures["all"] = {};
  EXPECT_THAT(refusal(three, all),
              HasSubstr("element 11 is in the physical groups \"4\" and \"5\", of which none is a part"));
}

}  // namespace
}  // namespace sprekk::mesh::testing
