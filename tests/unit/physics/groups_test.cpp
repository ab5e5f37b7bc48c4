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
template <class P>
concept HasAllGroups = HasRates<P> && HasTransport<P> && HasEstimate<P> && HasChange<P> && HasWarnings<P> &&
    HasTables<P> && HasSolvability<P>;
struct WithAllGroups : Complete {
  struct Transport {
    static std::vector<CarriedQuantity> carried(const Scene&);
    static std::string friction_power(const Scene&);
  };
  struct Estimate {
    static std::string missing(const Scene&);
    static std::vector<estimate::QuantityKind> quantities();
    static std::string refuses(const Scene&, const estimate::Functional&);
    static std::unique_ptr<estimate::MeshError> mesh_error(const Setting&, assembly::System&);
  };
  struct Change {
    static std::vector<std::string> refuses(const Scene&, const Scene&);
    static std::vector<std::string> refuses_in(const mesh::Mesh&, const Scene&, const Scene&);
    static void prepare(const mesh::Mesh&, const Scene&, Scene&);
  };
  struct Warnings {
    static std::vector<std::string> of_input(const Setting&, const std::vector<Real>&);
    static std::vector<std::string> of_state(const Setting&, const std::vector<Real>&,
                                             const std::vector<assembly::OutputField>&);
  };
  struct Tables {
    static std::string name();
    static std::unique_ptr<estimate::TableOfStates> table(const Setting&, assembly::System&);
  };
  struct Solvability {
    static std::vector<std::string> doubts(const Setting&, bool);
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
static_assert(HasAllGroups<WithAllGroups> && !HasAllGroups<Complete>);
static_assert(has_complete_groups<Complete>() && has_complete_groups<WithAllGroups>());
static_assert(!IsRates<LacksAFunction> && !IsRates<OtherResult> && !IsRates<OtherArgument>);
static_assert(!IsTransport<LacksAFunction> && !IsEstimate<LacksAFunction> && !IsChange<LacksAFunction> &&
              !IsWarnings<LacksAFunction> && !IsTables<LacksAFunction> && !IsSolvability<LacksAFunction>);

TEST(Groups, AreVisitedInPhysicsThatHaveThem) {
  std::vector<std::string> sections;
  int all = 0, with_solvability = 0;
  for_each_physics([&](auto) { ++all; });
  for_each_physics([&]<HasSolvability P>(P) { ++with_solvability; });
  for_each_physics([&]<HasRates P>(P) { sections.push_back(P::Rates::sections().at(0)); });
  EXPECT_EQ(all, 5);
  EXPECT_EQ(with_solvability, 1);
  EXPECT_EQ(sections, (std::vector<std::string>{"Flow", "Heat", "Tracer"}));
}

}  // namespace
}  // namespace sprekk::physics
