// Groups of functions of a physics: presence and signatures.
#include "physics/scene.hpp"

#include <gtest/gtest.h>

namespace sprekk::physics {
namespace {

struct Complete : Physics<Complete> {
  struct Rates {
    static bool exist(const Scene&) { return true; }
    static std::vector<std::string> sections() { return {}; }
    static std::string implicit_euler(const Scene&) { return ""; }
  };
};
struct LacksAFunction {
  static bool exist(const Scene&) { return true; }
  static std::vector<std::string> sections() { return {}; }
};
struct OtherResult : Complete::Rates {
  static int exist(const Scene&) { return 1; }
};
struct OtherArgument : Complete::Rates {
  static bool exist(Scene&) { return true; }
};

static_assert(IsRates<Complete::Rates> && HasRates<Complete> && !HasChange<Complete>);
static_assert(has_complete_groups<Complete>());
static_assert(!IsRates<LacksAFunction> && !IsRates<OtherResult> && !IsRates<OtherArgument>);

TEST(Groups, AreVisitedInPhysicsThatHaveThem) {
  std::vector<std::string> sections;
  int all = 0, with_solvability = 0;
  for_each_physics([&](auto) { ++all; });
  for_each_physics([&]<HasSolvability P>(P) { ++with_solvability; });
  for_each_physics([&]<HasRates P>(P) { sections.push_back(P::Rates::sections().at(0)); });
  EXPECT_EQ(all, 4);
  EXPECT_EQ(with_solvability, 1);
  EXPECT_EQ(sections, (std::vector<std::string>{"Flow", "Heat"}));
}

}  // namespace
}  // namespace sprekk::physics
