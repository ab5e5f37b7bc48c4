// Flow along and across fractures, against exact solutions.
#include "../scenes.hpp"

namespace sprekk::tests {
namespace {

const char* const all_cells[] = {"triangle", "quadrilateral", "tetrahedron", "hexahedron"};
constexpr Real aperture = 1e-3, viscosity = 2;

bool is_flat(const std::string& cell) { return cell == "triangle" || cell == "quadrilateral"; }

/// The unit square or cube with fractures at y = 1/2, "a", and x = 1/2, "b"; closed on all sides.
model::Scene closed_box(const std::string& cell, bool with_b = true, int n = 4) {
  const bool flat = is_flat(cell);
  auto scene = read_scene(flat ? "flow/source_2d.xml" : "flow/source_3d.xml");
  scene.mesh.cell = cell;
  for (int& count : scene.mesh.cells) count = n;
  using Corner = std::vector<Real>;
  scene.mesh.fractures["a"] = {flat ? Corner{0, 0.5} : Corner{0, 0.5, 0}, flat ? Corner{1, 0.5} : Corner{1, 0.5, 1}};
  if (with_b)
    scene.mesh.fractures["b"] = {flat ? Corner{0.5, 0} : Corner{0.5, 0, 0}, flat ? Corner{0.5, 1} : Corner{0.5, 1, 1}};
  auto& joint = scene.materials["joint"];
  joint.type = "joint";
  joint.initial_aperture = aperture;
  for (const auto& [name, fracture] : scene.mesh.fractures) scene.fractures[name].material = "joint";
  scene.flow->source = 0;
  scene.flow->viscosity = viscosity;
  scene.boundary_conditions.clear();
  return scene;
}

/// A pressure on one side, of the rock and of fractures that end there, or of a fracture alone.
void hold(model::Scene& scene, const std::string& side, const std::string& pressure, const std::string& fracture = "") {
  auto& condition = scene.boundary_conditions[side];
  condition.boundary = side;
  condition.pressure = base::Expression(pressure);
  if (!fracture.empty()) condition.fracture = fracture;
}

/// What flows in at a side with a prescribed pressure. Collective.
Real inflow(model::Model& model, const std::string& condition) {
  for (const auto& reaction : model.system().reactions(model.state()))
    if (reaction.condition == condition) return reaction.force.at(0);
  ADD_FAILURE() << condition;
  return 0;
}

/// The largest difference from an exact vector or number on owned entities, over all ranks.
template <class Exact>
Real error(model::Model& model, const std::string& output, const Exact& exact) {
  const auto field = model.output(output);
  const auto& mesh = model.mesh();
  Real here = 0, all = 0;
  for (std::size_t e = 0; e < field.values.size() / field.n_components; ++e) {
    Vector3 x{};
    const auto cell = static_cast<LocalIndex>(e);
    const int n = mesh::n_corners(mesh.shape);
    for (int k = 0; k < n && field.entity == fields::Entity::cell; ++k)
      for (int i = 0; i < mesh.dim(); ++i) x[i] += mesh.coordinates[mesh.cells[cell * n + k] * mesh.dim() + i] / n;
    if (field.entity == fields::Entity::fracture_face) x = mesh.fracture_faces[e].centre;
    const auto value = exact(x, field.entity == fields::Entity::fracture_face ? mesh.fracture_faces[e].frame[0] : x);
    for (int c = 0; c < field.n_components; ++c)
      here = std::max(here, std::abs(field.values[e * field.n_components + c] - value[c]));
  }
  Teuchos::reduceAll(*mesh.comm, Teuchos::REDUCE_MAX, 1, &here, &all);
  return all;
}

/// Linear pressure in a network whose fractures all end on the boundary, under gravity, with any transmissivity: in
/// rock q = -k/mu (G - rho g), in fractures the part along them, times the aperture.
TEST(FractureFlow, LinearPressureThroughANetworkIsExact) {
  for (const std::string cell : all_cells)
    for (const Real k : {1e-3, 1e4}) {
      auto scene = closed_box(cell);
      const bool flat = is_flat(cell);
      scene.flow->density = 3;
      scene.bulk.gravity = flat ? std::vector<Real>{0, -10} : std::vector<Real>{0, 0, -10};
      scene.materials.at("joint").tangential_permeability = k;
      for (const std::string side : {"west", "east", "south", "north", "bottom", "top"})
        if (!flat || (side != "bottom" && side != "top")) hold(scene, side, flat ? "1+2*x-3*y" : "1+2*x-3*y+4*z");
      model::Model model(scene, Tpetra::getDefaultComm());
      ASSERT_TRUE(model.step_to(1).converged) << cell;
      const Vector3 drive = flat ? Vector3{2, -3 + 30, 0} : Vector3{2, -3, 4 + 30};
      const auto p = [&](const auto& x, const auto&) {
        return Vector3{1 + 2 * x[0] - 3 * x[1] + (flat ? 0 : 4 * x[2])};
      };
      EXPECT_LT(error(model, "pressure", p), 1e-11) << cell;
      EXPECT_LT(error(model, "fracture pressure", p), 1e-11) << cell;
      const auto velocity = [&](const auto&, const auto&) {
        return Vector3{-drive[0] / viscosity, -drive[1] / viscosity, -drive[2] / viscosity};
      };
      EXPECT_LT(error(model, "Darcy velocity", velocity), 1e-10) << cell;
      const auto flux = [&](const auto&, const auto& normal) {
        Vector3 along{};
        for (int i = 0; i < 3; ++i)
          along[i] = -aperture * k / viscosity *
                     (drive[i] - normal[i] * (drive[0] * normal[0] + drive[1] * normal[1] + drive[2] * normal[2]));
        return along;
      };
      EXPECT_LT(error(model, "fluid flux", flux), 1e-12 * k) << cell;
    }
}

/// Rock, fracture, rock in series: q = (p_west - p_east)/(mu (1/k + a/k_n)).
TEST(FractureFlow, AFractureAcrossTheFlowResists) {
  for (const std::string cell : all_cells)
    for (const Real k : {1e-10, 1e-3, 1.0, 1e10}) {
      auto scene = closed_box(cell);
      scene.materials.at("joint").normal_permeability = k;
      scene.materials.at("joint").tangential_permeability = k;
      hold(scene, "west", "1");
      hold(scene, "east", "0");
      scene.mesh.fractures.erase("a");
      scene.fractures.erase("a");
      model::Model model(scene, Tpetra::getDefaultComm());
      ASSERT_TRUE(model.step_to(1).converged) << cell;
      const Real q = 1 / (viscosity * (1 + aperture / k));
      const Real rounding = 1e-15 * (1 + k * aperture);  // of pressures near 1, times what conducts best
      EXPECT_NEAR(inflow(model, "west"), q, 1e-9 * q + 10 * rounding) << cell << ' ' << k;
      EXPECT_NEAR(inflow(model, "east"), -q, 1e-9 * q + 10 * rounding) << cell << ' ' << k;
      const auto half = [](const auto&, const auto&) { return Vector3{0.5}; };
      EXPECT_LT(error(model, "fracture pressure", half), 1e-9 + 10 * rounding) << cell << ' ' << k;
    }
}

/// Beside each other: Q = (k + a k_t)/mu dp/L, with k_t = a^2/12 where nothing is said, the cubic law.
TEST(FractureFlow, AFractureAlongTheFlowCarriesItsShare) {
  for (const std::string cell : all_cells)
    for (const Real k : {0.0, 1e-7, 1e13}) {
      auto scene = closed_box(cell, false);
      auto& joint = scene.materials.at("joint");
      joint.initial_aperture = 0.1;
      joint.residual_aperture = 0.5;
      if (k > 0) joint.tangential_permeability = k;
      hold(scene, "west", "1");
      hold(scene, "east", "0");
      model::Model model(scene, Tpetra::getDefaultComm());
      ASSERT_TRUE(model.step_to(1).converged) << cell;
      const Real Q = (1 + 0.5 * (k > 0 ? k : 0.25 / 12)) / viscosity;
      EXPECT_NEAR(inflow(model, "west") / Q, 1, 1e-11) << cell << ' ' << k;
      EXPECT_NEAR(inflow(model, "east") / Q, -1, 1e-11) << cell << ' ' << k;
    }
}

/// Fractures that the rock does not let out, held at their ends alone: of four branches of length 1/2 one is at 1, the
/// others are at 0, so the intersection is at 1/4.
TEST(FractureFlow, WhatFlowsIntoAnIntersectionFlowsOut) {
  for (const std::string cell : all_cells) {
    auto scene = closed_box(cell);
    auto& joint = scene.materials.at("joint");
    joint.normal_permeability = 1e-16;
    joint.tangential_permeability = 10;
    hold(scene, "west", "1", "a");
    hold(scene, "east", "0", "a");
    hold(scene, "south", "0", "b");
    hold(scene, "north", "0", "b");
    model::Model model(scene, Tpetra::getDefaultComm());
    ASSERT_TRUE(model.step_to(1).converged) << cell;
    const Real T = aperture * 10 / viscosity;
    EXPECT_NEAR(inflow(model, "west"), 1.5 * T, 1e-9 * T) << cell;
    for (const char* side : {"east", "south", "north"}) EXPECT_NEAR(inflow(model, side), -0.5 * T, 1e-9 * T) << cell;
    const auto p = [](const auto& x, const auto&) {
      return Vector3{0.25 + (x[0] < 0.5 ? 0.75 : -0.25) * std::abs(1 - 2 * x[0]) - 0.25 * std::abs(1 - 2 * x[1])};
    };
    EXPECT_LT(error(model, "fracture pressure", p), 1e-9) << cell;
  }
}

/// A fracture that the rock does not let out: fed at its west end, it loses through a conductance at its east end as
/// much to the pressure beyond. Of rock likewise.
TEST(FractureFlow, FluxesAndConductancesAtEnds) {
  for (const std::string cell : all_cells)
    for (const bool in_fracture : {true, false}) {
      auto scene = closed_box(cell, false);
      auto& joint = scene.materials.at("joint");
      joint.normal_permeability = 1e-16;
      joint.tangential_permeability = 10;
      hold(scene, "east", "7", in_fracture ? "a" : "");
      scene.boundary_conditions.at("east").conductance = base::Expression(0.25);
      auto& west = scene.boundary_conditions["west"];
      west.boundary = "west";
      west.flux = base::Expression(-3.0);
      if (in_fracture) west.fracture = "a";
      scene.flow->compressibility = 1e-30;  // or the pressure of the part that is not fed would be anything
      model::Model model(scene, Tpetra::getDefaultComm());
      ASSERT_TRUE(model.step_to(1).converged) << cell;
      const Real slope = 3 * viscosity / (in_fracture ? 10 : 1);
      const auto p = [&](const auto& x, const auto&) { return Vector3{7 + 3 / 0.25 + slope * (1 - x[0])}; };
      EXPECT_LT(error(model, in_fracture ? "fracture pressure" : "pressure", p), 1e-7) << cell << in_fracture;
    }
}

/// What is put into a fracture in a closed box is stored there and in the rock.
TEST(FractureFlow, StoresWhatIsPutIn) {
  for (const std::string cell : all_cells) {
    auto scene = closed_box(cell);
    scene.flow->compressibility = 0.5;
    scene.materials.at("rock").compressibility = 0.3;
    scene.materials.at("joint").initial_aperture = 0.2;
    scene.materials.at("joint").normal_permeability = 0.01;
    scene.fractures.at("a").source = base::Expression("2*t");
    model::Model model(scene, Tpetra::getDefaultComm());
    Real put_in = 0;
    for (const Real t : {0.5, 0.75, 1.5}) {
      const Real before = model.time();
      ASSERT_TRUE(model.step_to(t).converged) << cell;
      put_in += 2 * t * (t - before);
      const auto& mesh = model.mesh();
      Real here = 0, all = 0;
      const auto rock = model.output("pressure").values, fracture = model.output("fracture pressure").values;
      const Real volume = 1.0 / static_cast<Real>(mesh.n_global_cells);  // all cells have the same
      for (const Real p : rock) here += 0.3 * volume * p;
      for (std::size_t f = 0; f < fracture.size(); ++f) here += 0.5 * 0.2 * mesh.fracture_faces[f].area * fracture[f];
      Teuchos::reduceAll(*mesh.comm, Teuchos::REDUCE_SUM, 1, &here, &all);
      EXPECT_NEAR(all, put_in, 1e-11) << cell;
    }
  }
}

}  // namespace
}  // namespace sprekk::tests
