// Given fluid pressure in fractures: the traction on the rock is lambda - p n.
#include "verification/loads/block.hpp"
#include "verification/uniform/states.hpp"

namespace sprekk::tests {
namespace {

/// Block of regimes_2d.xml under increasing and decreasing pressure; displacement of its top (0.15, -0.1). Balance: N
/// + p = k_n (opening - d_n), k_n = 3. With K_s = 2/3 and the closure V(N) = Du N/(Du K_n + N), N is the root (60
/// digits) of
///   N/k_n + p/k_n + V(N) + mu tan(theta) N/K_s = g0 + tan(theta) d_t - d_n
/// for slip; for stick without the term with mu, and with u^p instead of d_t. Slip begins at p = 0.0883, opening at
/// 0.4093.
TEST(FluidPressure, SlipAndOpeningOfABlock) {
  struct Step {
    Real p, N, l_t, u_p, opening;
    int state;
  };
  const std::vector<Step> steps = {
      {0.05, 0.195631429995781, 0.1, 0, -0.0181228566680731, 1},
      {0.1, 0.160245350263624, 0.0961472101581744, 0.00577918476273841, -0.0132515499121253, 2},
      {0.2, 0.106216043949413, 0.0637296263696476, 0.0544055604455286, 0.00207201464980422, 2},
      {0.4, 0.00451396901610986, 0.00270838140966591, 0.145937427885501, 0.0348379896720366, 2},
      {0.3, 0.0702435969210186, 0.00270838140966591, 0.145937427885501, 0.0234145323070062, 1},
      {0.45, 0, 0, 0.15, 0.05, 0}};
  for (const int dim : {2, 3})
    for (const auto& d : discretisations(dim)) {
      SCOPED_TRACE(d.name());
      auto scene = read_scene(
          fmt::format("verification/regimes_{}d.xml", dim),
          d.with({"Solver.tolerance=1e-13", "Tables.p.arguments={0, 1, 2, 3, 4, 5, 6}",
                  "Tables.p.values={0, 0.05, 0.1, 0.2, 0.4, 0.3, 0.45}", "Fractures.fracture.fluid pressure=p(t)",
                  "Boundary conditions.moved.displacement=" +
                      std::string(dim == 2 ? "{0.15, -0.1}" : "{0.15, 0, -0.1}")}));
      tie_sides(scene);
      model::Model model(scene, Tpetra::getDefaultComm());
      for (std::size_t k = 0; k < steps.size(); ++k) {
        const auto& s = steps[k];
        SCOPED_TRACE(fmt::format("p = {}", s.p));
        const auto report = model.step_to(static_cast<Real>(k + 1));
        ASSERT_TRUE(report.converged) << report.reason;
        auto e = UniformJoint{s.l_t, -s.N, s.u_p, s.opening, -0.1 * s.N / (0.5 + s.N), 2}.along({1, 0, 0}, dim);
        expect_joint(model, e);
        const Outputs out(model);
        for (LocalIndex f = 0; f < model.mesh().n_owned_fracture_faces; ++f) {
          EXPECT_EQ(out.scalar("state", f), s.state);
          EXPECT_NEAR(out.scalar("fluid pressure", f), s.p, 1e-15);
        }
      }
    }
}

/// A filling with Biot's coefficient alpha passes the part alpha of the pressure to the rock.
TEST(FluidPressure, OfAFillingActsInPart) {
  for (const int dim : {2, 3})
    for (const auto& d : discretisations(dim)) {
      SCOPED_TRACE(d.name());
      std::vector<Outputs> outputs;
      std::vector<std::unique_ptr<model::Model>> models;
      for (const auto& [pressure, alpha] : {std::pair("0.2*t", "0.25"), std::pair("0.05*t", "1")}) {
        auto scene =
            read_scene(fmt::format("verification/regimes_{}d.xml", dim),
                       d.with({"Solver.tolerance=1e-13", fmt::format("Materials.joint.Biot coefficient={}", alpha),
                               fmt::format("Fractures.fracture.fluid pressure={}", pressure),
                               "Boundary conditions.moved.displacement=" +
                                   std::string(dim == 2 ? "{0.15, -0.1}" : "{0.15, 0, -0.1}")}));
        tie_sides(scene);
        models.push_back(std::make_unique<model::Model>(scene, Tpetra::getDefaultComm()));
        ASSERT_TRUE(models.back()->step_to(1).converged);
        outputs.emplace_back(*models.back());
      }
      for (const std::string name : {"traction", "jump", "displacement"}) {
        const auto &part = outputs[0][name].values, &all = outputs[1][name].values;
        for (std::size_t i = 0; i < part.size(); ++i) EXPECT_NEAR(part[i], all[i], 1e-11) << name;
      }
    }
}

/// A pressure in all fractures is a uniform stress -p I in all rock. The tractions lambda are then those of the dry
/// scene with an additional boundary load p n. Prescribed displacements get the additional strain p/(dim lambda + 2G).
TEST(FluidPressure, InAllFracturesIsALoadOnTheBoundary) {
  const std::string p = "(0.004*t)", coordinates[] = {"x", "y", "z"};
  const Real G = 0.4, lambda = 0.4;
  for (const int dim : {2, 3})
    for (const auto& d : discretisations(dim)) {
      if (dim == 3 && d.order == 2) continue;
      SCOPED_TRACE(d.name());
      auto wet = read_scene(fmt::format("verification/crossing_{}d.xml", dim), d.with({"Solver.tolerance=1e-12"}));
      auto dry = wet;
      const auto tables = std::make_shared<const base::Tables>(wet.tables);
      for (auto& [name, fracture] : wet.fractures) fracture.fluid_pressure = expression(p);
      for (auto& [name, condition] : dry.boundary_conditions)
        for (int i = 0; i < dim; ++i) {
          auto& u = condition.displacement[i];
          u = base::Expression(fmt::format("{} + {}*{}/{:.17g}", u.text(), p, coordinates[i], dim * lambda + 2 * G));
          u.compile(tables);
        }
      load(dry, "west", first<std::string>(dim, {"-" + p, "0", "0"}));
      load(dry, "east", first<std::string>(dim, {p, "0", "0"}));
      if (dim == 3) load(dry, "south", {"0", "-" + p, "0"});
      if (dim == 3) load(dry, "north", {"0", p, "0"});
      model::Model one(wet, Tpetra::getDefaultComm()), other(dry, Tpetra::getDefaultComm());
      for (int step = 1; step <= 4; ++step) {
        ASSERT_TRUE(one.step_to(step).converged);
        ASSERT_TRUE(other.step_to(step).converged);
        const Outputs of_one(one), of_other(other);
        for (const std::string name : {"jump", "plastic jump", "traction", "state"}) {
          const auto &a = of_one[name].values, &b = of_other[name].values;
          ASSERT_EQ(a.size(), b.size());
          for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-9) << name << " at t = " << step;
        }
      }
    }
}

/// Returns the integrals of w and of w x over a crack from -1 to 1 in the middle of a box, under the pressure p (1 +
/// x/2), with n cells on the crack.
std::array<Real, 2> moments(const std::string& cell, const std::string& tips, int size, int n, Real p) {
  const Real middle = size / 2.0;
  auto scene = box_of_rock({cell, 2}, std::vector<Real>(2, size), {size * n / 2, size * n / 2}, "1e10");
  scene.mesh.tips = tips;
  scene.mesh.fractures["crack"].lower_corner = {middle - 1, middle};
  scene.mesh.fractures["crack"].upper_corner = {middle + 1, middle};
  scene.materials["joint"].type = "joint";
  scene.materials["joint"].friction_coefficient = base::Expression(0.6);
  scene.fractures["crack"].material = "joint";
  scene.fractures["crack"].fluid_pressure = expression(fmt::format("{}*(1 + (x - {})/2)", p, middle));
  for (const std::string side : {"west", "east", "south", "north"}) prescribe(scene, side, {"0", "0"});
  model::Model model(scene, Tpetra::getDefaultComm());
  const auto report = model.step_to(1);
  EXPECT_TRUE(report.converged) << report.reason;
  const Real on_last_face = p * (1.5 - 0.5 / n);  // largest value
  EXPECT_NEAR(model.system().scales().at("stress"), on_last_face, 1e-12 * p);
  const Outputs out(model);
  std::array<Real, 2> here{}, all;
  for (LocalIndex f = 0; f < model.mesh().n_owned_fracture_faces; ++f) {
    const auto& face = model.mesh().fracture_faces[f];
    EXPECT_EQ(out.scalar("state", f), 0);
    here[0] += face.area * out.scalar("opening", f);
    here[1] += face.area * out.scalar("opening", f) * (face.centre[0] - middle);
  }
  Teuchos::reduceAll(*model.mesh().comm, Teuchos::REDUCE_SUM, 2, here.data(), all.data());
  return all;
}

/// In infinite rock with nu = 0, the crack opening is w = 4 p/E (1 + x/4) sqrt(1 - x^2) (Sneddon 1946). Plain tips
/// have errors of first order; the finite box reduces w by the inverse square of its size. Two extrapolations remove
/// these errors; the remaining error is of second order in the cells, (1/8)^2. Enriched tips reach 1/40 without the
/// first extrapolation, plain tips do not.
TEST(FluidPressure, OpensACrack) {
  const Real E = 1e10, p = 1e6, exact[] = {2 * M_PI * p / E, M_PI / 8 * p / E};
  for (const auto& cell : cells_of(2)) {
    SCOPED_TRACE(cell);
    std::array<std::array<Real, 2>, 2> in_box, enriched;
    for (const int k : {0, 1}) {
      const auto coarse = moments(cell, "plain", 8 << k, 4, p), fine = moments(cell, "plain", 8 << k, 8, p);
      for (const int i : {0, 1}) in_box[k][i] = 2 * fine[i] - coarse[i];
      enriched[k] = moments(cell, "enriched", 8 << k, 8, p);
    }
    for (const int i : {0, 1}) {
      EXPECT_NEAR((4 * in_box[1][i] - in_box[0][i]) / 3 / exact[i], 1, 1 / 64.0);
      EXPECT_NEAR((4 * enriched[1][i] - enriched[0][i]) / 3 / exact[i], 1, 1 / 40.0);
    }
  }
}

/// Rock at rest under a uniform stress, the joint under this stress minus the pressure. Without traction on its sides
/// the joint opens until the rock, k_n = 3, carries the pressure.
TEST(FluidPressure, IsPartOfTheInitialState) {
  for (const int dim : {2, 3})
    for (const auto& d : discretisations(dim)) {
      SCOPED_TRACE(d.name());
      const std::string stress = dim == 2 ? "{-0.2, -0.2, -0.2, 0.05}" : "{-0.2, -0.2, -0.2, 0, 0, 0.05}";
      auto scene = read_scene(
          fmt::format("verification/regimes_{}d.xml", dim),
          d.with({values("tangential", {0, 0, 0, 0}), values("normal", {0, 0, 0, 0}), "Bulk.initial stress=" + stress,
                  "Fractures.fracture.fluid pressure=t < 1.5 ? 0.1 : 0.3"}));
      tie_sides(scene);
      model::Model model(scene, Tpetra::getDefaultComm());
      ASSERT_TRUE(model.step_to(1).converged);
      const Outputs at_rest(model);
      for (const Real u : at_rest["displacement"].values) EXPECT_NEAR(u, 0, 1e-12);
      const Real closure = -0.1 * 0.1 / (0.5 + 0.1);
      expect_joint(model, UniformJoint{0.05, -0.1, 0, 0.01 + closure, closure, 2}.along({1, 0, 0}, dim));
      ASSERT_TRUE(model.step_to(2).converged);
      const Outputs out(model);
      for (LocalIndex f = 0; f < model.mesh().n_owned_fracture_faces; ++f) {
        EXPECT_EQ(out.scalar("state", f), 0);
        EXPECT_NEAR(out.scalar("opening", f), 0.01 + closure + (0.3 - 0.2) / 3, tolerance);
      }
    }
}

}  // namespace
}  // namespace sprekk::tests
