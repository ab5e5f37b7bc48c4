// Stress intensity factors of cracks with exact solutions.
#include "estimate/state_table.hpp"
#include "verification/heat/warm_boxes.hpp"
#include "verification/tips/crack.hpp"

namespace sprekk::tests {
namespace {

/// Row of the table of stress intensity factors.
struct Tip {
  Vector3 x{}, K{}, of_jump{};
  Real G, error, radius;
};

/// Solves one step and returns the table of all fractures. Collective.
std::vector<Tip> tips_of(model::Scene scene) {
  for (auto& [name, fracture] : scene.fractures) fracture.stress_intensity = true;
  model::Model model(scene, Tpetra::getDefaultComm());
  const auto report = model.step_to(1);
  EXPECT_TRUE(report.converged) << report.reason;
  const auto outputs = model.system().outputs(model.state());
  const auto table = physics::Mechanics::Tables::table(model.setting(), model.system());
  const auto found = (*table)({model.state(), model.time(), outputs});
  std::vector<Tip> tips(found.fractures.size());
  for (const auto& [name, unit, values] : found.columns)
    for (std::size_t row = 0; row < tips.size(); ++row) {
      auto& tip = tips[row];
      const std::map<std::string, Real*> to = {{"x", &tip.x[0]},
                                               {"y", &tip.x[1]},
                                               {"z", &tip.x[2]},
                                               {"K_I", &tip.K[0]},
                                               {"K_II", &tip.K[1]},
                                               {"K_III", &tip.K[2]},
                                               {"K_I_of_jump", &tip.of_jump[0]},
                                               {"K_II_of_jump", &tip.of_jump[1]},
                                               {"K_III_of_jump", &tip.of_jump[2]},
                                               {"G", &tip.G},
                                               {"error", &tip.error},
                                               {"radius", &tip.radius}};
      if (const auto at = to.find(name); at != to.end()) *at->second = values[row];
    }
  return tips;
}

/// Largest error of K of all points, relative to |exact|. `exact` depends on the direction of the front along x, 1 or
/// -1.
Real largest_error(const std::vector<Tip>& tips, const std::function<Vector3(Real)>& exact) {
  Real largest = tips.empty() ? 1 : 0;
  for (const auto& tip : tips) {
    const auto K = exact(tip.x[0] < 0 ? -1 : 1);
    const Real e = norm(difference(tip.K, K)) / norm(K);
    largest = std::isfinite(e) ? std::max(largest, e) : std::numeric_limits<Real>::infinity();
  }
  return largest;
}

const Real K_of_crack = 1e-3 * std::sqrt(M_PI);  // half-length 1, stress 1e-3
Vector3 opens(Real) { return {K_of_crack, 0, 0}; }
Vector3 slides(Real ahead) { return {0, ahead * K_of_crack, 0}; }

/// Adds expressions to the prescribed displacements of all boundaries.
void add_displacement(model::Scene& scene, const std::vector<std::string>& more) {
  for (auto& [name, condition] : scene.boundary_conditions)
    for (std::size_t i = 0; i < more.size(); ++i) {
      auto& u = condition.displacement[i];
      u = base::Expression(fmt::format("({})+({})", u.text(), more[i]));
      u.compile();
    }
}

/// Crack under pressure, or under compression and shear with friction: the faces are loaded, open or closed.
TEST(StressIntensity, OfACrackInAllCells) {
  for (const std::string cell : {"triangle", "quadrilateral", "tetrahedron", "hexahedron"})
    for (const int order : {1, 2}) {
      const bool flat = cell == "triangle" || cell == "quadrilateral";
      if (!flat && order == 2) continue;
      for (const std::string name : {"opening", "sliding"}) {
        const auto tips = tips_of(crack_in_box(name, cell, order, 16, "enriched"));
        const Real error = largest_error(tips, name == "opening" ? opens : slides);
        SCOPED_TRACE(fmt::format("{} of {} of order {}: {}", name, cell, order, error));
        EXPECT_LE(error, cell == "tetrahedron" ? 0.045 : order == 1 ? 0.012 : 0.0025);
        for (const auto& tip : tips) EXPECT_LE(error * K_of_crack, 1.5 * tip.error);
      }
    }
}

/// Williams' field with K_I, K_II and T, prescribed on the sides of a box. The sides of the crack belong to regions,
/// so that its mouth has two displacements.
const Real of_williams[] = {1e-3, 4e-4, -5e-4};  // K_I, K_II, T
model::Scene williams(int n) {
  const auto [K_I, K_II, T] = of_williams;
  const Real nu = 0.25, G = 1;
  auto scene = crack_in_box("opening", "triangle", 1, n, "enriched");
  scene.bulk.initial_stress.clear();
  scene.mesh.fractures["crack"].lower_corner = {-2, 0};
  scene.mesh.fractures["crack"].upper_corner = {0, 0};
  scene.boundary_conditions.clear();
  for (const std::string region : {"below", "above"}) {
    const bool up = region == "above";
    auto& box = scene.mesh.regions[region];
    box.lower_corner = {-2, up ? 0.0 : -2.0};
    box.upper_corner = {2, up ? 2.0 : 0.0};
    const std::string r = "sqrt(x^2+y^2)", c = fmt::format("sqrt(max({}+x,0)/2)", r),
                      s = fmt::format("{}*sqrt(max({}-x,0)/2)", up ? 1 : -1, r), ss = fmt::format("(1-x/{})", r);
    const Real f = 1 / (2 * G * std::sqrt(2 * M_PI)), kappa = 3 - 4 * nu, E = 2 * G * (1 + nu);
    const auto u = fmt::format("{}*{}*({}+{})+{}*{}*({}-{})+({})*x", f * K_I, c, kappa - 1, ss, f * K_II, s, kappa + 3,
                               ss, T * (1 - nu * nu) / E),
               v = fmt::format("{}*{}*({}+{})-{}*{}*({}-{})-({})*y", f * K_I, s, kappa - 1, ss, f * K_II, c, kappa - 1,
                               ss, T * nu * (1 + nu) / E);
    for (const std::string side : {"west", "east", up ? "north" : "south"}) {
      auto& condition = scene.boundary_conditions[side + " " + region];
      condition.boundary = side;
      condition.region = region;
      for (const auto& text : {u, v}) condition.displacement.emplace_back(text).compile();
    }
  }
  return scene;
}

TEST(StressIntensity, OfWilliamsFieldConvergesWithFirstOrder) {
  const auto [K_I, K_II, T] = of_williams;
  const Real K = std::hypot(K_I, K_II);
  std::vector<Real> errors;
  for (const int n : {16, 64}) {
    const auto tips = tips_of(williams(n));
    ASSERT_EQ(tips.size(), 1u);
    errors.push_back(norm(difference(tips[0].K, Vector3{K_I, K_II, 0})) / K);
    EXPECT_NEAR(tips[0].G, K * K * (1 - 0.25) / 2, 2.1 * errors.back() * K * K * (1 - 0.25) / 2);
  }
  EXPECT_LE(errors[1], 0.004);
  EXPECT_GE(std::log(errors[0] / errors[1]) / std::log(4), 0.85) << errors[0] << ", then " << errors[1];
}

/// Loads whose exact solution is smooth, without traction on the crack: K is that of the pressure.
TEST(StressIntensity, IsThatOfThePressureUnderOtherLoads) {
  const auto change = [](const std::function<void(model::Scene&)>& add) {
    auto scene = crack_in_box("opening", "triangle", 1, 32, "enriched");
    const auto before = tips_of(scene);
    add(scene);
    const auto after = tips_of(scene);
    Real largest = before.size() == 2 ? 0 : 1;
    for (std::size_t k = 0; k < after.size(); ++k)
      largest = std::max(largest, norm(difference(after[k].K, before[k].K)) / K_of_crack);
    return largest;
  };
  const auto thermal = change([](model::Scene& scene) {
    scene.materials.at("rock").thermal_expansion = base::Expression(2e-4);
    warm(scene, 300, 2.5, 1, 0);
    scene.regions["bulk"].temperature = base::Expression("300 + x + 0.5*y");
    scene.regions["bulk"].temperature->compile();
    const Real a = 2.5e-4 / 2, b = 1.25e-4 / 2;  // (1 + nu) alpha_T times the gradient, halved
    add_displacement(scene,
                     {fmt::format("{}*(x^2-y^2)+{}*x*y", a, 2 * b), fmt::format("{}*x*y+{}*(y^2-x^2)", 2 * a, b)});
  });
  EXPECT_LE(thermal, 0.01);
  const auto body = change([](model::Scene& scene) {  // sigma_yy = 1e-3 y, lambda + 2 G = 3
    scene.bulk.body_force = {base::Expression(0), base::Expression(-1e-3)};
    add_displacement(scene, {"0", "1e-3*y^2/6"});
  });
  EXPECT_LE(body, 4e-3);
  const auto initial = change([](model::Scene& scene) {
    scene.bulk.body_force = {base::Expression(0), base::Expression(-2e-3)};
    scene.bulk.initial_stress[1] = base::Expression("0.001+0.002*y");
    scene.bulk.initial_stress[1].compile();
  });
  EXPECT_LE(initial, 1e-9);
}

/// Mode III: slides with friction along its fronts, which end at sides without shear. The sign of K_III follows from
/// the slip of the upper side along the front, ahead x normal.
TEST(StressIntensity, OfACrackThatTears) {
  const auto tips = tips_of(read_scene("verification/tearing_3d.xml"));
  EXPECT_EQ(tips.size(), 10u);
  for (const auto& tip : tips) {
    EXPECT_NEAR(norm(tip.K), K_of_crack, 0.02 * K_of_crack);
    EXPECT_NEAR(tip.K[2], tip.x[0] < 0 ? K_of_crack : -K_of_crack, 0.02 * K_of_crack);
  }
}

/// Circular crack of radius 1 under the pressure 1e-3: K = 2 p/sqrt(pi). The front has 26 edges.
TEST(StressIntensity, OfACircularCrack) {
  const Real K = 2e-3 / std::sqrt(M_PI);
  for (const int order : {1, 2}) {
    const auto tips = tips_of(read_scene("verification/penny.xml", {fmt::format("Mesh file.order={}", order)}));
    Real mean = 0, largest = 0;
    for (const auto& tip : tips) {
      mean += tip.K[0] / tips.size();
      largest = std::max(largest, norm(difference(tip.K, Vector3{K, 0, 0})));
    }
    EXPECT_NEAR(mean, K, (order == 1 ? 0.08 : 0.01) * K) << order;
    EXPECT_LE(largest, (order == 1 ? 0.1 : 0.02) * K) << order;
  }
}

/// A rigid rotation about x changes no stress, and K at the curved front only by the error of quadrature and of the
/// front of straight edges, 2e-5. Crack fields whose hoop strain loads the faces would add K_II of 1.9e-4.
TEST(StressIntensity, IsThatOfThePressureUnderARotation) {
  for (const int order : {1, 2}) {
    auto scene = read_scene("verification/penny.xml", {fmt::format("Mesh file.order={}", order)});
    const auto before = tips_of(scene);
    add_displacement(scene, {"0", "-1e-3*z", "1e-3*y"});
    const auto after = tips_of(scene);
    ASSERT_EQ(after.size(), before.size());
    for (std::size_t k = 0; k < after.size(); ++k)
      EXPECT_LE(norm(difference(after[k].K, before[k].K)), 3e-5) << order << k;
  }
}

}  // namespace
}  // namespace sprekk::tests
