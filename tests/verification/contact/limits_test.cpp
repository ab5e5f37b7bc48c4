// Joint parameters near a limit, on crossing fractures: results converge to the limit with first order.
#include "verification/contact/states.hpp"

#include <functional>

namespace sprekk::tests {
namespace {

using Change = std::function<void(model::Material&, Real)>;

struct Limit {
  std::string name;
  Change near, at;  ///< near: parameter e close to the limit; at: limit e = 0
};

const std::vector<Limit> limits = {
    {"rigid in shear", [](auto& joint, Real e) { joint.tangential_stiffness = 1 / e; },
     [](auto& joint, Real) { joint.tangential_stiffness = std::numeric_limits<Real>::infinity(); }},
    {"soft in shear",
     [](auto& joint, Real e) {
       joint.tangential_stiffness = e;
       joint.dilation_angle = 0;
     },
     [](auto& joint, Real) { joint.friction_coefficient = joint.dilation_angle = 0; }},
    {"no friction", [](auto& joint, Real e) { joint.friction_coefficient = e; },
     [](auto& joint, Real) { joint.friction_coefficient = 0; }},
    {"no closure", [](auto& joint, Real e) { joint.maximum_closure = 1e-2 * e; },
     [](auto& joint, Real) { joint.maximum_closure = 0; }},
    {"linear closure", [](auto& joint, Real e) { joint.maximum_closure = 1e-4 / e; },
     [](auto& joint, Real) { joint.maximum_closure.reset(); }},
    {"rigid under pressure", [](auto& joint, Real e) { joint.normal_stiffness = 1 / e; },
     [](auto& joint, Real) { joint.maximum_closure = 0; }},
};

void expect_limits(const std::string& name) {
  const auto solve = [&](const Change& change, Real e) {
    auto scene = read_scene(name);
    change(scene.materials.at("joint"), e);
    const auto result = run(scene);
    if (!result.failure.empty()) throw Error(result.failure);
    return result;
  };
  for (const auto& limit : limits) {
    SCOPED_TRACE(name + ", " + limit.name);
    const auto at = solve(limit.at, 0), near = solve(limit.near, 1e-6), nearer = solve(limit.near, 1e-7);
    for (std::size_t step = 0; step < at.states.size(); ++step) {
      const Real d = distance(near, at, step), e = distance(nearer, at, step);
      EXPECT_GT(d, 1e-9);
      EXPECT_NEAR(d / e, 10, 0.1);
    }
    EXPECT_LE(distance(solve(limit.near, 1e-12), at), 1e-9);
  }
}

TEST(Limits, OfCrossingFractures) {
  expect_limits("verification/crossing_2d.xml");
  expect_limits("verification/crossing_3d.xml");
}

}  // namespace
}  // namespace sprekk::tests
