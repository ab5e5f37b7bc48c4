// Quantities of interest: tolerances, units and messages.
#include "model/accuracy.hpp"
#include "block.hpp"

namespace sprekk::model::test {
namespace {

using ::testing::HasSubstr;

Quantity quantity(const std::string& what) {
  Quantity q;
  q.what = what;
  return q;
}

TEST(Accuracy, TheLargerToleranceApplies) {
  auto q = quantity("slip");
  q.relative = 0.25;
  EXPECT_EQ(q.requested(-8), 2);
  EXPECT_EQ(q.requested(0), 0);
  q.absolute = 3;
  EXPECT_EQ(q.requested(-8), 3);
  EXPECT_EQ(q.requested(16), 4);
}

TEST(Accuracy, QuantitiesHaveTitlesAndUnits) {
  auto q = quantity("slip");
  EXPECT_EQ(q.title(), "slip of all fractures");
  EXPECT_EQ(q.unit(2), "m");
  EXPECT_FALSE(q.is_norm());
  q.fractures = {"a", "b"};
  EXPECT_EQ(q.title(), "slip of \"a\", \"b\"");
  q = quantity("reaction");
  q.boundary = "east";
  EXPECT_EQ(q.title(), "reaction x of \"east\"");
  EXPECT_EQ(q.unit(3), "N");
  EXPECT_EQ(q.unit(2), "N/m");
  q = quantity("flow");
  q.boundary = "east";
  EXPECT_EQ(q.title(), "flow through \"east\"");
  q.well = "w";
  EXPECT_EQ(q.title(), "flow of \"w\"");
  EXPECT_TRUE(quantity("stress").is_norm());
  EXPECT_EQ(quantity("stress").title(), "stress");
}

TEST(Accuracy, RefusesIncompleteQuantities) {
  const auto goal_refusal = [](const Entries& changes) {
    Entries all = with_fault({"Mesh.cell=triangle", "Accuracy.quantities.q.quantity=slip"});
    all.insert(all.end(), changes.begin(), changes.end());
    return refusal(all);
  };
  const std::string place = "block.xml: Sprekk > Accuracy > quantities > q";
  EXPECT_THAT(goal_refusal({}), HasSubstr(place + ": needs \"relative\", \"absolute\", or both"));
  EXPECT_THAT(goal_refusal({"Accuracy.quantities.q.relative=2.0"}),
              HasSubstr(place + " > \"relative\": is 2, must be between 1e-08 and 1"));
  EXPECT_THAT(goal_refusal({"Accuracy.quantities.q.relative=0.1", "Accuracy.quantities.q.fractures={falt}"}),
              HasSubstr(place + " > \"fractures\": is \"falt\""));
  EXPECT_THAT(goal_refusal({"Accuracy.quantities.q.relative=0.1", "Accuracy.quantities.q.quantity=heat"}),
              HasSubstr(place + " > \"quantity\": is \"heat\", must be one of"));
  EXPECT_THAT(goal_refusal({"Accuracy.quantities.q.relative=0.1", "Accuracy.quantities.q.quantity=reaction",
                            "Accuracy.quantities.q.boundary=west", "Accuracy.quantities.q.component=z"}),
              HasSubstr(place + " > \"component\": is z, must be x or y in 2D"));
}

}  // namespace
}  // namespace sprekk::model::test
