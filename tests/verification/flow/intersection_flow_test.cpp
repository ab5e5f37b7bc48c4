// Flow in channels along intersections of fractures, compared with exact solutions.
#include "boxes.hpp"

#include "base/over_ranks.hpp"
#include "mesh/facets.hpp"
#include "mesh/intersections.hpp"

#include <cmath>

namespace sprekk::tests {
namespace {

const char* const solid_cells[] = {"tetrahedron", "hexahedron"};

/// Adds a channel of the permeability times area K.
void add_channel(model::Scene& scene, const std::string& name, const std::vector<std::string>& fractures, Real K) {
  auto& channel = scene.flow->intersections[name];
  channel.fractures = fractures;
  channel.permeability_area = K;
}

/// Returns the unit cube with three fractures through its centre: "a" across y, "b" across x, "c" across z. They
/// intersect along the z axis (a, b), the x axis (a, c) and the y axis (b, c).
model::Scene three_fractures(const std::string& cell) {
  auto scene = closed_box(cell);
  scene.mesh.fractures["c"] = {{0, 0, 0.5}, {1, 1, 0.5}};
  scene.fractures["c"].material = "joint";
  return scene;
}

void hold_all(model::Scene& scene, const std::string& pressure) {
  for (const char* side : {"west", "east", "south", "north", "bottom", "top"}) constrain(scene, side, pressure);
}

/// Linear pressure with the slope G, under gravity: the flow along the direction e of a channel is -K/mu e.(G - rho g).
/// The inflow through a side is that of rock, two fractures and a channel. A diameter d means K = pi d^4/128. A channel
/// without fractures adds to the others.
TEST(IntersectionFlow, LinearPressureWithAJunctionOfThreeChannelsIsExact) {
  constexpr Real k = 3, diameter = 2, of_pipe = M_PI / 8;
  const std::map<std::string, Real> K = {{"west", 40 + of_pipe}, {"south", 7 + of_pipe}, {"top", 1000 + of_pipe}};
  for (const std::string cell : solid_cells)
    for (const std::string solver : {"direct", "iterative"})
      for (const bool turned : {false, true}) {
        SCOPED_TRACE(cell + " " + solver + (turned ? " turned" : ""));
        auto scene = three_fractures(cell);
        scene.materials.at("joint").tangential_permeability = k;
        scene.solver.linear_solver.type = solver;
        add_channel(scene, "x", {"a", "c"}, 40);
        add_channel(scene, "y", {"c", "b"}, 7);
        add_channel(scene, "z", {"a", "b"}, 1000);
        scene.flow->intersections["all"].diameter = diameter;
        const auto Q = turned ? turn(scene, 25, {1, 2, 3}) : identity();
        const Vector3 G = times(Q, {2, -3, 4}), g = times(Q, {0, 0, -10}), drive = {2, -3, 4 + 30};
        scene.flow->density = 3;
        scene.bulk.gravity = {g[0], g[1], g[2]};
        hold_all(scene, fmt::format("1 + ({:.17g})*x + ({:.17g})*y + ({:.17g})*z", G[0], G[1], G[2]));
        model::Model model(scene, Tpetra::getDefaultComm());
        ASSERT_TRUE(model.step_to(1).converged);
        const auto p = [&](const auto& x, const auto&) { return Vector3{1 + dot(G, x)}; };
        const Real tolerance = solver == "direct" ? 1e-10 : 1e-6;
        EXPECT_LT(error(model, "pressure", p), tolerance);
        EXPECT_LT(error(model, "fracture pressure", p), tolerance);
        const auto expect = [&](const std::string& side, Real rate) {
          const Real conductance = (1 + 2 * aperture * k + K.at(side)) / viscosity;
          EXPECT_NEAR(inflow(model, side) / (conductance * rate), 1, tolerance) << side;
        };
        const auto along = model.output("channel flow").values;
        for (const auto& edge : mesh::intersection_edges(model.mesh())) {
          const Vector3 middle = transposed_times(Q, mesh::ridge_centre(model.mesh(), edge.face, edge.ridge)),
                        end = transposed_times(Q, mesh::face_corner(model.mesh(), edge.face, edge.ridge)),
                        flow = transposed_times(
                            Q, {along[3 * edge.facet], along[3 * edge.facet + 1], along[3 * edge.facet + 2]});
          for (int i = 0; i < 3; ++i) {
            const bool is_along = std::abs(end[i] - middle[i]) > 1e-6;
            const Real conductance = K.at(std::array{"west", "south", "top"}[i]) / viscosity;
            EXPECT_NEAR(flow[i], is_along ? -conductance * drive[i] : 0, tolerance * conductance * 40) << i;
          }
        }
        expect("west", -drive[0]);
        expect("south", -drive[1]);
        expect("top", drive[2]);
      }
}

/// Three channels that meet in almost impermeable fractures, with a pressure of 1 at the bottom and of 0 in the west
/// and the south. Their other ends are closed.
TEST(IntersectionFlow, PipesInANetworkAreInSeriesAndParallel) {
  for (const std::string cell : solid_cells)
    for (const Real of_fluid : {0.0, 1e-9}) {
      SCOPED_TRACE(cell);
      auto scene = three_fractures(cell);
      scene.materials.at("rock").permeability = {0};
      scene.materials.at("joint").tangential_permeability = 1e-9;
      scene.flow->compressibility = of_fluid;
      add_channel(scene, "x", {"a", "c"}, 4);
      add_channel(scene, "y", {"b", "c"}, 7);
      add_channel(scene, "z", {"a", "b"}, 10);
      constrain(scene, "bottom", "1");
      constrain(scene, "west", "0");
      constrain(scene, "south", "0");
      model::Model model(scene, Tpetra::getDefaultComm());
      ASSERT_TRUE(model.step_to(1).converged);
      const Real to_x = 4 / 0.5 / viscosity, to_y = 7 / 0.5 / viscosity, to_z = 10 / 0.5 / viscosity;
      const Real p = to_z / (to_x + to_y + to_z);
      EXPECT_NEAR(inflow(model, "bottom"), to_z * (1 - p), 1e-7);
      EXPECT_NEAR(inflow(model, "west"), -to_x * p, 1e-7);
      EXPECT_NEAR(inflow(model, "south"), -to_y * p, 1e-7);
    }
}

/// A fluid injected into closed, well conducting fractures fills them and the channel: the pressure 1 after a step of
/// dt requires the volume V (exp(c) - 1), where V is that of two fractures and of a circular pipe with the conductance
/// K. Pressure differences are of the order of V c/(T dt).
TEST(IntersectionFlow, AChannelStoresACompressibleFluid) {
  constexpr Real c = 0.5, K = 1, k = 1e6, dt = 1e3;
  const Real volume = 2 * aperture + std::sqrt(8 * M_PI * K);
  for (const std::string cell : solid_cells) {
    auto scene = closed_box(cell);
    scene.materials.at("rock").permeability = {0};
    scene.materials.at("joint").tangential_permeability = k;
    scene.flow->compressibility = c;
    add_channel(scene, "channel", {"a", "b"}, K);
    for (auto& [name, fracture] : scene.fractures) fracture.source = volume * std::expm1(c) / 2 / dt;
    model::Model model(scene, Tpetra::getDefaultComm());
    ASSERT_TRUE(model.step_to(dt).converged) << cell;
    const Real differences = volume * c / (k * aperture / viscosity * dt);
    EXPECT_LT(error(model, "fracture pressure", [](const auto&, const auto&) { return Vector3{1}; }), 2 * differences)
        << cell;
  }
}

/// A channel of a later stage is full of fluid at the present pressure: the pressure in a closed network remains.
TEST(IntersectionFlow, AChannelThatIsAddedLaterChangesNoPressure) {
  for (const std::string cell : solid_cells) {
    auto scene = closed_box(cell);
    scene.materials.at("rock").permeability = {0};
    scene.flow->compressibility = 0.5;
    for (auto& [name, fracture] : scene.fractures) fracture.source = 0.1;
    model::Model model(scene, Tpetra::getDefaultComm());
    ASSERT_TRUE(model.step_to(1).converged) << cell;
    const auto mean = [&] {
      Real sum = 0;
      const auto output = model.output("fracture pressure");
      for (const Real p : output.values) sum += p;
      return base::sum_over_ranks(*model.mesh().comm, sum);
    };
    const Real before = mean();
    EXPECT_GT(before, 0);
    for (auto& [name, fracture] : scene.fractures) fracture.source = 0;
    add_channel(scene, "channel", {"a", "b"}, 1);
    model.change(scene);
    ASSERT_TRUE(model.step_to(2).converged) << cell;
    EXPECT_NEAR(mean() / before, 1, 1e-9) << cell;
  }
}

/// Returns the error of the pressure in two crossing fractures with a channel whose flow leaks into them. With the
/// distance y from the channel and b = 1/2, p = cos(pi z) g(y) with g(0) = 1 and g(b) = 0 satisfies
///   K p_zz + n T mu p_y = 0  at y = 0, n = 4 half planes: g'(0) = K pi^2/(n k a),
/// with sources in the fractures. Both ends of the channel are closed.
Real error_of_leaking_channel(const std::string& cell, int n, Real K) {
  constexpr Real k = 3, b = 0.5;
  auto scene = closed_box(cell, true, n);
  scene.materials.at("rock").permeability = {0};
  scene.materials.at("joint").tangential_permeability = k;
  add_channel(scene, "channel", {"a", "b"}, K);
  const Real slope = K * M_PI * M_PI / (4 * k * aperture), bend = (1 + slope * b) / (b * b);
  for (auto& [name, fracture] : scene.fractures)
    fracture.source =
        base::Expression(fmt::format("{:.17g}*cos(pi*z)*(pi^2*(1 + {:.17g}*(abs(x-0.5) + abs(y-0.5)) - "
                                     "{:.17g}*(abs(x-0.5) + abs(y-0.5))^2) + {:.17g})",
                                     k * aperture / viscosity, slope, bend, 2 * bend));
  for (const char* side : {"west", "east", "south", "north"}) constrain(scene, side, "0");
  model::Model model(scene, Tpetra::getDefaultComm());
  EXPECT_TRUE(model.step_to(1).converged);
  const Real largest = 1 + slope;  // of the gradient
  return error(model, "fracture pressure",
               [&](const Vector3& x, const auto&) {
                 const Real y = std::abs(x[0] - 0.5) + std::abs(x[1] - 0.5);
                 return Vector3{std::cos(M_PI * x[2]) * (1 + slope * y - bend * y * y)};
               }) /
         largest;
}

TEST(IntersectionFlow, AChannelThatLeaksConvergesWithOrderTwo) {
  for (const std::string cell : solid_cells)
    for (const Real K : {1e-3, 1e-1}) {
      const Real coarse = error_of_leaking_channel(cell, 12, K), fine = error_of_leaking_channel(cell, 24, K);
      EXPECT_LT(fine, 1.3e-3) << cell << ' ' << K;
      EXPECT_GT(coarse / fine, 3.4) << cell << ' ' << K << ": " << coarse << ", " << fine;
    }
}

/// The flow from a well in a fracture leaves through the channel and the fractures: the balance of all inflows is zero.
TEST(IntersectionFlow, InflowsAddUpForAnyConductance) {
  for (const std::string cell : solid_cells)
    for (const Real K : {1e-9, 1.0, 1e6}) {
      SCOPED_TRACE(fmt::format("{} {}", cell, K));
      auto scene = closed_box(cell);
      scene.materials.at("rock").permeability = {base::Expression(1e-6)};
      scene.materials.at("joint").tangential_permeability = 10;
      scene.solver.linear_solver.type = "iterative";
      add_channel(scene, "channel", {}, K);
      constrain(scene, "bottom", "1");
      constrain(scene, "west", "0");
      auto& well = scene.flow->wells["well"];
      well.points = {0.8, 0.3, 0.6, 0.8, 0.7, 0.6};
      well.radius = 1e-3;
      well.rate = base::Expression(1e-3);
      model::Model model(scene, Tpetra::getDefaultComm());
      ASSERT_TRUE(model.step_to(1).converged);
      const Real bottom = inflow(model, "bottom"), west = inflow(model, "west");
      const Real rounding = 1e-14 * K;  // of pressures near 1, times the largest conductance
      EXPECT_NEAR(bottom + west + 1e-3, 0, 1e-9 * std::abs(west) + rounding);
    }
}

/// A compressible fluid at rest under gravity: de/dz = -c rho_0 g e^2 and e = 1 at z = 0, thus e = 1/(1 + c rho_0 g z).
TEST(IntersectionFlow, ACompressibleFluidInAChannelIsAtRest) {
  constexpr Real c = 0.01, weight = 30;
  for (const std::string cell : solid_cells) {
    SCOPED_TRACE(cell);
    auto scene = three_fractures(cell);
    scene.flow->density = 3;
    scene.flow->compressibility = c;
    scene.bulk.gravity = {0, 0, -10};
    add_channel(scene, "all", {}, 5);
    const auto at_rest = fmt::format("-ln(1 + {}*z)/{}", c * weight, c);
    constrain(scene, "bottom", at_rest);
    constrain(scene, "top", at_rest);
    model::Model model(scene, Tpetra::getDefaultComm());
    ASSERT_TRUE(model.step_to(1e10).converged);
    const auto p = [&](const auto& x, const auto&) { return Vector3{-std::log1p(c * weight * x[2]) / c}; };
    EXPECT_LT(error(model, "fracture pressure", p), 1e-9);
    EXPECT_NEAR(inflow(model, "bottom"), 0, 1e-8);
  }
}

}  // namespace
}  // namespace sprekk::tests
