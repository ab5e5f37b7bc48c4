// Paths of single points of a joint: reading, states known by hand, and the table of states.
#include "laboratory/point.hpp"

#include "base/xml.hpp"
#include "unit/base/message.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

namespace sprekk::laboratory {
namespace {

using base::message_of;
using Entries = std::vector<std::string>;  ///< "Path.To.Entry=value"

using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Point of a joint with the tangential stiffness 10 Pa/m and the friction coefficient 0.5, under the compression 2 Pa.
/// It slips at the shear traction 1 Pa. The shear path is t.
Teuchos::ParameterList point_entries(const Entries& changes) {
  Teuchos::ParameterList list("Sprekk");
  for (const char* entry : {"Materials.joint.type=joint", "Materials.joint.tangential stiffness=10.0",
                            "Materials.joint.friction coefficient=0.5", "Point.material=joint",
                            "Point.control={traction, jump}", "Point.path={-2, t}", "Time.schedule={0.05, 0.2}"})
    base::apply_override(list, entry);
  for (const auto& entry : changes) base::apply_override(list, entry);
  return list;
}

PointScene point(const Entries& changes = {}) { return point_scene_of(point_entries(changes), "point.xml"); }

/// Returns two specimens; the path of the second is doubled.
PointScene specimens() {
  auto entries = point_entries({"Specimens.a, b.material=joint", "Specimens.a, b.control={traction, jump}",
                                "Specimens.a, b.path={-2, t}", "Specimens.c.material=joint",
                                "Specimens.c.control={traction, jump}", "Specimens.c.path={-2, 2*t}"});
  entries.remove("Point");
  return point_scene_of(entries, "point.xml");
}

TEST(Point, SticksThenSlips) {
  const auto states = drive_point(point());
  ASSERT_EQ(states.size(), 2);
  EXPECT_EQ(states[0].t, 0.05);
  EXPECT_EQ(states[0].contact, laws::ContactState::stick);
  EXPECT_THAT(states[0].traction, ElementsAre(DoubleNear(-2, 1e-12), DoubleNear(0.5, 1e-12)));
  EXPECT_THAT(states[0].plastic, ElementsAre(DoubleNear(0, 1e-12), DoubleNear(0, 1e-12)));
  EXPECT_EQ(states[1].t, 0.2);
  EXPECT_EQ(states[1].contact, laws::ContactState::slip);
  EXPECT_THAT(states[1].jump, ElementsAre(DoubleNear(0, 1e-12), DoubleNear(0.2, 1e-12)));
  EXPECT_THAT(states[1].traction, ElementsAre(DoubleNear(-2, 1e-12), DoubleNear(1, 1e-12)));
  EXPECT_THAT(states[1].elastic, ElementsAre(DoubleNear(0, 1e-12), DoubleNear(0.1, 1e-12)));
  EXPECT_THAT(states[1].plastic, ElementsAre(DoubleNear(0, 1e-12), DoubleNear(0.1, 1e-12)));
  EXPECT_NEAR(states[1].strength, 1, 1e-12);
}

/// Joint and column of stiffness 10 Pa/m each share the displacement t of the end.
TEST(Point, SharesTheDisplacementWithAColumn) {
  const auto states = drive_point(
      point({"Point.control={traction, column}", "Point.column tangential stiffness=10.0", "Time.schedule={0.1}"}));
  EXPECT_NEAR(states.at(0).jump[1], 0.05, 1e-12);
  EXPECT_NEAR(states.at(0).traction[1], 0.5, 1e-12);
}

TEST(Point, RefusesABondOfFaces) {
  const auto message = message_of([] {
    point({"Materials.joint.bond=sharp front", "Materials.joint.fracture energy=50"});
  });
  EXPECT_THAT(message, HasSubstr("Materials > joint > \"bond\": is \"sharp front\", whose strengths"));
}

TEST(Point, EndsBeforeAStepWithoutState) {
  const auto scene = point({"Point.control={traction, traction}", "Time.schedule={0.5, 0.75, 2, 3}"});
  const auto curves = drive_points(scene);
  ASSERT_EQ(curves.size(), 1);
  EXPECT_EQ(curves[0].states.size(), 2);
  EXPECT_THAT(curves[0].failure, HasSubstr("point.xml: Sprekk > Point: step 3 of 4, "));
  EXPECT_EQ(message_of([&] { drive_point(scene); }), curves[0].failure);
}

TEST(Point, OfSeveralSpecimensHasOneCurveEach) {
  const auto scene = specimens();
  const auto curves = drive_points(scene);
  ASSERT_EQ(curves.size(), 2);
  EXPECT_EQ(curves[0].specimen, "a, b");
  EXPECT_EQ(curves[1].specimen, "c");
  EXPECT_NEAR(curves[0].states.at(0).traction[1], 0.5, 1e-12);
  EXPECT_NEAR(curves[1].states.at(1).plastic[1], 0.3, 1e-12);
  EXPECT_THAT(message_of([&] { drive_point(scene); }), HasSubstr("point.xml: has 2 specimens, not one point"));
}

TEST(Point, OfAJointInSituRequiresAnInitialTraction) {
  const Entries in_situ = {"Materials.joint.reference state=in situ", "Materials.joint.initial aperture=0.5"};
  EXPECT_THAT(
      message_of([&] { point(in_situ); }),
      HasSubstr("point.xml: Sprekk > Point > \"initial traction\": missing; it is required with the \"reference "
                "state\" in situ of the joint"));
  auto loaded = in_situ;
  loaded.insert(loaded.end(), {"Point.initial traction={-2, 0}", "Materials.joint.normal stiffness=8.0"});
  const auto curves = drive_points(point(loaded));
  EXPECT_NEAR(curves[0].initial.aperture, 0.5, 1e-15);
  loaded.emplace_back("Point.path={-6, 0}");
  EXPECT_NEAR(drive_point(point(loaded)).back().aperture, 0, 1e-12);
  loaded.emplace_back("Point.initial traction={-2, 3}");
  EXPECT_THAT(
      message_of([&] { drive_point(point(loaded)); }),
      HasSubstr("point.xml: Sprekk > Point: the initial shear traction is 3 Pa under the normal traction -2 Pa; "
                "it must be at most the strength of the joint, 1 Pa"));
}

TEST(Point, TablesHaveOneLineForEachState) {
  const PointState initial = {.jump = {0, 0}, .elastic = {0, 0}, .plastic = {0, 0}, .traction = {0, 0}};
  PointState state = initial;
  state.t = 0.5;
  state.contact = laws::ContactState::slip;
  state.jump = {1, -2};
  state.traction = {-4, 0.25};
  state.strength = 8;
  state.aperture = 16;
  std::ostringstream plain, named;
  write_csv(plain, {{.initial = initial, .states = {state}}});
  EXPECT_EQ(plain.str(),
            "t,state,jump_n,jump_t,elastic_jump_n,elastic_jump_t,plastic_jump_n,plastic_jump_t,traction_n,traction_t,"
            "strength,aperture\n0,0,0,0,0,0,0,0,0,0,0,0\n0.5,2,1,-2,0,0,0,0,-4,0.25,8,16\n");
  write_csv(named, {{.initial = initial, .specimen = "a \"b\""}});
  EXPECT_THAT(named.str(), HasSubstr("specimen,t,state,"));
  EXPECT_THAT(named.str(), HasSubstr("\n\"a \"\"b\"\"\",0,0,"));
}

TEST(Point, MessagesNameThePlaceTheValueAndAllowedValues) {
  const std::vector<std::pair<Entries, std::string>> cases = {
      {{"Point.control={traction, force}"},
       "Sprekk > Point > \"control\": is \"force\" for component 1, must be jump, traction or column"},
      {{"Point.control={traction}", "Point.path={-2}"}, "Point > \"control\": needs 2 components (2D) or 3 (3D)"},
      {{"Point.path={-2, t, t}"}, "Point > \"path\": number of components is 3, that of \"control\" is 2"},
      {{"Point.plastic jump={0, 0}"}, "Point > \"plastic jump\": number of components is 2, must be 1"},
      {{"Point.initial traction={-1}"}, "Point > \"initial traction\": number of components is 1, must be 2"},
      {{"Point.control={column, jump}"}, "Point > \"column normal stiffness\": missing; a column needs it"},
      {{"Point.control={traction, column}"}, "Point > \"column tangential stiffness\": missing"},
      {{"Point.material=joynt"}, "Point > \"material\": is \"joynt\""},
      {{"Time.tolerance=0.1"}, "Sprekk > Time: chooses steps by \"tolerance\""},
      {{"Specimens.a.material=joint", "Specimens.a.control={traction, jump}", "Specimens.a.path={-2, t}"},
       "Sprekk > Specimens: given in addition to \"Point\""}};
  for (const auto& [changes, part] : cases) {
    const auto message = message_of([&, &changes = changes] { point(changes); });
    EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 0) << message;
    EXPECT_THAT(message, HasSubstr(part));
  }
  auto entries = point_entries({});
  entries.remove("Point");
  EXPECT_THAT(message_of([&] { point_scene_of(entries, "point.xml"); }),
              HasSubstr("point.xml: Sprekk > Point: missing, and so are \"Specimens\""));
  base::apply_override(entries, "Bulk.material=rock");
  EXPECT_THAT(message_of([&] { point_scene_of(entries, "block.xml"); }),
              HasSubstr("block.xml: is a scene for `sprekk run`"));
}

}  // namespace
}  // namespace sprekk::laboratory
