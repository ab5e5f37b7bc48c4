// Transport of a tracer, compared with exact solutions, with heat and with balances of mass.
#include "../heat/warm_boxes.hpp"
#include "assembly/jacobian_check.hpp"
#include "base/over_ranks.hpp"
#include "estimate/goals.hpp"
#include "model/error_estimates.hpp"
#include "unit/assembly/dense.hpp"

#include <Teuchos_DefaultMpiComm.hpp>

#include <cmath>
#include <complex>

namespace sprekk::tests {
namespace {

/// Adds a tracer with the initial concentration c_0 to a scene, in rock with D_e, porosity and retardation factor R.
void dissolve(model::Scene& scene, Real c_0, Real diffusion, Real porosity, Real R) {
  scene.tracer.emplace().initial_concentration = Expression(c_0);
  auto& rock = scene.materials.at("rock");
  rock.effective_diffusion = {Expression(diffusion)};
  rock.porosity = Expression(porosity);
  rock.retardation = Expression(R);
}

void hold_concentration(model::Scene& scene, const std::string& side, const std::string& c,
                        const std::string& fracture = "") {
  auto& condition = scene.boundary_conditions[side + fracture + " has tracer"];
  condition.boundary = side;
  condition.concentration = Expression(c);
  if (!fracture.empty()) condition.fracture = fracture;
}

/// Returns a column along x without fractures, with the Darcy velocity q.
model::Scene column(const std::string& cell, int n, Real length, Real q) {
  const bool flat = is_flat(cell);
  auto scene = read_scene(flat ? "flow/source_2d.xml" : "flow/source_3d.xml");
  scene.mesh.cell = cell;
  scene.mesh.cells.assign(flat ? 2 : 3, 1);
  scene.mesh.cells[0] = n;
  scene.mesh.upper_corner[0] = length;
  scene.flow->source = 0;
  scene.boundary_conditions.clear();
  constrain(scene, "west", fmt::format("{}", q * length));
  constrain(scene, "east", "0");
  return scene;
}

/// Returns a total of results.json. Collective.
Real total(model::Model& model, const std::vector<std::string>& names) {
  Real sum = 0;
  for (const auto& one : model.system().totals(model.state()))
    if (one.names == names) sum += one.value;
  return sum;
}

/// Mass in rock and fractures. Collective.
Real mass(model::Model& model) {
  return total(model, {"tracer", "in rock"}) + total(model, {"tracer", "in fractures"});
}

/// Returns the root mean square over cells of the error of the concentration. Collective.
template <class Exact>
Real rms_error(model::Model& model, const Exact& exact) {
  const auto c = model.output("concentration").values;
  Real here = 0;
  for (LocalIndex e = 0; e < model.mesh().n_owned_cells; ++e)
    here += std::pow(c[e] - exact(mesh::cell_centre(model.mesh(), e)), 2);
  return std::sqrt(base::sum_over_ranks(*model.mesh().comm, here) / static_cast<Real>(model.mesh().n_global_cells));
}

/// Adds an injector and a producer, in rock and in the fracture "a". Both conduct well, so that round-off of pressures
/// does not disturb the flows.
void add_wells(model::Scene& scene) {
  const bool flat = is_flat(scene.mesh.cell);
  auto& injector = scene.flow->wells["injector"];
  injector.points = flat ? std::vector<Real>{0.2, 0.2} : std::vector<Real>{0.2, 0.2, 0.2, 0.3, 0.8, 0.3};
  injector.rate = Expression(1);
  auto& producer = scene.flow->wells["producer"];
  producer.points = flat ? std::vector<Real>{0.625, 0.5} : std::vector<Real>{0.6, 0.4, 0.7, 0.6, 0.7, 0.7};
  producer.pressure = Expression(2);
  injector.radius = producer.radius = 1e-3;
  scene.materials.at("joint").tangential_permeability = Expression(1);
}

/// Sets dispersivities of rock and joint.
void disperse(model::Scene& scene, Real along, Real across) {
  scene.materials.at("rock").dispersivity = {along, across};
  if (scene.materials.count("joint")) scene.materials.at("joint").filling_dispersivity = {along, across};
}

/// Tracer of concentration 1 enters a column with v = q/(R porosity), D = (D_e + alpha_L q)/(R porosity) (Ogata and
/// Banks 1961).
TEST(Tracer, AFrontMovesAndSpreads) {
  constexpr Real v = 8e-6, D = 3e-6, t = 1e6, q = 4e-6;
  const auto exact = [](const Vector3& x) {
    const Real width = 2 * std::sqrt(D * t);
    return (std::erfc((x[0] - v * t) / width) + std::exp(v * x[0] / D) * std::erfc((x[0] + v * t) / width)) / 2;
  };
  EXPECT_NEAR(exact({10, 0, 0}), 0.245324337878, 1e-10);
  for (const std::string cell : all_cells)
    for (const std::string advection : {"upwind", "second order"}) {
      const bool upwind = advection == "upwind";
      if (!upwind && (cell == "triangle" || cell == "tetrahedron")) continue;
      std::vector<Real> errors;
      for (const int n : {30, 60}) {
        auto scene = column(cell, n, 40, q);
        dissolve(scene, 0, 3e-7, 0.25, 2);
        disperse(scene, 0.3, 0.03);
        scene.tracer->advection = advection;
        hold_concentration(scene, "west", "1");
        model::Model model(scene, Tpetra::getDefaultComm());
        const int steps = upwind ? n : n * n / 10;
        for (int k = 1; k <= steps; ++k) ASSERT_TRUE(model.step_to(k * t / steps).converged) << cell;
        errors.push_back(rms_error(model, exact));
      }
      EXPECT_LT(errors[1], upwind ? 0.03 : 3e-3) << cell << " " << advection;
      EXPECT_GT(std::log2(errors[0] / errors[1]), upwind ? 0.7 : 1.5)
          << cell << " " << advection << ": " << errors[0] << ", " << errors[1];
    }
}

/// With the transfer coefficient q, the inflow is that of the given concentration: the mass grows by q c t.
TEST(Tracer, TransferAtTheRateOfInflowBringsTheGivenMass) {
  constexpr Real q = 4e-6, t = 1e5;
  for (const std::string cell : all_cells) {
    auto scene = column(cell, 40, 40, q);
    dissolve(scene, 0, 3e-7, 0.25, 2);
    disperse(scene, 0.3, 0.03);
    hold_concentration(scene, "west", "1.5");
    scene.boundary_conditions.at("west has tracer").tracer_transfer = Expression(q);
    model::Model model(scene, Tpetra::getDefaultComm());
    for (int k = 1; k <= 4; ++k) ASSERT_TRUE(model.step_to(k * t / 4).converged) << cell;
    EXPECT_NEAR(mass(model) / (q * 1.5 * t), 1, 1e-8) << cell;
  }
}

/// Steady flow u, |u| = 1, in x, y (z): c = exp(k x) with k = u_x/D_xx for D = D_e I + alpha_T I + (alpha_L - alpha_T)
/// u u^T. An isotropic dispersion would have another k.
TEST(Tracer, DispersionDependsOnTheDirectionOfFlow) {
  constexpr Real along = 1, across = 0.1, D_e = 0.05;
  for (const std::string cell : all_cells) {
    const bool flat = is_flat(cell);
    const Vector3 u = flat ? Vector3{0.8, 0.6, 0} : Vector3{0.64, 0.6, 0.48};
    const Real k = u[0] / (D_e + across + (along - across) * u[0] * u[0]);
    std::vector<Real> errors;
    for (const int n : {6, 12}) {
      auto scene = column(cell, n, 1, 1);
      for (int& count : scene.mesh.cells) count = n;
      dissolve(scene, 0, D_e, 1, 1);
      disperse(scene, along, across);
      scene.boundary_conditions.clear();
      auto sides = std::vector<std::string>{"west", "east", "south", "north"};
      if (!flat) sides.insert(sides.end(), {"bottom", "top"});
      for (const auto& side : sides) {
        constrain(scene, side, fmt::format("-({}*x + {}*y{})", u[0], u[1], flat ? "" : fmt::format(" + {}*z", u[2])));
        hold_concentration(scene, side, fmt::format("exp({}*x)", k));
      }
      model::Model model(scene, Tpetra::getDefaultComm());
      ASSERT_TRUE(model.step_to(1e9).converged) << cell;
      errors.push_back(rms_error(model, [&](const Vector3& x) { return std::exp(k * x[0]); }));
    }
    EXPECT_LT(errors[1], 0.02) << cell;
    EXPECT_GT(std::log2(errors[0] / errors[1]), 0.8) << cell << ": " << errors[0] << ", " << errors[1];
  }
}

/// Returns the inverse at t of the Laplace transform F by the fixed Talbot method with 20 nodes (Abate and Valko 2004).
template <class Transform>
Real inverse_laplace(const Transform& F, Real t) {
  constexpr int n = 20;
  const Real r = 2.0 * n / (5 * t);
  Real sum = std::real(F(std::complex<Real>(r))) * std::exp(r * t) / 2;
  for (int k = 1; k < n; ++k) {
    const Real angle = k * M_PI / n, cot = 1 / std::tan(angle);
    const std::complex<Real> s = r * angle * std::complex<Real>(cot, 1);
    sum += std::real(std::exp(t * s) * F(s) * std::complex<Real>(1, angle + (angle * cot - 1) * cot));
  }
  return r / n * sum;
}

TEST(InverseLaplace, OfKnownTransforms) {
  using Complex = std::complex<Real>;
  EXPECT_NEAR(inverse_laplace([](Complex s) { return 1.0 / (s + 0.5); }, 2), std::exp(-1), 1e-9);
  EXPECT_NEAR(inverse_laplace([](Complex s) { return std::exp(-std::sqrt(s)) / s; }, 2), std::erfc(0.5 / std::sqrt(2)),
              1e-9);
}

/// A fracture in porous rock with dispersion, sorption and decay (Tang, Frind and Sudicky 1981): v = 1e-2 m/s, D = 1e-6
/// m^2/s + 1 m v, R = 100, half aperture b = 0.5 mm, matrix 0.3 = R' porosity, D_e = 1.2e-6 m^2/s, decay 1e-6 1/s. The
/// Laplace transform of c(x, t) is exp(x g(s))/s, g(s) = (v - sqrt(v^2 + 4 D k(s)))/(2 D), k(s) = R (s + decay) +
/// sqrt((s + decay) 0.3 D_e)/b; the steady c is exp(x g(0)).
TEST(TracerInFractures, DiffusesIntoTheRock) {
  constexpr Real v = 1e-2, D = 1e-6 + 1 * v, decay = 1e-6;
  const auto exponent = [&](std::complex<Real> s) {
    const auto k = 100.0 * (s + decay) + std::sqrt((s + decay) * 0.3 * 1.2e-6) / 5e-4;
    return (v - std::sqrt(v * v + 4 * D * k)) / (2 * D);
  };
  const auto exact = [&](Real x, bool steady) {
    if (steady) return std::exp(x * std::real(exponent(0)));
    return inverse_laplace([&](std::complex<Real> s) { return std::exp(x * exponent(s)) / s; }, 1e6);
  };
  for (const std::string cell : {"quadrilateral", "hexahedron"})
    for (const bool steady : {false, true}) {
      const bool flat = is_flat(cell);
      if (steady && !flat) continue;
      std::vector<Real> errors;
      for (const int n : {6, 18}) {
        auto scene = closed_box(cell, false);
        scene.mesh.cells = flat ? std::vector{2 * n, 4 * n} : std::vector{2 * n, 4 * n, 1};
        scene.mesh.lower_corner = flat ? std::vector<Real>{0, -8} : std::vector<Real>{0, -8, 0};
        scene.mesh.upper_corner = flat ? std::vector<Real>{30, 8} : std::vector<Real>{30, 8, 1};
        auto& a = scene.mesh.fractures["a"];
        a = {scene.mesh.lower_corner, scene.mesh.upper_corner, {}};
        a.lower_corner[1] = a.upper_corner[1] = 0;
        dissolve(scene, 0, 1, 0.1, 3);
        scene.tracer->half_life = std::log(2.0) / decay;
        auto& rock = scene.materials.at("rock");
        rock.permeability = {Expression(1e-30)};
        rock.effective_diffusion.assign(flat ? 2 : 3, Expression(1e-20));
        rock.effective_diffusion[1] = Expression(1.2e-6);
        auto& joint = scene.materials.at("joint");
        joint.filling_diffusion = Expression(1e-6);
        joint.filling_retardation = Expression(100);
        joint.filling_dispersivity.along = 1;
        inject(scene, "west", "a", aperture * v);
        constrain(scene, "east", "0", "a");
        hold_concentration(scene, "west", "1", "a");
        model::Model model(scene, Tpetra::getDefaultComm());
        const int steps = steady ? 1 : 2 * n;
        for (int k = 1; k <= steps; ++k) ASSERT_TRUE(model.step_to(k * (steady ? 1e15 : 1e6) / steps).converged);
        Real worst = 0;
        for (const Real x : {6.25, 11.25, 16.25})
          worst = std::max(
              worst, std::abs(value_at(model, "fracture concentration", {x, 0, flat ? 0 : 0.5}) - exact(x, steady)));
        errors.push_back(worst);
      }
      EXPECT_LT(errors[1], 0.03) << cell << steady;
      EXPECT_GT(std::log(errors[0] / errors[1]) / std::log(3), 0.7)
          << cell << steady << ": " << errors[0] << ", " << errors[1];
    }
}

/// A tracer without sorption, decay and dispersion has the equations of heat: equal values, and equal estimates.
TEST(Tracer, MovesLikeHeat) {
  for (const std::string cell : all_cells) {
    auto scene = closed_box(cell);
    add_wells(scene);
    warm(scene, 0.5, 0.3, 0.4, 1);
    scene.heat->wells["injector"].temperature = Expression(2);
    scene.materials.at("joint").filling_conductivity = Expression(0.7);
    prescribe_temperature(scene, "west", "1 + y");
    dissolve(scene, 0.5, 0.3, 0.2, 2);
    scene.tracer->wells["injector"].concentration = Expression(2);
    scene.materials.at("joint").filling_diffusion = Expression(0.7);
    hold_concentration(scene, "west", "1 + y");
    scene.solver.tolerance = 1e-12;
    const bool estimates = cell == "triangle" || cell == "tetrahedron";
    if (estimates)
      for (const std::string what : {"temperature", "concentration"}) {
        auto& quantity = scene.accuracy ? scene.accuracy->quantities[what] : scene.accuracy.emplace().quantities[what];
        quantity.what = what;
        quantity.fractures = {"a"};
        quantity.relative = 0.01;
      }
    for (const std::string scheme : {"upwind", "second order"}) {
      if (estimates && scheme != "upwind") continue;
      scene.heat->advection = scene.tracer->advection = scheme;
      model::Model model(scene, Tpetra::getDefaultComm());
      std::optional<estimate::ErrorEstimator> estimator;
      std::optional<estimate::Goals> goals;
      if (estimates) {
        estimator.emplace(model::make_error_estimator(model, 0));
        goals.emplace(*estimator, model.scene().accuracy->functionals());
      }
      for (const Real t : {0.02, 0.05, 0.08}) {
        ASSERT_TRUE(model.step_to(t).converged) << cell;
        if (!estimates) continue;
        std::vector<assembly::OutputField> outputs = model.system().outputs(model.state());
        const auto state = model::present_state(model, outputs);
        const auto estimate = (*estimator)(state);
        goals->add(state, estimate, t == 0.08);
        goals->weigh(state, estimate, t == 0.08);
      }
      for (const std::string prefix : {"", "fracture "}) {
        const auto T = model.output(prefix + "temperature").values, c = model.output(prefix + "concentration").values;
        ASSERT_EQ(T.size(), c.size());
        for (std::size_t e = 0; e < T.size(); ++e) EXPECT_NEAR(T[e], c[e], 1e-9) << cell;
      }
      EXPECT_NEAR(total(model, {"wells", "producer", "heat"}), total(model, {"wells", "producer", "tracer"}), 1e-8);
      if (!estimates) continue;
      const auto &T = goals->estimates().at("temperature"), &c = goals->estimates().at("concentration");
      EXPECT_NEAR(T.value, c.value, 1e-9) << cell;
      EXPECT_NEAR(T.error, c.error, 1e-6 * T.error) << cell;
      EXPECT_GT(T.error, 0) << cell;
    }
  }
}

/// Channels from the bottom, with the concentration 1, and from the west, without tracer, meet in tight fractures.
/// Water of the mixed concentration leaves at the top, where the concentration 0 is prescribed: `tracer_inflows`
/// contain the flow times the difference.
TEST(Tracer, MixesWhereChannelsMeet) {
  for (const std::string cell : {"tetrahedron", "hexahedron"}) {
    auto scene = closed_box(cell);
    scene.mesh.fractures["c"] = {{0, 0, 0.5}, {1, 1, 0.5}};
    scene.fractures["c"].material = "joint";
    scene.materials.at("rock").permeability = {Expression(1e-15)};
    scene.materials.at("joint").normal_permeability = Expression(1e-15);
    scene.materials.at("joint").tangential_permeability = Expression(1e-9);
    dissolve(scene, 0, 1e-15, 0.1, 1);
    auto &x = scene.flow->intersections["x"], &z = scene.flow->intersections["z"];
    x.fractures = {"a", "c"};
    x.permeability_area = 4;
    z.fractures = {"a", "b"};
    z.permeability_area = 10;
    constrain(scene, "bottom", "1");
    constrain(scene, "west", "0.8");
    constrain(scene, "top", "0");
    hold_concentration(scene, "bottom", "1");
    hold_concentration(scene, "west", "0");
    hold_concentration(scene, "top", "0");
    model::Model model(scene, Tpetra::getDefaultComm());
    ASSERT_TRUE(model.step_to(1e10).converged) << cell;  // the steady state
    const Real meeting = (10 + 4 * 0.8) / 24, from_below = 10 * (1 - meeting);
    EXPECT_NEAR(inflow(model, "bottom"), from_below, 1e-8) << cell;
    EXPECT_NEAR(inflow(model, "top has tracer"), -from_below, 1e-8) << cell;
    EXPECT_NEAR(inflow(model, "bottom has tracer"), 0, 1e-8) << cell;
  }
}

/// Tracer enters a channel without tracer from the bottom at the rate q, with the concentration 1, and leaves at the
/// top. `tracer_inflows` there contain -q c. An edge multiplies c by 2/3 in the first step. In the end, the tracer
/// fills the volume A of a circular pipe of length 1.
TEST(Tracer, FillsAChannel) {
  constexpr Real K = 10, q = K / viscosity;
  const Real volume = std::sqrt(8 * M_PI * K), dt = volume / q / 2;
  for (const std::string cell : {"tetrahedron", "hexahedron"}) {
    auto scene = closed_box(cell);
    scene.materials.at("rock").permeability = {Expression(1e-15)};
    scene.materials.at("joint").normal_permeability = Expression(1e-15);
    scene.materials.at("joint").tangential_permeability = Expression(1e-9);
    dissolve(scene, 0, 1e-15, 0.1, 1);
    scene.flow->intersections["pipe"].permeability_area = K;
    constrain(scene, "bottom", "1");
    constrain(scene, "top", "0");
    hold_concentration(scene, "bottom", "1");
    hold_concentration(scene, "top", "0");
    model::Model model(scene, Tpetra::getDefaultComm());
    Real stored = 0;
    for (int step = 1; step <= 40; ++step) {
      ASSERT_TRUE(model.step_to(step * dt).converged) << cell;
      stored += dt * (q + inflow(model, "top has tracer"));
      if (step > 1) continue;
      EXPECT_NEAR(inflow(model, "top has tracer") / q, -std::pow(2.0 / 3, 4), 1e-6) << cell;  // four edges in a row
    }
    EXPECT_NEAR(stored / volume, 1, 1e-6) << cell;
  }
}

/// Uniform concentration in closed rock and fractures: c_0/(1 + decay dt) after each step.
TEST(Tracer, Decays) {
  for (const std::string cell : all_cells) {
    auto scene = closed_box(cell);
    dissolve(scene, 3, 0.3, 0.2, 2);
    scene.tracer->half_life = 0.5;
    scene.materials.at("joint").filling_retardation = Expression(4);
    constrain(scene, "west", "0");
    model::Model model(scene, Tpetra::getDefaultComm());
    Real c = 3, t = 0;
    for (const Real dt : {0.1, 0.2, 0.1}) {
      const Real before = mass(model);
      ASSERT_TRUE(model.step_to(t += dt).converged) << cell;
      c /= 1 + std::log(2.0) / 0.5 * dt;
      const auto exact = [&](const auto&, const auto&) { return Vector3{c}; };
      EXPECT_LT(error(model, "concentration", exact), 1e-10) << cell;
      EXPECT_LT(error(model, "fracture concentration", exact), 1e-10) << cell;
      EXPECT_NEAR(before - mass(model), dt * total(model, {"tracer", "decay"}), 1e-10) << cell;
    }
    EXPECT_NEAR(mass(model), c * (0.4 + 2 * 4 * aperture), 1e-10) << cell;
  }
}

/// Injected mass equals the sum of stored, decayed and produced mass.
TEST(Tracer, IsInBalance) {
  for (const std::string cell : all_cells)
    for (const std::string advection : {"upwind", "second order"}) {
      auto scene = closed_box(cell);
      add_wells(scene);
      dissolve(scene, 0.5, 0.3, 0.2, 2);
      disperse(scene, 0.2, 0.05);
      scene.tracer->half_life = 0.1;
      scene.tracer->advection = advection;
      scene.tracer->wells["injector"].concentration = Expression("1 + t");
      scene.materials.at("joint").filling_retardation = Expression(4);
      scene.solver.tolerance = 1e-13;
      model::Model model(scene, Tpetra::getDefaultComm());
      Real t = 0;
      for (const Real dt : {0.02, 0.01, 0.03}) {
        const Real before = mass(model);
        ASSERT_TRUE(model.step_to(t += dt).converged) << cell;
        const Real gain = total(model, {"wells", "injector", "tracer"}) +
                          total(model, {"wells", "producer", "tracer"}) - total(model, {"tracer", "decay"});
        EXPECT_NEAR(mass(model) - before, dt * gain, 1e-8 * before) << cell;
      }
      EXPECT_GT(mass(model), 0.01);
    }
}

TEST(Tracer, JacobianIsItsDerivative) {
  for (const std::string cell : all_cells) {
    auto scene = closed_box(cell, true, 2);
    add_wells(scene);
    scene.flow->wells.at("producer").points[0] = 0.7;
    dissolve(scene, 0.5, 1.5, 0.4, 2);
    disperse(scene, 0.7, 0.2);
    scene.tracer->half_life = 0.1;
    scene.tracer->wells["injector"].concentration = Expression(2);
    hold_concentration(scene, "north", "1");
    scene.materials.at("joint").initial_aperture = Expression(0.8);
    model::Model model(scene, Tpetra::getDefaultComm());
    auto& system = model.system();
    system.set_time(1, 0.5);
    auto x = system.initial();
    test::randomize(x, 0.3, 1);
    system.commit(x);
    test::randomize(x, 0.3, 2);
    int checked = 0;
    for (const auto& e : assembly::check_jacobian(system, x, 1e-6)) {
      ++checked;
      EXPECT_LE(e.error, 1e-5) << cell << ": " << e.module << ": " << e.row << ", " << e.column;
    }
    EXPECT_GT(checked, 20);
  }
}

/// Masses in a run of a scene of xml/tracer, and rates of the producer, kg/s (2D: per metre).
struct Breakthrough {
  Real injected = 0, decayed = 0, produced = 0, left = 0, largest_rate = 0, last_rate = 0;
};
Breakthrough run_doublet(const model::Scene& scene, const RCP<const Comm>& comm) {
  model::Model model(scene, comm);
  Breakthrough all;
  Real t = 0;
  for (const Real end : scene.time.times()) {
    EXPECT_TRUE(model.step_to(end).converged) << end;
    all.last_rate = -total(model, {"wells", "producer", "tracer"});
    all.largest_rate = std::max(all.largest_rate, all.last_rate);
    all.injected += (end - t) * total(model, {"wells", "injector", "tracer"});
    all.decayed += (end - t) * total(model, {"tracer", "decay"});
    all.produced += (end - t) * all.last_rate;
    t = end;
  }
  all.left = mass(model);
  return all;
}

/// Scenes of xml/tracer: breakthrough at the producer, balance, equal results on all numbers of ranks.
TEST(Tracer, ExamplesAreInBalance) {
  for (const std::string name : {"tracer/doublet_2d.xml", "tracer/doublet_3d.xml"}) {
    auto scene = read_scene(name, {"Time.steps=10", "Solver.tolerance=1e-13"});
    if (scene.mesh.cells.size() == 2) scene.mesh.cells = {20, 12};
    const auto got = run_doublet(scene, Tpetra::getDefaultComm());
    EXPECT_NEAR((got.left + got.decayed + got.produced) / got.injected, 1, 1e-8) << name;
    EXPECT_GT(got.largest_rate, 1.2 * got.last_rate) << name;
    EXPECT_GT(got.last_rate, 0) << name;
    const auto alone = run_doublet(scene, rcp(new Teuchos::MpiComm<int>(MPI_COMM_SELF)));
    EXPECT_NEAR(got.produced, alone.produced, 1e-8 * got.injected) << name;
    EXPECT_NEAR(got.left, alone.left, 1e-8 * got.injected) << name;
  }
}

}  // namespace
}  // namespace sprekk::tests
