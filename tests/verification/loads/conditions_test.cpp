// Confining pressure, supports of points and edges, and in-situ stress by directions, compared with exact states.
#include "verification/loads/block.hpp"

namespace sprekk::tests {
namespace {

/// Adds a support of components at the nodes of a boundary between two corners.
void support(model::Scene& scene, const std::string& name, const std::string& boundary, const std::vector<Real>& lower,
             const std::vector<Real>& upper, const std::vector<std::string>& displacement) {
  auto& condition = scene.boundary_conditions[name];
  condition.boundary = boundary;
  condition.lower_corner = lower;
  condition.upper_corner = upper;
  condition.displacement = expressions(displacement);
}

void confine(model::Scene& scene, const std::string& boundary, const std::string& pressure) {
  auto& condition = scene.boundary_conditions[boundary + " confined"];
  condition.boundary = boundary;
  condition.confining_pressure = expression(pressure);
}

std::vector<std::string> sides(int dim) {
  std::vector<std::string> all = {"west", "east", "south", "north"};
  if (dim == 3) all.insert(all.end(), {"bottom", "top"});
  return all;
}

/// Block under equal pressure on all sides, turned by 30 degrees, with a statically determinate support at points. The
/// stress is -p I in its plane, and the reactions vanish.
TEST(ConfiningPressure, OnATurnedBlockConstrainedAtPoints) {
  constexpr Real p = 3;
  for (const int dim : {2, 3})
    for (const auto& cells : discretisations(dim)) {
      SCOPED_TRACE(cells.name());
      auto scene = box_of_rock(cells, std::vector<Real>(dim, 2), std::vector<int>(dim, 2), "1000");
      scene.materials["rock"].nu = base::Expression(0.2);
      scene.mesh.rotation = 30;
      scene.mesh.rotation_axis = {0, 0, 1};
      const Real c = std::cos(M_PI / 6), s = std::sin(M_PI / 6);
      const auto corner = [&](Real x, Real y) { return first<Real>(dim, {c * x - s * y, s * x + c * y, 0}); };
      for (const auto& side : sides(dim)) confine(scene, side, "3");
      support(scene, "foot", "west", corner(0, 0), corner(0, 0), first<std::string>(dim, {"0", "0", "0"}));
      support(scene, "second", "east", corner(2, 0), corner(2, 0), first<std::string>(dim, {"free", "0", "0"}));
      if (dim == 3) support(scene, "third", "west", corner(0, 2), {}, {"free", "free", "0"});
      if (dim == 3) scene.boundary_conditions["third"].upper_corner = corner(0, 2);
      model::Model model(scene, Tpetra::getDefaultComm());
      ASSERT_TRUE(model.step_to(1).converged);
      const auto stress = Outputs(model)["stress"].values;
      for (std::size_t k = 0; k < stress.size(); k += 6) {
        for (int i = 0; i < dim; ++i) EXPECT_NEAR(stress[k + i], -p, 1e-10);
        for (int i = 3; i < 6; ++i) EXPECT_NEAR(stress[k + i], 0, 1e-10);
      }
      for (const auto& reaction : model.system().reactions(model.state()))
        for (const Real force : reaction.force) EXPECT_NEAR(force, 0, 1e-9);
    }
}

/// Block of two parts on an elastic foundation: under a pressure p on its top it settles by p/k.
TEST(ElasticFoundation, HoldsABlockWithAJoint) {
  constexpr Real k = 50, p = 3, E = 1000;
  for (const int dim : {2, 3})
    for (const auto& cells : discretisations(dim)) {
      SCOPED_TRACE(cells.name());
      const int up = dim - 1;
      auto scene = box_of_rock(cells, std::vector<Real>(dim, 2), std::vector<int>(dim, 2), "1000");
      auto lower = std::vector<Real>(dim, 0), upper = std::vector<Real>(dim, 2);
      lower[up] = upper[up] = 1;
      scene.mesh.fractures["joint"] = {lower, upper, {}, false};
      auto& joint = scene.materials["rough"];
      joint.type = "joint";
      joint.tangential_stiffness = base::Expression(1e3);
      joint.friction_coefficient = base::Expression(0.6);
      scene.fractures["joint"].material = "rough";
      const std::string foot = dim == 2 ? "south" : "bottom", top = dim == 2 ? "north" : "top";
      auto& springs = scene.boundary_conditions["springs"];
      springs.boundary = foot;
      springs.foundation_stiffness.assign(dim, k);
      confine(scene, top, "3");
      model::Model model(scene, Tpetra::getDefaultComm());
      expect_displacement(model, 1e-11, [&](const Vector3& x, const std::string&) {
        Vector3 u{};
        u[up] = -p / k - p * x[up] / E;
        return u;
      });
    }
}

/// Block turned by 30 degrees between springs along the normals of its lower sides and a pressure on the others.
TEST(ElasticFoundation, ActsAlongTheNormalOfATurnedSide) {
  constexpr Real k = 50, p = 3, E = 1000;
  const Real c = std::cos(M_PI / 6), s = std::sin(M_PI / 6);
  for (const int dim : {2, 3})
    for (const auto& cells : discretisations(dim)) {
      SCOPED_TRACE(cells.name());
      auto scene = box_of_rock(cells, std::vector<Real>(dim, 2), std::vector<int>(dim, 2), "1000");
      scene.mesh.rotation = 30;
      scene.mesh.rotation_axis = {0, 0, 1};
      for (int i = 0; i < dim; ++i) {
        auto& springs = scene.boundary_conditions[sides(dim)[2 * i]];
        springs.boundary = sides(dim)[2 * i];
        springs.foundation_stiffness = {k};
        confine(scene, sides(dim)[2 * i + 1], "3");
      }
      model::Model model(scene, Tpetra::getDefaultComm());
      expect_displacement(model, 1e-11, [&](const Vector3& x, const std::string&) {
        const Real u = -p / k - p / E * (c * x[0] + s * x[1]), v = -p / k - p / E * (c * x[1] - s * x[0]);
        return Vector3{c * u - s * v, s * u + c * v, dim == 3 ? -p / k - p / E * x[2] : 0};
      });
    }
}

/// Springs that are softer under one half (a region): the block rotates until forces and moments are balanced.
TEST(ElasticFoundation, TurnsABlockOnUnequalSprings) {
  constexpr Real k = 40, p = 3;
  for (const auto& cells : discretisations(2)) {
    SCOPED_TRACE(cells.name());
    auto scene = box_of_rock(cells, {2, 2}, {2, 2}, "1e8");  // rigid compared with the springs
    scene.mesh.regions["right"] = {{1, 0}, {2, 2}};
    const std::pair<const char*, Real> halves[] = {{"bulk", k}, {"right", k / 3}};
    for (const auto& [region, stiffness] : halves) {
      auto& springs = scene.boundary_conditions[region];
      springs.boundary = "south";
      springs.region = region;
      springs.foundation_stiffness = {stiffness, stiffness};
    }
    confine(scene, "north", "3");
    // v(x) = a + b x: the integrals of k v and k v x over 0..2 are -2 p, with k and k/3 on the halves
    const Real m0 = k + k / 3, m1 = k / 2 + k / 3 * 1.5, m2 = k / 3 + k / 3 * 7 / 3;
    const Real b = (-2 * p * m0 + 2 * p * m1) / (m0 * m2 - m1 * m1), a = (-2 * p - m1 * b) / m0;
    model::Model model(scene, Tpetra::getDefaultComm());
    expect_displacement(model, 1e-6, [&](const Vector3& x, const std::string&) {
      return Vector3{-b * x[1], a + b * x[0], 0};
    });
  }
}

/// Plate with a hinge along one edge: a non-uniform pressure equals the corresponding traction.
TEST(ConfiningPressure, IsTheTractionAlongTheNormal) {
  const auto displacements = [](bool by_pressure) {
    auto scene = box_of_rock({"hexahedron", 1}, {2, 1, 1}, {4, 2, 2}, "10");
    support(scene, "hinge", "bottom", {0, 0, 0}, {0, 1, 0}, {"0", "0", "0"});
    support(scene, "roller", "bottom", {2, 0, 0}, {2, 1, 0}, {"free", "free", "0"});
    if (by_pressure)
      confine(scene, "top", "(1 + x)*t");
    else
      load(scene, "top", {"0", "0", "-(1 + x)*t"});
    model::Model model(scene, Tpetra::getDefaultComm());
    EXPECT_TRUE(model.step_to(1).converged);
    EXPECT_TRUE(model.step_to(2).converged);
    return Outputs(model)["displacement"].values;
  };
  const auto by_pressure = displacements(true), by_traction = displacements(false);
  Real largest = 0;
  for (std::size_t k = 0; k < by_pressure.size(); ++k) {
    EXPECT_NEAR(by_pressure[k], by_traction[k], 1e-12);
    largest = std::max(largest, std::abs(by_pressure[k]));
  }
  EXPECT_TRUE(anywhere(*Tpetra::getDefaultComm(), largest > 0.1));
}

/// Rock at rest between fixed sides: with the weight as vertical gradient, inner displacements vanish. On vertical
/// planes across and along the azimuth act SHmax and Shmin, without shear.
TEST(InSituStress, ActsAcrossAndAlongItsAzimuth) {
  for (const Real azimuth : {0.0, 30.0, 135.0})
    for (const auto& cells : {Discretisation{"hexahedron", 1}, Discretisation{"tetrahedron", 2}}) {
      SCOPED_TRACE(fmt::format("{} {}", cells.name(), azimuth));
      auto scene = box_of_rock(cells, {3, 3, 3}, {3, 3, 3}, "1000");
      scene.materials["rock"].density = base::Expression(2);
      scene.bulk.gravity = {0, 0, -10};
      auto& stress = scene.bulk.in_situ_stress.emplace();
      stress.datum = 4;
      stress.vertical = {1, 20};
      stress.largest = {3, 30};
      stress.smallest = {2, 15};
      stress.azimuth = azimuth;
      for (const auto& side : sides(3)) prescribe(scene, side, {"0", "0", "0"});
      model::Model model(scene, Tpetra::getDefaultComm());
      ASSERT_TRUE(model.step_to(1).converged);
      const Outputs out(model);
      for (const Real u : out["displacement"].values) EXPECT_NEAR(u, 0, 1e-12);
      const auto& values = out["stress"].values;
      const Real a = azimuth * M_PI / 180;
      const Vector3 along = {std::sin(a), std::cos(a), 0}, across = {std::cos(a), -std::sin(a), 0};
      for (LocalIndex c = 0; c < model.mesh().n_owned_cells; ++c) {
        const Real* const s = &values[6 * c];
        const Matrix3 sigma = {{{s[0], s[3], s[5]}, {s[3], s[1], s[4]}, {s[5], s[4], s[2]}}};
        const Real depth = 4 - mesh::cell_centre(model.mesh(), c)[2];
        EXPECT_NEAR(dot(along, times(sigma, along)), -(3 + 30 * depth), 1e-9);
        EXPECT_NEAR(dot(across, times(sigma, across)), -(2 + 15 * depth), 1e-9);
        EXPECT_NEAR(dot(across, times(sigma, along)), 0, 1e-9);
        EXPECT_NEAR(s[2], -(1 + 20 * depth), 1e-9);
      }
    }
}

/// In a section from west to east, SHmax is in the section or normal to it.
TEST(InSituStress, OfASection) {
  for (const Real azimuth : {0.0, 90.0, 270.0}) {
    auto scene = box_of_rock({"quadrilateral", 1}, {2, 2}, {2, 2}, "1000");
    auto& stress = scene.bulk.in_situ_stress.emplace();
    stress.vertical = {5, 0};
    stress.largest = {7, 0};
    stress.smallest = {4, 0};
    stress.azimuth = azimuth;
    for (const auto& side : sides(2)) prescribe(scene, side, {"0", "0"});
    model::Model model(scene, Tpetra::getDefaultComm());
    ASSERT_TRUE(model.step_to(1).converged);
    const auto values = Outputs(model)["stress"].values;
    for (std::size_t k = 0; k < values.size(); k += 6) {
      EXPECT_NEAR(values[k], azimuth == 0 ? -4 : -7, 1e-12);
      EXPECT_NEAR(values[k + 1], -5, 1e-12);
      EXPECT_NEAR(values[k + 2], azimuth == 0 ? -7 : -4, 1e-12);
      EXPECT_NEAR(values[k + 3], 0, 1e-12);
    }
  }
}

}  // namespace
}  // namespace sprekk::tests
