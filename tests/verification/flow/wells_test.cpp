// Wells, compared with flow to a line in an infinite plane or space.
#include "boxes.hpp"

namespace sprekk::tests {
namespace {

constexpr Real radius = 1e-3, mu = 2;

/// Returns a square or cube of rock with edges of length 1 around the origin (3D: height from 0 to 1).
model::Scene box(const std::string& cell, int n, const std::string& scheme) {
  const bool flat = is_flat(cell);
  auto scene = read_scene(flat ? "flow/source_2d.xml" : "flow/source_3d.xml");
  scene.mesh.cell = cell;
  scene.mesh.cells = flat ? std::vector<int>{n, n} : std::vector<int>{n, n, cell == "tetrahedron" ? n : 3};
  scene.mesh.lower_corner = flat ? std::vector<Real>{-0.5, -0.5} : std::vector<Real>{-0.5, -0.5, 0};
  scene.mesh.upper_corner = flat ? std::vector<Real>{0.5, 0.5} : std::vector<Real>{0.5, 0.5, 1};
  scene.flow->source = 0;
  scene.flow->scheme = scheme;
  scene.flow->viscosity = mu;
  scene.boundary_conditions.clear();
  return scene;
}

void prescribe_sides(model::Scene& scene, const std::string& pressure) {
  for (const std::string side : {"west", "east", "south", "north"}) constrain(scene, side, pressure);
}

physics::WellSection& add_well(model::Scene& scene, const std::vector<Real>& points) {
  auto& well = scene.flow->wells["well"];
  well.points = points;
  well.radius = radius;
  return well;
}

/// Returns a total of the well, e.g. "rate".
Real total(model::Model& model, const std::string& what) {
  for (const auto& one : model.system().totals(model.state()))
    if (one.names == std::vector<std::string>{"wells", "well", what}) return one.value;
  ADD_FAILURE() << what;
  return 0;
}

struct Rock {
  std::string cell, scheme;
  int n;
  Real maximum;  ///< largest error
};

/// Thiem (1906): p - p_w = Q mu/(2 pi k h) ln(r/r_w), here with p_w = 0 and Q mu/(2 pi k h) = 1. Tests the pressure in
/// the well for the rate Q, and the rate for p_w = 0. Anisotropic rock: distances of Peaceman (1983). The well is in
/// the middle of a cell or on an edge.
TEST(Wells, ThiemsSolution) {
  for (const auto& [cell, scheme, n, maximum] : std::vector<Rock>{{"quadrilateral", "tpfa", 21, 1e-3},
                                                                  {"quadrilateral", "tpfa", 61, 1e-4},
                                                                  {"quadrilateral", "mimetic", 21, 0.02},
                                                                  {"triangle", "rt0", 21, 0.02},
                                                                  {"triangle", "rt0", 20, 0.02},
                                                                  {"hexahedron", "tpfa", 11, 4e-3},
                                                                  {"hexahedron", "mimetic", 11, 0.02},
                                                                  {"tetrahedron", "rt0", 9, 0.03}})
    for (const Real ratio : {1.0, 4.0})
      for (const bool by_rate : {true, false}) {
        const bool flat = is_flat(cell);
        auto scene = box(cell, n, scheme);
        auto& k = scene.materials.at("rock").permeability;
        k = {base::Expression(ratio), base::Expression(1)};
        if (!flat) k.emplace_back(1);
        const Real a = std::pow(ratio, 0.25);  // isotropic in x/a and a y
        prescribe_sides(
            scene, fmt::format("0.5*log((x/{0:.17g})^2+(y*{0:.17g})^2) - log({1:.17g})", a, radius * (a + 1 / a) / 2));
        auto& well = add_well(scene, flat ? std::vector<Real>{0, 0} : std::vector<Real>{0, 0, 0, 0, 0, 1});
        const Real Q = 2 * M_PI * std::sqrt(ratio) / mu;
        (by_rate ? well.rate : well.pressure) = base::Expression(by_rate ? -Q : 0);
        model::Model model(scene, Tpetra::getDefaultComm());
        ASSERT_TRUE(model.step_to(1).converged) << cell;
        const Real drawdown = std::log(0.5 / radius);
        const auto where = fmt::format("{} {} {}", cell, scheme, ratio);
        EXPECT_NEAR(total(model, "pressure") / drawdown, 0, by_rate ? maximum : 1e-15) << where;
        EXPECT_NEAR(total(model, "rate") / -Q, 1, by_rate ? 1e-12 : 1.1 * maximum) << where;
        EXPECT_NEAR(total(model, "in rock") / total(model, "rate"), 1, 1e-12);
      }
}

/// Well across a fracture in the middle of almost impermeable rock: radial flow in a square with exact pressures on
/// its boundary.
TEST(Wells, InAFracture) {
  for (const std::string cell : {"tetrahedron", "hexahedron"})
    for (const bool oblique : {false, true}) {
      auto scene = box(cell, 11, "auto");
      scene.mesh.cells[2] = 8;
      scene.materials.at("rock").permeability = {base::Expression(1e-14)};
      scene.mesh.fractures["plane"] = {{-0.5, -0.5, 0.5}, {0.5, 0.5, 0.5}};
      scene.fractures["plane"].material = "joint";
      auto& joint = scene.materials["joint"];
      joint.type = "joint";
      joint.initial_aperture = aperture;
      joint.tangential_permeability = 10;
      const Real T = aperture * 10 / mu, slant = oblique ? std::sqrt(2.0) : 1;
      prescribe_sides(scene, fmt::format("0.5*log(x^2+y^2) - log({:.17g})", radius * (1 + slant) / 2));
      const Real lean = oblique ? 0.25 : 0;
      auto& well = add_well(scene, {0, -lean, 0.25, 0, lean, 0.75});
      well.pressure = base::Expression(0);
      model::Model model(scene, Tpetra::getDefaultComm());
      ASSERT_TRUE(model.step_to(1).converged) << cell;
      EXPECT_NEAR(total(model, "in plane") / (-2 * M_PI * T), 1, 0.02) << cell << oblique;
      EXPECT_NEAR(total(model, "rate"), total(model, "in plane"), 1e-10 * T) << cell << oblique;
    }
}

/// In 2D, half of the injected fluid flows to each side of the well along the fracture: p - p_end = Q l/(2 T).
TEST(Wells, OnAFractureIn2D) {
  for (const std::string cell : {"triangle", "quadrilateral"}) {
    auto scene = closed_box(cell, false);
    scene.mesh.cells = {5, 4};
    scene.materials.at("rock").permeability = {base::Expression(1e-14)};
    auto& joint = scene.materials.at("joint");
    joint.tangential_permeability = 10;
    constrain(scene, "west", "7", "a");
    constrain(scene, "east", "7", "a");
    auto& well = add_well(scene, {0.5, 0.5});
    well.rate = base::Expression(3);
    model::Model model(scene, Tpetra::getDefaultComm());
    ASSERT_TRUE(model.step_to(1).converged) << cell;
    EXPECT_NEAR(total(model, "in a"), 3, 1e-12) << cell;
    EXPECT_NEAR(total(model, "in rock"), 0, 1e-12) << cell;
    const Real T = aperture * 10 / viscosity;
    EXPECT_NEAR(total(model, "pressure") / (7 + 3 * (0.5 + radius) / (2 * T)), 1, 1e-9) << cell;
  }
}

/// Compressible fluid at rest under gravity: the pressure at the first point equals that in the rock. Nothing flows
/// along a well of two parts through three layers of cells and a fracture. One part is on faces between the layers.
TEST(Wells, AtRestNothingFlows) {
  for (const std::string cell : {"tetrahedron", "hexahedron"}) {
    auto scene = box(cell, 4, "auto");
    scene.flow->density = 0.5;
    scene.flow->compressibility = 2;
    scene.bulk.gravity = {0, 0, -0.5};  // then 1/e = 1 - (1 - z)/2
    scene.mesh.cells[2] = 4;
    scene.mesh.fractures["plane"] = {{-0.5, -0.5, 0.25}, {0.5, 0.5, 0.25}};
    scene.fractures["plane"].material = "joint";
    auto& joint = scene.materials["joint"];
    joint.type = "joint";
    joint.initial_aperture = aperture;
    constrain(scene, "top", "0");
    auto& well = add_well(scene, {0, 0, 0.9, 0, 0, 0.4, 0.25, 0.2, 0.1});
    well.pressure = base::Expression(-std::log(1 - 0.05) / 2);
    model::Model model(scene, Tpetra::getDefaultComm());
    ASSERT_TRUE(model.step_to(1e15).converged) << cell;
    EXPECT_NEAR(total(model, "rate"), 0, 1e-10) << cell;
    well.pressure.reset();
    well.rate = base::Expression(0);
    model::Model closed(scene, Tpetra::getDefaultComm());
    ASSERT_TRUE(closed.step_to(1e15).converged) << cell;
    EXPECT_NEAR(total(closed, "pressure"), -std::log(1 - 0.05) / 2, 1e-10) << cell;
  }
}

/// The volume injected by a well into a closed box is stored there, for wells through any cells and of several parts.
TEST(Wells, PutsInItsRate) {
  auto scene = box("tetrahedron", 4, "auto");
  scene.materials.at("rock").compressibility = 0.4;
  add_well(scene, {0, 0, 0.9, 0, 0, 0.4, 0.25, 0.2, 0.1}).rate = base::Expression("6*t");
  model::Model model(scene, Tpetra::getDefaultComm());
  ASSERT_TRUE(model.step_to(0.5).converged);
  const auto p = model.output("pressure").values;
  Real here = 0, all = 0;
  for (const Real value : p) here += 0.4 * value / static_cast<Real>(model.mesh().n_global_cells);
  Teuchos::reduceAll(*model.mesh().comm, Teuchos::REDUCE_SUM, 1, &here, &all);
  EXPECT_NEAR(all, 3 * 0.5, 1e-12);
}

std::string refusal(const model::Scene& scene) {
  try {
    model::Model model(scene, Tpetra::getDefaultComm());
  } catch (const Error& error) {
    return error.what();
  }
  return "none";
}

TEST(Wells, WrongOnesAreRefused) {
  auto scene = box("tetrahedron", 4, "auto");
  constrain(scene, "top", "0");
  auto& well = add_well(scene, {0, 0, 0.5, 0, 0, 1.5});
  well.rate = base::Expression(1);
  EXPECT_NE(refusal(scene).find("only 0.5 of 1 m are inside of the domain"), std::string::npos) << refusal(scene);
  well.points = {0, 0, 0.1, 0, 0, 0.9};
  well.radius = 0.3;
  EXPECT_NE(refusal(scene).find("\"radius\": is 0.3, too large"), std::string::npos) << refusal(scene);
  well.radius = radius;
  well.points = {0, 0, 0.1};
  EXPECT_NE(refusal(scene).find("must have three for each"), std::string::npos) << refusal(scene);
  well.points = {0, 0, 0.1, 0, 0, 0.9};
  well.pressure = base::Expression(1);
  EXPECT_NE(refusal(scene).find("either \"rate\" or \"pressure\""), std::string::npos) << refusal(scene);
  well.pressure.reset();
  well.points = {-0.4, 0, 0.5, 0.4, 0, 0.5};
  scene.mesh.cells = {4, 4, 4};
  scene.mesh.fractures["plane"] = {{-0.5, -0.5, 0.5}, {0.5, 0.5, 0.5}};
  scene.fractures["plane"].material = "joint";
  auto& joint = scene.materials["joint"];
  joint.type = "joint";
  joint.initial_aperture = aperture;
  EXPECT_NE(refusal(scene).find("lies in the fracture \"plane\""), std::string::npos) << refusal(scene);
  auto flat = box("triangle", 4, "auto");
  constrain(flat, "west", "0");
  add_well(flat, {2, 0}).rate = base::Expression(1);
  EXPECT_NE(refusal(flat).find("lies outside of the domain"), std::string::npos) << refusal(flat);
}

}  // namespace
}  // namespace sprekk::tests
