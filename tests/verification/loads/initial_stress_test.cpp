// Initial stress with the forces in equilibrium: rock at rest.
#include "verification/loads/block.hpp"

namespace sprekk::tests {
namespace {

/// Checks that rock under its weight and the lithostatic stress does not move. The fracture has the initial traction
/// at its centre: sigma_xx = ratio density g (z - surface).
void expect_rest(const std::string& name, const std::string& cell, int order) {
  SCOPED_TRACE(fmt::format("{} {} order {}", name, cell, order));
  auto scene = read_scene(name, {"Mesh.cell=" + cell, fmt::format("Mesh.order={}", order)});
  model::Model model(scene, Tpetra::getDefaultComm());
  const auto report = model.step_to(1);
  ASSERT_TRUE(report.converged) << report.reason;
  const Outputs out(model);
  const Real weight = 2700 * 9.81;
  const int up = model.mesh().dim() - 1;
  for (Real u : out["displacement"].values)
    EXPECT_NEAR(u, 0, 1e-13);  // without initial stress, strains would be
                               // about 1e-1
  for (LocalIndex f = 0; f < model.mesh().n_owned_fracture_faces; ++f) {
    const auto traction = out.vector("traction local", f);
    EXPECT_NEAR(traction[0], 0.5 * weight * (model.mesh().fracture_faces[f].centre[up] - 3), 1e-9 * weight);
    EXPECT_NEAR(norm({0, traction[1], traction[2]}), 0, 1e-9 * weight);
    EXPECT_EQ(out.scalar("state", f), 1);
  }
}

TEST(InitialStress, BalancesGravity) {
  for (int order : {1, 2}) {
    for (const auto& cell : cells_of(2)) expect_rest("verification/lithostatic_2d.xml", cell, order);
    for (const auto& cell : cells_of(3)) expect_rest("verification/lithostatic_3d.xml", cell, order);
  }
}

/// Returns the mean over a fracture face of a polynomial of degree 2, by an exact rule.
template <class F>
Vector3 mean_on(const mesh::Mesh& mesh, const mesh::Mesh::FractureFace& face, const F& f) {
  const int n = mesh::n_face_corners(mesh.shape);
  std::vector<Vector3> corners;
  for (int k = 0; k < n; ++k) {
    Vector3 x{};
    std::copy_n(mesh.coordinates.begin() + face.nodes[0][k] * mesh.dim(), mesh.dim(), x.begin());
    corners.push_back(x);
  }
  Vector3 sum{};
  const auto add = [&](Real weight, const std::vector<int>& of) {
    Vector3 x{};
    for (int k : of)
      for (int i = 0; i < 3; ++i) x[i] += corners[k][i] / static_cast<Real>(of.size());
    const Vector3 value = f(x);
    for (int i = 0; i < 3; ++i) sum[i] += weight * value[i];
  };
  if (n == 2) {  // Simpson
    for (int k : {0, 1}) add(1.0 / 6, {k});
    add(4.0 / 6, {0, 1});
  } else if (n == 3) {
    for (int k : {0, 1, 2}) add(1.0 / 3, {k, (k + 1) % 3});
  } else {  // Simpson in both directions
    for (int k : {0, 1, 2, 3}) {
      add(1.0 / 36, {k});
      add(4.0 / 36, {k, (k + 1) % 4});
    }
    add(16.0 / 36, {0, 1, 2, 3});
  }
  return sum;
}

/// Quadratic stress XX, YY, ZZ, XY[, YZ, XZ], with the body force in equilibrium.
struct QuadraticStress {
  std::vector<std::string> components, body_force;

