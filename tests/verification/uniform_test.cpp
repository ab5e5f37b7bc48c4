// Uniform states of stress, exact on any mesh: every regime of the joint law, hysteresis, and intact rock.
#include "verification/scenes.hpp"

namespace sprekk::tests {
namespace {

constexpr Real K_t = 2;  // of all joints here

/// A horizontal joint sheared along m: traction (l_t m, l_n), plastic jump u_p along m, opening, closure B(l_n).
Expected state(int dim, const Vector3& m, Real l_t, Real l_n, Real u_p, Real opening, Real closure) {
  Expected e;
  e.n = dim == 2 ? Vector3{0, 1, 0} : Vector3{0, 0, 1};
  for (int i = 0; i < 3; ++i) {
    e.traction[i] = l_t * m[i] + l_n * e.n[i];
    e.elastic[i] = l_t / K_t * m[i] + closure * e.n[i];
    e.plastic[i] = u_p * m[i] + (opening - closure) * e.n[i];
  }
  return e;
}

std::string values(const std::string& table, const std::vector<Real>& v) {
  return fmt::format("Tables.{}.values={{{:.17g}}}", table, fmt::join(v, ", "));
}

/// Cyclic shear, cases by hand: N = 0.3, bound 0.18, K_s = 2/3.
const std::vector<Real> cyclic_l_t = {0.2 / 3, 0.18, 0.18, 0.14 / 3, -0.18, 0.02, 0.18, 0.18};
const std::vector<Real> cyclic_u_p = {0, 0.23, 0.23, 0.23, -0.23, -0.23, 0.23, 0.23};

void expect_cycle(const model::Scene& scene, const Vector3& m, const Matrix3& Q) {
  model::Model model(scene, Tpetra::getDefaultComm());
  for (int k = 1; k <= 8; ++k) {
    SCOPED_TRACE(k);
    const auto report = model.step_to(k);
    ASSERT_TRUE(report.converged) << report.reason;
    EXPECT_EQ(report.cuts, 0);
    expect_joint(
        model,
        state(static_cast<int>(scene.mesh.lower_corner.size()), m, cyclic_l_t[k - 1], -0.3, cyclic_u_p[k - 1], 0, 0),
        Q);
  }
}

TEST(CyclicShear, HysteresisOnEveryMesh) {
  for (const int dim : {2, 3})
    for (const auto& cell : cells_of(dim))
      for (const int n : dim == 2 ? std::vector<int>{2, 6, 16} : std::vector<int>{2, 4}) {
        SCOPED_TRACE(fmt::format("{} {}", cell, n));
        auto scene = read_scene(fmt::format("verification/cyclic_{}d.xml", dim));
        scene.mesh.cell = cell;
        scene.mesh.cells.assign(dim, n);
        expect_cycle(scene, {1, 0, 0}, identity());
      }
}

TEST(CyclicShear, Turned) {
  for (const int dim : {2, 3})
    for (const auto& cell : cells_of(dim))
      for (const Real degrees : {27.0, 90.0, -144.0}) {
        SCOPED_TRACE(fmt::format("{} {} degrees", cell, degrees));
        auto scene = read_scene(fmt::format("verification/cyclic_{}d.xml", dim));
        scene.mesh.cell = cell;
        scene.mesh.fractures.at("fracture").swap_sides = degrees == 90;
        scene.mesh.renumbering_seed = 3;
        const auto Q = turn(scene, degrees, dim == 2 ? Vector3{0, 0, 1} : Vector3{-1, 2, 0.5});
        expect_cycle(scene, {1, 0, 0}, Q);
      }
}

/// Shear along no axis of the joint's frame.
TEST(CyclicShear, Oblique) {
  for (const auto& cell : cells_of(3)) {
    SCOPED_TRACE(cell);
    const Real c = std::cos(0.7), s = std::sin(0.7);
    const auto set = [](const std::string& entry, const std::array<std::string, 3>& text) {
      return fmt::format("Boundary conditions.{}={{{}}}", entry, fmt::join(text, ", "));
    };
    const auto shear = [&](Real factor) { return fmt::format("({:.17g})*shear(t)", factor); };
    const auto scene = read_scene(
        "verification/cyclic_3d.xml",
        {"Mesh.cell=" + cell,
         set("moved.displacement",
             {fmt::format("{:.17g}*tangential(t)", c), fmt::format("{:.17g}*tangential(t)", s), "-0.1"}),
         set("left.traction", {"-lateral(t)", "0", shear(-c)}), set("right.traction", {"lateral(t)", "0", shear(c)}),
         set("front.traction", {"0", "-lateral(t)", shear(-s)}), set("back.traction", {"0", "lateral(t)", shear(s)})});
    expect_cycle(scene, {c, s, 0}, identity());
  }
}

/// Steps that slide, not those that hold a joint exactly at its friction limit.
TEST(CyclicShear, StateTellsStickFromSlip) {
  for (const int dim : {2, 3}) {
    model::Model model(read_scene(fmt::format("verification/cyclic_{}d.xml", dim)), Tpetra::getDefaultComm());
    const std::vector<int> states = {1, 2, 0, 1, 2, 1, 2, 0};
    for (int k = 1; k <= 8; ++k) {
      ASSERT_TRUE(model.step_to(k).converged);
      const Outputs out(model);
      for (LocalIndex f = 0; f < model.mesh().n_owned_fracture_faces; ++f)
        if (states[k - 1] != 0) {
          EXPECT_EQ(out.scalar("state", f), states[k - 1]) << "step " << k;
        }
    }
  }
}

/// Displacement of the top, then traction, plastic jump and opening after a single step, or one after the row before.
struct Regime {
  const char* name;
  Real d_t, d_n, l_t, l_n, u_p, opening;
  bool follows_slip;
};

const Regime slip = {"slip", 0.5, -0.1, 0.193791423668, -0.322985706114, 0.209312864497, 0.007661902038, false};
const std::vector<Regime> regimes = {
    {"open", 0.2, 0.2, 0, 0, 0.2, 0.2, false},
    {"stick", 0.05, -0.1, 0.033333333333, -0.234281365494, 0, -0.021906211502, false},
    slip,
    {"strongly dilating", 1, -0.05, 0.234665843754, -0.391109739590, 0.648001234369, 0.080369913197, false},
    {"unloaded to stick", 0.35, -0.1, 0.093791423668, -0.322985706114, 0.209312864497, 0.007661902038, true},
    {"reverse slip", -0.6, -0.1, -0.212578130501, -0.354296884168, -0.281132804249, 0.018098961389, true},
    {"nearly open", 0.3, 0.05, 0.011301447522, -0.018835745870, 0.283047828717, 0.056278581957, false}};

/// Barton-Bandis closure with Du = 0.1, K_n = 5.
Real closure(Real l_n) { return 0.1 * l_n / (0.5 - l_n); }

TEST(JointRegimes, ExactStates) {
  for (const int dim : {2, 3})
    for (const auto& cell : cells_of(dim))
      for (const auto& r : regimes) {
        SCOPED_TRACE(fmt::format("{}: {}", cell, r.name));
        const auto path = [&](Real Regime::*member, Real factor) {
          const Real before = r.follows_slip ? factor * slip.*member : factor * r.*member;
          return std::vector<Real>{0, before, factor * r.*member, 0};
        };
        const auto scene = read_scene(
            fmt::format("verification/regimes_{}d.xml", dim),
            {"Mesh.cell=" + cell, values("tangential", path(&Regime::d_t, 1)), values("normal", path(&Regime::d_n, 1)),
             values("shear", path(&Regime::l_t, 1)), values("lateral", path(&Regime::l_n, 1.0 / 3))});
        model::Model model(scene, Tpetra::getDefaultComm());
        ASSERT_TRUE(model.step_to(1).converged);
        if (r.follows_slip) {
          ASSERT_TRUE(model.step_to(2).converged);
        }
        expect_joint(model, state(dim, {1, 0, 0}, r.l_t, r.l_n, r.u_p, r.opening, closure(r.l_n)));
      }
}

/// The chain of the scene as it is: slip, unloaded to stick, reverse slip.
TEST(JointRegimes, Scene) {
  for (const int dim : {2, 3}) {
    model::Model model(read_scene(fmt::format("verification/regimes_{}d.xml", dim)), Tpetra::getDefaultComm());
    int k = 0;
    for (const auto& r : {slip, regimes[4], regimes[5]}) {
      SCOPED_TRACE(r.name);
      ASSERT_TRUE(model.step_to(++k).converged);
      expect_joint(model, state(dim, {1, 0, 0}, r.l_t, r.l_n, r.u_p, r.opening, closure(r.l_n)));
    }
  }
}

/// E = 10 GPa, nu = 0.25, 5 MPa on top; plane strain in 2D.
TEST(IntactRock, UniaxialCompression) {
  constexpr Real E = 10e9, nu = 0.25, p = 5e6;
  for (const int dim : {2, 3})
    for (const auto& cell : cells_of(dim)) {
      SCOPED_TRACE(cell);
      model::Model model(read_scene(fmt::format("verification/uniaxial_{}d.xml", dim), {"Mesh.cell=" + cell}),
                         Tpetra::getDefaultComm());
      const auto report = model.step_to(1);
      ASSERT_TRUE(report.converged);
      EXPECT_EQ(report.newton_iterations, 1);
      const Real along = dim == 2 ? -p * (1 - nu * nu) / E : -p / E,
                 across = dim == 2 ? p * nu * (1 + nu) / E : p * nu / E;
      const Outputs out(model);
      const auto& mesh = model.mesh();
      for (LocalIndex node = 0; node < mesh.n_nodes(); ++node)
        for (int i = 0; i < dim; ++i) {
          const Real strain = i == dim - 1 ? along : across;
          EXPECT_NEAR(out["displacement"].values[node * dim + i], strain * mesh.coordinates[node * dim + i],
                      1e-12 * 4 * p / E * 10);
        }
      const Vector3 exact = dim == 2 ? Vector3{0, -p, -nu * p} : Vector3{0, 0, -p};
      for (LocalIndex c = 0; c < mesh.n_owned_cells; ++c)
        for (int i = 0; i < 6; ++i) EXPECT_NEAR(out["stress"].values[c * 6 + i], i < 3 ? exact[i] : 0, 1e-10 * p);
    }
}

}  // namespace
}  // namespace sprekk::tests
