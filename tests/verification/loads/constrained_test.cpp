// Contradictory conditions and unsupported scenes: refused with equal messages on all ranks.
#include "verification/loads/block.hpp"

#include <gmock/gmock.h>

namespace sprekk::tests {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// Returns the message of the Error of the constructor of the model or of set_time() on this rank; "" if none.
std::string error_of(const model::Scene& scene) {
  try {
    model::Model model(scene, Tpetra::getDefaultComm());
    model.system().set_time(1, 1);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

model::Scene pillar(const Discretisation& cells) {
  const int dim = cells_of(2)[0] == cells.cell || cells_of(2)[1] == cells.cell ? 2 : 3;
  auto scene = box_of_rock(cells, std::vector<Real>(dim, 2), std::vector<int>(dim, 2), "1e6");
  scene.mesh.fractures["f"] = {first<Real>(dim, {0, 1, 0}), first<Real>(dim, {2, 1, 2}), {}, false};
  scene.materials["joint"].type = "joint";
  scene.materials["joint"].friction_coefficient = base::Expression(0.6);
  scene.fractures["f"].material = "joint";
  return scene;
}

TEST(Constrained, TractionAndRollersAlone) {
  for (int dim : {2, 3})
    for (const auto& cells : discretisations(dim)) {
      auto scene = pillar(cells);
      load(scene, "north", first<std::string>(dim, {"0", "-1e3", "0"}));
      prescribe(scene, "south", first<std::string>(dim, {"free", "0", "free"}));
      EXPECT_THAT(error_of(scene),
                  AllOf(HasSubstr("nothing constrains the rock of \"bulk\""),
                        HasSubstr(dim == 2 ? "it can move along (1, 0)." : "it can move along (1, 0, 0)"),
                        HasSubstr(dim == 2 ? "cells of" : "it can rotate about the axis (0, 1, 0) through (1, 1, 1)"),
                        HasSubstr("prescribe the missing components")))
          << cells.name();
      prescribe(scene, "west", first<std::string>(dim, {"0", "free", "0"}));
      EXPECT_EQ(error_of(scene), "") << cells.name();  // contact constrains the upper half
    }
}

TEST(Constrained, PeriodicSidesHoldTheRotationOnly) {
  auto scene = pillar({"quadrilateral", 1});
  scene.mesh.periodic = {"x"};
  prescribe(scene, "south", {"free", "0"});
  EXPECT_THAT(error_of(scene), HasSubstr("it can move along (1, 0). "));
  prescribe(scene, "north", {"0", "free"});
  EXPECT_EQ(error_of(scene), "");
}

TEST(Conflicts, OfTwoRegionsAndOnTiedSidesAreNamed) {
  for (int dim : {2, 3})
    for (const auto& cells : discretisations(dim)) {
      SCOPED_TRACE(cells.name());
      auto scene = pillar(cells);
      scene.mesh.regions["left"] = {first<Real>(dim, {0, 0, 0}), first<Real>(dim, {1, 2, 2})};
      const auto rest = std::vector<std::string>(dim, "0");
      auto other = rest;
      other[0] = "1e-3";
      prescribe(scene, "south", rest, "left");
      prescribe(scene, "south", other, "bulk");  // both constrain the nodes between the regions
      EXPECT_THAT(error_of(scene), AllOf(HasSubstr("\"south left held\""), HasSubstr("\"south bulk held\""),
                                         HasSubstr("component x"), HasSubstr("at (1, 0, ")));
      scene.boundary_conditions.erase("south bulk held");
      EXPECT_EQ(error_of(scene), "");

      auto tied = pillar(cells);
      tied.mesh.periodic = {"x"};
      prescribe(tied, "west", rest);
      EXPECT_THAT(error_of(tied),
                  AllOf(HasSubstr("west  held"), HasSubstr("\"periodic\" connects to the opposite side")));
      tied.boundary_conditions.erase("west  held");
      prescribe(tied, "south", rest);
      EXPECT_EQ(error_of(tied), "");
    }
}

}  // namespace
}  // namespace sprekk::tests