  /// Returns the components of sigma n as texts.
  std::vector<std::string> traction(const Vector3& n) const {
    const int dim = static_cast<int>(body_force.size());
    constexpr int place[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
    std::vector<std::string> result;
    for (int i = 0; i < dim; ++i) {
      result.emplace_back("0");
      for (int j = 0; j < dim; ++j) result[i] += fmt::format(" + ({:.17g})*({})", n[j], components[place[i][j]]);
    }
    return result;
  }
};

/// Checks rest under a stress that varies on faces, with an inclined fracture that reaches the free surface. On the
/// free surface, the deviation of the traction from its mean on a face is not balanced by a neighbouring face. Inside
/// the rock, deviations of neighbours cancel for linear stress.
void expect_rest_at_surface(const Discretisation& cells, const QuadraticStress& stress) {
  SCOPED_TRACE(cells.name());
  const int dim = static_cast<int>(stress.body_force.size());
  auto scene = read_scene(dim == 2 ? "verification/lithostatic_2d.xml" : "verification/lithostatic_3d.xml",
                          cells.with({"Materials.rock.shear modulus=100", "Materials.rock.Lame's first parameter=100",
                                      "Materials.joint.tangential stiffness=100",
                                      dim == 2 ? "Mesh.fractures.fracture.lower corner={1, 1}"
                                               : "Mesh.fractures.fracture.lower corner={1, 0, 1}",
                                      dim == 2 ? "Mesh.fractures.fracture.upper corner={1, 3}"
                                               : "Mesh.fractures.fracture.upper corner={1, 2, 3}"}));
  scene.bulk.gravity.clear();
  scene.bulk.lithostatic_stress.reset();
  scene.bulk.initial_stress = expressions(stress.components);
  scene.bulk.body_force = expressions(stress.body_force);
  const Vector3 axis = dim == 2 ? Vector3{0, 0, 1} : Vector3{1, 1, 0.5};
  scene.mesh.tips = "plain";  // quadrature in enriched cells is not exact for quadratic stress
  scene.mesh.rotation = 25;
  scene.mesh.rotation_axis = {axis[0], axis[1], axis[2]};
  const Matrix3 Q = rotation(25, axis);
  scene.boundary_conditions.clear();
  for (const std::string side : {"west", "east", "south"})
    prescribe(scene, side, first<std::string>(dim, {"0", "0", "0"}));
  if (dim == 3)
    for (const std::string side : {"north", "bottom"}) prescribe(scene, side, {"0", "0", "0"});
  load(scene, dim == 2 ? "north" : "top", stress.traction(times(Q, dim == 2 ? Vector3{0, 1, 0} : Vector3{0, 0, 1})));
  model::Model model(scene, Tpetra::getDefaultComm());
  expect_displacement(model, 1e-12, [](const auto&...) { return Vector3{}; });
  const Outputs out(model);
  for (LocalIndex f = 0; f < model.mesh().n_owned_fracture_faces; ++f) {
    const auto& face = model.mesh().fracture_faces[f];
    const auto texts = expressions(stress.traction(face.frame[0]));
    const auto mean = mean_on(model.mesh(), face, [&](const Vector3& x) {
      Vector3 traction{};
      for (int i = 0; i < dim; ++i) traction[i] = texts[i](x, 0);
      return traction;
    });
    const auto traction = out.vector("traction", f);
    EXPECT_GT(std::abs(dot(mean, face.frame[1])), 0.1);  // inclined to the principal stresses
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(traction[i], mean[i], 1e-10 * norm(mean));
    EXPECT_EQ(out.scalar("state", f), 1);
  }
}

TEST(InitialStress, FractureThatReachesTheSurface) {
  const QuadraticStress plane{{"-50 - 3*x^2 + 2*x*y - y^2", "-40 + x^2 - 2*y^2 - 4*x", "-30", "5 + x*y + 0.5*x^2 - y"},
                              {"5*x - 2*y + 1", "3*y - x"}};
  const QuadraticStress solid{
      {"-60 - x^2 + 2*y*z", "-50 - 2*y^2 + x*z", "-70 - z^2 + x*y", "3 + z^2/2 + x*y/4", "-2 + x^2/2", "4 + y^2/3"},
      {"1.75*x", "3.75*y", "2*z"}};
  for (const auto& cells : discretisations(2)) expect_rest_at_surface(cells, plane);
  for (const auto& cells : discretisations(3)) expect_rest_at_surface(cells, solid);
}

/// Definition of the initial stress of the upper block: by "y > height", "y >= height" or a region.
enum class Step { above, from, region };

/// Checks a rotated unit block with a fracture in the middle and the initial stress -p I in its upper half; the
/// boundary is fixed. With lambda + 2 G = 3000, rock moves along the normal by -p/6000 times its distance from the
/// boundary. The traction is -p/2 on both sides of every face, independent of rounding of its points to either side.
void expect_half_the_stress(const Discretisation& cells, int dim, Real degrees, Step step, bool swap) {
  SCOPED_TRACE(fmt::format("{} in {}D, {} degrees, step {}, {}", cells.name(), dim, degrees, static_cast<int>(step),
                           swap ? "swapped" : "as it is"));
  const Real p = 1.5, a = p / 6000;
  const Vector3 axis = dim == 2 ? Vector3{0, 0, 1} : Vector3{1, 0.3, 0.2};
  const Matrix3 Q = rotation(degrees, axis);
  const int up = dim - 1;
  const Vector3 n = times(Q, dim == 2 ? Vector3{0, 1, 0} : Vector3{0, 0, 1});
  auto scene = box_of_rock(cells, std::vector<Real>(dim, 1), std::vector<int>(dim, dim == 2 ? 8 : 4), "1");
  scene.materials["rock"].E = scene.materials["rock"].nu = std::nullopt;
  scene.materials["rock"].G = scene.materials["rock"].lambda = base::Expression(1000);
  scene.mesh.rotation = degrees;
  scene.mesh.rotation_axis = {axis[0], axis[1], axis[2]};
  std::vector<Real> middle(dim, 0), corner(dim, 1);
  middle[up] = 0.5;
  scene.mesh.regions["upper"] = {middle, corner};
  corner[up] = 0.5;
  std::vector<Real> normal(dim, 0);
  normal[up] = 1;
  scene.mesh.fractures["f"] = {middle, corner, normal, swap};
  scene.materials["joint"].type = "joint";
  scene.materials["joint"].friction_coefficient = base::Expression(10);
  scene.fractures["f"].material = "joint";
  const std::string height = fmt::format("({:.17g}*x + {:.17g}*y + {:.17g}*z)", n[0], n[1], n[2]);
  const auto number = fmt::format("{:.17g}", -p);
  const auto stressed = step == Step::region  ? number
                        : step == Step::above ? "(" + height + " > 0.5 ? " + number + " : 0)"
                                              : "(" + height + " >= 0.5 ? " + number + " : 0)";
  auto& stress = step == Step::region ? scene.regions["upper"].initial_stress : scene.bulk.initial_stress;
  stress = expressions(dim == 2 ? std::vector<std::string>{stressed, stressed, stressed, "0"}
                                : std::vector<std::string>{stressed, stressed, stressed, "0", "0", "0"});
  for (const std::string region : {"bulk", "upper"}) {
    const auto distance = region == "bulk" ? height : "(1 - " + height + ")";
    std::vector<std::string> u;
    for (int i = 0; i < dim; ++i) u.push_back(fmt::format("{:.17g}*{}", -a * n[i], distance));
    for (const std::string side : {"west", "east", "south", "north", "bottom", "top"})
      if ((dim == 3 || (side != "bottom" && side != "top")) &&
          side != (region == "bulk" ? (dim == 2 ? "north" : "top") : (dim == 2 ? "south" : "bottom")))
        prescribe(scene, side, u, region);
  }
  model::Model model(scene, Tpetra::getDefaultComm());
  expect_displacement(model, 1e-12, [&](const Vector3& x, const std::string& region) {
    const Real distance = region == "bulk" ? dot(n, x) : 1 - dot(n, x);
    return Vector3{-a * n[0] * distance, -a * n[1] * distance, -a * n[2] * distance};
  });
  const Outputs out(model);
  for (LocalIndex f = 0; f < model.mesh().n_owned_fracture_faces; ++f) {
    const auto traction = out.vector("traction local", f);
    EXPECT_NEAR(traction[0], -p / 2, 1e-12) << "face " << f;
    EXPECT_NEAR(norm({0, traction[1], traction[2]}), 0, 1e-12) << "face " << f;
  }
}

TEST(InitialStress, StepsAcrossAnInclinedFracture) {
  for (const int dim : {2, 3})
    for (const auto& cells : discretisations(dim))
      for (const Real degrees : {30, 45, 17})
        expect_half_the_stress(cells, dim, degrees, degrees == 45 ? Step::from : Step::above, false);
}

TEST(InitialStress, OfARegion) {
  for (const int dim : {2, 3})
    for (const bool swap : {false, true})
      expect_half_the_stress(discretisations(dim).front(), dim, 30, Step::region, swap);
}

/// The stress of a region replaces the lithostatic stress; here both are equal, so the rock is at rest.
TEST(InitialStress, OfARegionReplacesTheLithostatic) {
  auto scene = read_scene("verification/lithostatic_2d.xml");
  scene.mesh.regions["west"] = {{0, 0}, {1, 3}};
  scene.regions["west"].initial_stress =
      expressions({"0.5*2700*9.81*(y - 3)", "2700*9.81*(y - 3)", "0.5*2700*9.81*(y - 3)", "0"});
  model::Model model(scene, Tpetra::getDefaultComm());
  expect_displacement(model, 1e-13, [](const auto&...) { return Vector3{}; });
}

/// The initial state of a joint that closes does not depend on the choice of its side minus.
TEST(InitialStress, StepDoesNotAskForTheOrderOfSides) {
  std::vector<Real> jumps;
  for (const bool swap : {false, true}) {
    auto scene = read_scene("verification/lithostatic_2d.xml");
    scene.mesh.regions["west"] = {{0, 0}, {1, 3}};
    scene.regions["west"].initial_stress = expressions({"-2e5", "-2e5", "-2e5", "0"});
    scene.mesh.fractures["fracture"].swap_sides = swap;
    scene.materials["joint"].maximum_closure = base::Expression(0.1);
    scene.materials["joint"].normal_stiffness = base::Expression(1e6);
    model::Model model(scene, Tpetra::getDefaultComm());
    ASSERT_TRUE(model.step_to(1).converged);
    jumps.push_back(mean(model, Outputs(model)["jump local"], 0));
  }
  EXPECT_LT(jumps[0], -1e-3);
  EXPECT_NEAR(jumps[0], jumps[1], 1e-9 * std::abs(jumps[0]));
}

/// A fault with initial slip is at rest under the initial stress, with its dilation as additional opening.
TEST(InitialStress, AfterAPlasticJump) {
  auto scene = read_scene("verification/lithostatic_2d.xml", {"Materials.joint.dilation angle=5"});
  scene.fractures.at("fracture").plastic_jump = expressions({"-0.2"});
  model::Model model(scene, Tpetra::getDefaultComm());
  expect_displacement(model, 1e-13, [](const auto&...) { return Vector3{}; });
  const Outputs out(model);
  for (LocalIndex f = 0; f < model.mesh().n_owned_fracture_faces; ++f) {
    EXPECT_NEAR(out.vector("plastic jump local", f)[1], -0.2, 1e-12);
    EXPECT_NEAR(out.scalar("aperture", f), 0.2 * std::tan(5 * M_PI / 180), 1e-12);
    EXPECT_EQ(out.scalar("state", f), 1);
  }
}

/// Without the initial stress the same weight moves the rock; hence the test above is significant.
TEST(InitialStress, IsNeededForRest) {
  auto scene = read_scene("verification/lithostatic_2d.xml");
  scene.bulk.lithostatic_stress.reset();
  model::Model model(scene, Tpetra::getDefaultComm());
  ASSERT_TRUE(model.step_to(1).converged);
  Real largest = 0;
  for (Real u : Outputs(model)["displacement"].values) largest = std::max(largest, std::abs(u));
  EXPECT_TRUE(anywhere(*Tpetra::getDefaultComm(), largest > 1e-3));
}

}  // namespace
}  // namespace sprekk::tests
