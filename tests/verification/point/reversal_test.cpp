// Cyclic shear: for any friction, dilation, stiffness and steps, each step has a state, and the last state obeys the
// law.
#include "base/xml.hpp"
#include "point_scenes.hpp"

#include <random>

namespace sprekk::tests {
namespace {

using Overrides = std::vector<std::string>;

/// JRC 8, JCS 60 MPa, residual angle 27 degrees, peak slip 2 mm.
const Overrides mobilised_friction = {"Materials.joint.friction=mobilised Barton-Choubey",
                                      "Materials.joint.residual friction angle=27 deg"};
const Overrides mobilised_dilation = {"Materials.joint.dilation=mobilised"};
const Overrides roughness = {"Materials.joint.joint roughness coefficient=8",
                             "Materials.joint.joint wall strength=60 MPa", "Materials.joint.peak slip=2e-3"};
const Overrides coulomb = {"Materials.joint.friction coefficient=0.6"};

struct Joint {
  const char* name;
  Overrides entries;
};

std::vector<Joint> joints() {
  const auto both = [](std::vector<Overrides> parts) {
    Overrides all;
    for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
  };
  const auto weakening =
      both({coulomb,
            {"Materials.joint.friction=slip weakening", "Materials.joint.residual friction coefficient=0.4",
             "Materials.joint.weakening distance=3e-3"}});
  const Overrides angle = {"Materials.joint.dilation angle=5"};
  return {{"mobilised", both({roughness, mobilised_friction, mobilised_dilation})},
          {"mobilised friction", both({roughness, mobilised_friction})},
          {"mobilised dilation", both({roughness, coulomb, mobilised_dilation})},
          {"weakening, mobilised dilation", both({roughness, weakening, mobilised_dilation})},
          {"constant", both({coulomb, angle})},
          {"weakening, constant", both({weakening, angle})},
          {"limited",
           both({coulomb, angle, {"Materials.joint.dilation=limited", "Materials.joint.largest dilation=1e-4"}})},
          {"decaying",
           both({coulomb,
                 angle,
                 {"Materials.joint.dilation=decaying angle", "Materials.joint.dilation decay distance=1e-3"}})}};
}

/// Returns a point scene with this joint, stiffness, control and path.
laboratory::PointScene cycle(const Joint& joint, const std::string& stiffness, int steps, const std::string& control,
                             const std::string& path) {
  Overrides overrides = {"Materials.joint.tangential stiffness=" + stiffness, "Point.control=" + control,
                         "Point.path=" + path, "Time.end=4", fmt::format("Time.steps={}", steps)};
  overrides.insert(overrides.end(), joint.entries.begin(), joint.entries.end());
  const std::string text =
      R"(<ParameterList name="Sprekk"><ParameterList name="Materials"><ParameterList name="joint">
      <Parameter name="type" type="string" value="joint"/></ParameterList></ParameterList>
      <ParameterList name="Time"/><ParameterList name="Point"><Parameter name="material" type="string" value="joint"/>
      </ParameterList></ParameterList>)";
  return laboratory::point_scene_of(base::parse_xml(text, joint.name, "Sprekk", base::Defects::keep), joint.name,
                                    overrides);
}

constexpr const char *in_2d = "{traction, jump}", *there_and_back = "{-1e6, 2e-3*(2 - abs(2 - t))}",
                     *in_3d = "{traction, jump, jump}",
                     *there_and_back_3d = "{-1e6, 1.6e-3*(2 - abs(2 - t)), 1.2e-3*(2 - abs(2 - t))}";

/// Final state of a cycle 0, 4, 0 mm under 1 MPa: N tan(phi) for the path length s, and the remaining dilation
/// (forward minus backward). A stiffness K shortens the path by 2 tau/K at the reversal.
TEST(Reversal, EndsAlikeWithAnyStiffnessAndSteps) {
  for (const auto& joint : joints()) {
    const auto exact = laboratory::drive_point(cycle(joint, "infinite", 3200, in_2d, there_and_back)).back();
    for (const std::string stiffness : {"infinite", "1e10", "1e11", "1e12", "1e13", "1e14", "1e15", "1e16"})
      for (const int steps : {8, 9, 40, 77, 200, 800}) {
        SCOPED_TRACE(fmt::format("{}, K_t {}, {} steps", joint.name, stiffness, steps));
        try {
          const auto flat = laboratory::drive_point(cycle(joint, stiffness, steps, in_2d, there_and_back)).back();
          const Real compliance = stiffness == "infinite" ? 0 : 1 / std::stod(stiffness);
          const Real late = 4e-3 / steps + 2e6 * compliance;  // uncertainty of the slip, m
          EXPECT_NEAR(flat.traction[1], exact.traction[1], 2e6 * late / 2e-3);
          EXPECT_NEAR(flat.jump[0], exact.jump[0], 0.12 * late);
          const auto turned = laboratory::drive_point(cycle(joint, stiffness, steps, in_3d, there_and_back_3d)).back();
          EXPECT_NEAR(turned.traction[1], 0.8 * flat.traction[1], 1e-6 * 1e6);
          EXPECT_NEAR(turned.traction[2], 0.6 * flat.traction[1], 1e-6 * 1e6);
          EXPECT_NEAR(turned.jump[0], flat.jump[0], 1e-6 * 1e-3);
        } catch (const Error& error) {
          ADD_FAILURE() << error.what();
        }
      }
  }
}

/// Random cycles in 2D and 3D under varying compression: each step has a state, and the shear traction does not exceed
/// the strength.
TEST(Reversal, RandomCyclesHaveAStateAtEachStep) {
  std::mt19937 random(20261128);
  const auto uniform = [&](Real low, Real high) { return std::uniform_real_distribution<Real>(low, high)(random); };
  const auto all = joints();
  for (int k = 0; k < 300; ++k) {
    const auto& joint = all[random() % all.size()];
    const std::string stiffness = random() % 4 == 0 ? "infinite" : fmt::format("{:.6g}", std::pow(10, uniform(10, 16)));
    const int dim = 2 + random() % 2, steps = std::lround(std::exp(uniform(std::log(8), std::log(300))));
    const Real slip = std::pow(10, uniform(-4, -2)), N = std::pow(10, uniform(4, 7));
    const std::string along = fmt::format("{:.6g}*sin({:.6g}*t)", slip, uniform(0.5, 4));
    const std::string across = fmt::format(", {:.6g}*sin({:.6g}*t + {:.6g}) ", slip, uniform(0.5, 4), uniform(0, 3));
    const std::string path =
        fmt::format("{{{:.6g}*(1 + {:.3g}*sin(3*t)), {}{}}}", -N, uniform(0, 0.8), along, dim == 3 ? across : "");
    SCOPED_TRACE(fmt::format("case {}: {}, K_t {}, {} steps, {}", k, joint.name, stiffness, steps, path));
    try {
      for (const auto& s : laboratory::drive_point(cycle(joint, stiffness, steps, dim == 2 ? in_2d : in_3d, path)))
        EXPECT_LE(std::hypot(s.traction[1], dim == 3 ? s.traction[2] : 0), s.strength * (1 + 1e-9) + 1e-9 * N);
    } catch (const Error& error) {
      ADD_FAILURE() << error.what();
    }
  }
}

}  // namespace
}  // namespace sprekk::tests
