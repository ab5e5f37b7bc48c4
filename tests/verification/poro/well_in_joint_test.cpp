// Wells in opening joints: pressures and rates depend on the present aperture.
#include "../flow/boxes.hpp"

namespace sprekk::tests {
namespace {

constexpr Real radius = 0.01, wide = 1e-2, mu = viscosity;
/// Returns the transmissivity of smooth walls. T, for the final aperture, is a thousand times the initial value.
constexpr Real T_of(Real aperture) { return aperture * aperture * aperture / (12 * mu); }
constexpr Real T = T_of(wide);

/// Returns stiff rock around the origin with a joint in its middle, with the initial aperture `aperture`. The north
/// side (3D: top) moves in the first second until the aperture is `wide`.
model::Scene parted_box(const std::string& cell, Real permeability) {
  const bool flat = is_flat(cell);
  auto scene = read_scene(flat ? "flow/source_2d.xml" : "flow/source_3d.xml");
  scene.mesh.cell = cell;
  scene.mesh.cells = flat ? std::vector<int>{5, 4} : std::vector<int>{7, 7, 4};
  scene.mesh.lower_corner = flat ? std::vector<Real>{-0.5, -0.5} : std::vector<Real>{-0.5, -0.5, -0.5};
  scene.mesh.upper_corner = flat ? std::vector<Real>{0.5, 0.5} : std::vector<Real>{0.5, 0.5, 0.5};
  scene.mesh.fractures["a"] = {flat ? std::vector<Real>{-0.5, 0} : std::vector<Real>{-0.5, -0.5, 0},
                               flat ? std::vector<Real>{0.5, 0} : std::vector<Real>{0.5, 0.5, 0}};
  scene.fractures["a"].material = "joint";
  auto& rock = scene.materials.at("rock");
  rock.E = base::Expression(1e9);
  rock.nu = base::Expression(0.2);
  rock.biot = 0;
  rock.permeability = {base::Expression(permeability)};
  auto& joint = scene.materials["joint"];
  joint.type = "joint";
  joint.friction_coefficient = base::Expression(0.6);
  joint.tangential_stiffness = base::Expression(1e9);
  joint.initial_aperture = base::Expression(aperture);
  joint.normal_permeability = base::Expression(1e9);
  scene.flow->rigid_rock = false;
  scene.flow->source = 0;
  scene.flow->viscosity = mu;
  scene.boundary_conditions.clear();
  const int dim = flat ? 2 : 3;
  auto &floor = scene.boundary_conditions["floor"], &lid = scene.boundary_conditions["lid"];
  floor.boundary = flat ? "south" : "bottom";
  floor.displacement.assign(dim, base::Expression(0));
  lid.boundary = flat ? "north" : "top";
  lid.displacement = floor.displacement;
  lid.displacement.back() = base::Expression(fmt::format("{:.17g}*min(t, 1)", wide - aperture));
  auto& well = scene.flow->wells["well"];
  well.points = flat ? std::vector<Real>{0, 0} : std::vector<Real>{0, 0, -0.25, 0, 0, 0.25};
  well.radius = radius;
  return scene;
}

void prescribe_rim(model::Scene& scene, const std::string& pressure, bool flat) {
  for (const std::string side : {"west", "east", "south", "north"})
    if (!flat || side == "west" || side == "east") constrain(scene, side, pressure);
}

/// Returns the totals of the well, e.g. "rate", after two long steps, when storage changes vanish.
std::map<std::string, Real> totals_of(const model::Scene& scene) {
  model::Model model(scene, Tpetra::getDefaultComm());
  for (const Real t : {1e12, 1e14}) EXPECT_TRUE(model.step_to(t).converged);
  std::map<std::string, Real> found;
  for (const auto& one : model.system().totals(model.state()))
    if (one.names.at(0) == "wells") found[one.names.at(2)] = one.value;
  return found;
}

/// In 2D, half of the injected fluid flows to each side along the joint: p - p_end = Q (l + r_w)/(2 T). In 3D the flow
/// is radial: p - p_w = Q/(2 pi T) ln(r/r_w), here with p on the boundary. Rough walls with JRC 48 conduct like an
/// aperture of 6.26 mm. Rock with the permeability 0 has no unknown pressure.
TEST(WellInAJoint, FollowsThePresentAperture) {
  for (const std::string cell : all_cells)
    for (const bool by_rate : {true, false}) {
      SCOPED_TRACE(fmt::format("{}, {}", cell, by_rate ? "rate" : "pressure"));
      const bool flat = is_flat(cell), rough = by_rate == (cell == "triangle" || cell == "tetrahedron");
      auto scene = parted_box(cell, by_rate ? 1e-18 : 0);
      if (rough) {
        scene.materials.at("joint").hydraulic_aperture = "Barton";
        scene.materials.at("joint").entry("joint roughness coefficient") = base::Expression(48);
      }
      const Real T = T_of(rough ? wide * wide * 1e6 / (48 * 48 * std::sqrt(48.0)) : wide);
      prescribe_rim(scene, flat ? "0" : fmt::format("0.5*log(x^2+y^2) - log({:.17g})", radius), flat);
      const Real Q = flat ? 4 * T / (1 + 2 * radius) : -2 * M_PI * T, p = flat ? 1 : 0;
      auto& well = scene.flow->wells.at("well");
      (by_rate ? well.rate : well.pressure) = base::Expression(by_rate ? Q : p);
      const auto found = totals_of(scene);
      const Real maximum = flat ? 1e-5 : 0.02, drawdown = flat ? 1 : std::log(0.5 / radius);
      EXPECT_NEAR(found.at("in a") / Q, 1, maximum);
      EXPECT_NEAR((found.at("pressure") - p) / drawdown, 0, maximum);
    }
}

/// Rigid rock with a fracture of this aperture from the start has equal pressures and rates, also with a well partly
/// in rock next to the fracture.
TEST(WellInAJoint, IsLikeOneInAFractureThatWide) {
  for (const std::string cell : all_cells)
    for (const Real compressibility : {0.0, 0.3})
      for (const bool by_rate : {true, false}) {
        SCOPED_TRACE(fmt::format("{}, {}, compressibility {}", cell, by_rate ? "rate" : "pressure", compressibility));
        auto scene = parted_box(cell, 1e-7);
        scene.mesh.cells = is_flat(cell) ? std::vector<int>{3, 2} : std::vector<int>{3, 3, 2};
        scene.flow->compressibility = compressibility;
        scene.materials.at("rock").porosity = 0;
        prescribe_rim(scene, "0.1*x", is_flat(cell));
        auto& well = scene.flow->wells.at("well");
        (by_rate ? well.rate : well.pressure) = base::Expression(by_rate ? 4 * T : 1);
        const auto found = totals_of(scene);
        scene.flow->rigid_rock = true;
        scene.boundary_conditions.erase("floor");
        scene.boundary_conditions.erase("lid");
        scene.materials.at("joint").initial_aperture = base::Expression(wide);
        for (const auto& [what, value] : totals_of(scene))
          EXPECT_NEAR(found.at(what), value, 1e-5 * (what == "pressure" ? 1 : T)) << what;
      }
}

}  // namespace
}  // namespace sprekk::tests
