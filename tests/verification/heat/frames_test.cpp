// A problem of rock, fluid and heat with a slipping fracture: equal results after rotation and in other units.
#include "warm_boxes.hpp"

namespace sprekk::tests {
namespace {

/// Sizes of the units in m, Pa, s and K.
struct Units {
  const char* name;
  Real length = 1, stress = 1, time = 1, temperature = 1;
};

/// Returns a block of 10 m under compression and shear, with a fracture through it that slips and dilates. Warm water
/// at 3 MPa enters in the west and leaves in the east; other sides are closed.
model::Scene block(const std::string& cell, const Units& u) {
  auto scene = closed_box(cell, false);
  const int dim = is_flat(cell) ? 2 : 3;
  auto& fracture = scene.mesh.fractures.at("a");
  for (auto* corner :
       {&scene.mesh.lower_corner, &scene.mesh.upper_corner, &fracture.lower_corner, &fracture.upper_corner})
    for (Real& x : *corner) x *= 10 / u.length;
  const Real heat = u.stress / u.temperature, conductivity = heat * u.length * u.length / u.time;
  scene.flow->rigid_rock = false;
  scene.flow->viscosity = 1e-3 / (u.stress * u.time);
  scene.flow->compressibility = 4e-10 * u.stress;
  auto& rock = scene.materials.at("rock");
  rock.G = Expression(12e9 / u.stress);
  rock.lambda = Expression(8e9 / u.stress);
  rock.biot = 0.7;
  rock.porosity = 0.1;
  rock.compressibility = 1e-11 * u.stress;
  rock.permeability = {Expression(1e-15 / (u.length * u.length))};
  rock.thermal_expansion = Expression(1e-5 * u.temperature);
  auto& joint = scene.materials.at("joint");
  joint.friction_coefficient = Expression(0.6);
  joint.tangential_stiffness = Expression(5e9 / u.stress * u.length);
  joint.dilation_angle = Expression(5);
  joint.maximum_closure = Expression(2e-4 / u.length);
  joint.normal_stiffness = Expression(30e9 / u.stress * u.length);
  joint.initial_aperture = Expression(5e-4 / u.length);
  joint.filling_conductivity = Expression(0.6 / conductivity);
  warm(scene, 350 / u.temperature, 2.5 / conductivity, 2.2e6 / heat, 4.2e6 / heat);
  scene.heat->fluid_expansion = 4e-4 * u.temperature;
  scene.heat->of_friction = true;
  constrain(scene, "west", fmt::format("{:.17g}", 3e6 / u.stress));
  constrain(scene, "east", "0");
  prescribe_temperature(scene, "west", fmt::format("{:.17g}", 300 / u.temperature));
  prescribe_temperature(scene, "east", fmt::format("{:.17g}", 350 / u.temperature));
  auto &below = scene.boundary_conditions["floor"], &above = scene.boundary_conditions["lid"];
  below.boundary = "south";
  below.displacement.assign(dim, Expression(0));
  above.boundary = "north";
  for (int i = 0; i < dim; ++i) {
    const Real per_time = (i == 0 ? 0.01 : i == 1 ? -0.002 : 0.004) / 1e6 * u.time;
    above.displacement.emplace_back(fmt::format("{:.17g}*t", per_time / u.length));
  }
  return scene;
}

/// Frame-independent values of owned entities, and the iterations of all steps.
struct Solution {
  std::map<std::string, std::vector<Real>> values;
  std::vector<int> iterations;
};

Solution solution_of(const model::Scene& scene, const Units& u) {
  model::Model model(scene, Tpetra::getDefaultComm());
  Solution found;
  for (const Real t : {0.5e6, 1e6, 2e6}) {
    const auto report = model.step_to(t / u.time);
    EXPECT_TRUE(report.converged) << report.reason;
    found.iterations.push_back(report.newton_iterations);
  }
  for (const auto& [name, unit] : {std::pair("temperature", u.temperature),
                                   {"fracture temperature", u.temperature},
                                   {"pressure", u.stress},
                                   {"fracture pressure", u.stress},
                                   {"slip", u.length},
                                   {"opening", u.length},
                                   {"thermal stress", u.stress}}) {
    auto& values = found.values[name];  // creates the entry also on ranks without entities
    for (const Real value : model.output(name).values) values.push_back(value * unit);
  }
  const auto traction = model.output("traction local").values;
  const int dim = model.mesh().dim();
  auto &normal = found.values["normal traction"], &shear = found.values["shear traction"];
  for (std::size_t f = 0; f * dim < traction.size(); ++f) {
    normal.push_back(traction[f * dim] * u.stress);
    Real square = 0;
    for (int i = 1; i < dim; ++i) square += std::pow(traction[f * dim + i] * u.stress, 2);
    shear.push_back(std::sqrt(square));
  }
  return found;
}

/// Compares all values, within `tolerance` of the largest; iterations may differ by one. Collective.
void expect_same(const Solution& one, const Solution& other, Real tolerance) {
  for (const auto& [name, values] : one.values) {
    const auto& others = other.values.at(name);
    ASSERT_EQ(values.size(), others.size()) << name;
    Real here = 0, size = 0;
    for (const Real value : values) here = std::max(here, std::abs(value));
    Teuchos::reduceAll(*Tpetra::getDefaultComm(), Teuchos::REDUCE_MAX, 1, &here, &size);
    EXPECT_GT(size, 0) << name;
    for (std::size_t k = 0; k < values.size(); ++k) EXPECT_NEAR(values[k], others[k], tolerance * size) << name << k;
  }
  for (std::size_t k = 0; k < one.iterations.size(); ++k) EXPECT_NEAR(one.iterations[k], other.iterations[k], 1) << k;
}

/// Checks that the fracture slips, opens and cools. Collective.
void expect_change(const Solution& found) {
  Real here[2] = {0, 400}, slip = 0, coldest = 0;
  for (const Real s : found.values.at("slip")) here[0] = std::max(here[0], s);
  for (const Real T : found.values.at("fracture temperature")) here[1] = std::min(here[1], T);
  const auto& comm = *Tpetra::getDefaultComm();
  Teuchos::reduceAll(comm, Teuchos::REDUCE_MAX, 1, &here[0], &slip);
  Teuchos::reduceAll(comm, Teuchos::REDUCE_MIN, 1, &here[1], &coldest);
  EXPECT_GT(slip, 5e-3);
  EXPECT_LT(coldest, 340);
}

TEST(ThermoPoroelasticity, UnitsDoNotMatter) {
  for (const std::string cell : all_cells) {
    SCOPED_TRACE(cell);
    const auto known = solution_of(block(cell, {"m, Pa, s, K"}), {"m, Pa, s, K"});
    expect_change(known);
    for (const Units& u : {Units{"km, GPa, d, K", 1e3, 1e9, 86400, 1},
                           {"mm, MPa, ms, K", 1e-3, 1e6, 1e-3, 1},
                           {"m, Pa, s, 100 K", 1, 1, 1, 100}}) {
      SCOPED_TRACE(u.name);
      expect_same(known, solution_of(block(cell, u), u), 1e-8);
    }
  }
}

TEST(ThermoPoroelasticity, FramesDoNotMatter) {
  for (const std::string cell : all_cells) {
    SCOPED_TRACE(cell);
    const auto scene = block(cell, {"m"});
    const auto known = solution_of(scene, {"m"});
    for (const Real degrees : {33.0, -140.0}) {
      SCOPED_TRACE(degrees);
      auto turned = scene;
      turn(turned, degrees, is_flat(cell) ? Vector3{0, 0, 1} : Vector3{1, 2, -1});
      expect_same(known, solution_of(turned, {"m"}), 1e-8);
    }
  }
}

}  // namespace
}  // namespace sprekk::tests
