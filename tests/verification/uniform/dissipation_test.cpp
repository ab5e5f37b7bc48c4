// Work of slip and dilation on meshes, for each step and face; anisotropic damage compared with the sum over all
// steps.
#include "base/over_ranks.hpp"
#include "verification/uniform/states.hpp"

namespace sprekk::tests {
namespace {

/// Outputs on owned fracture faces after a step; vectors in the frame of the face.
struct Faces {
  std::vector<Real> plastic, traction, history, error, damage, state;

  explicit Faces(model::Model& model) {
    const std::pair<const char*, std::vector<Real>*> wanted[] = {
        {"plastic jump local", &plastic},    {"traction local", &traction},   {"damage history", &history},
        {"error of damage history", &error}, {"damage of friction", &damage}, {"state", &state}};
    for (auto& output : model.system().outputs(model.state()))
      for (const auto& [name, values] : wanted)
        if (output.name == name) *values = output.values;
  }
};

struct Segment {
  std::array<Real, 2> a, b;
};

/// Returns the sum of |<m.b> - <m.a>| over the segments, for the direction m of u.
Real history_along(const std::vector<Segment>& path, const std::array<Real, 2>& u) {
  const Real size = std::hypot(u[0], u[1]);
  const auto along = [&](const auto& v) { return std::max((u[0] * v[0] + u[1] * v[1]) / size, Real(0)); };
  Real sum = 0;
  for (const auto& [a, b] : path) sum += std::abs(along(b) - along(a));
  return sum;
}
Real length(const std::vector<Segment>& path) {
  Real sum = 0;
  for (const auto& [a, b] : path) sum += std::hypot(b[0] - a[0], b[1] - a[1]);
  return sum;
}

/// Runs all steps and calls visit(faces, faces before) after each.
template <class Visit>
void run(model::Model& model, const Visit& visit) {
  Faces before(model);
  for (const Real t : model.scene().time.times()) {
    SCOPED_TRACE(t);
    const auto report = model.step_to(t);
    ASSERT_TRUE(report.converged) << report.reason;
    const Faces now(model);
    visit(now, before);
    before = now;
  }
}

/// Checks lambda . du^p >= 0; the normal part includes dilation with wear.
void expect_dissipation(const std::string& name, const std::vector<std::string>& overrides) {
  SCOPED_TRACE(name);
  model::Model model(read_scene(name, overrides), Tpetra::getDefaultComm());
  const int dim = model.mesh().dim();
  Real maximum = 0, minimum = 0;
  int slips = 0;
  run(model, [&](const Faces& now, const Faces& before) {
    for (std::size_t f = 0; f < now.state.size(); ++f) {
      Real work = 0;
      for (int i = 0; i < dim; ++i) {
        const auto k = f * dim + i;
        work += now.traction[k] * (now.plastic[k] - before.plastic[k]);
      }
      maximum = std::max(maximum, work);
      minimum = std::min(minimum, work);
      slips += now.state[f] == 2;
    }
  });
  const auto& comm = *model.mesh().comm;
  maximum = base::max_over_ranks(comm, maximum);
  EXPECT_GE(minimum, -1e-10 * maximum);
  EXPECT_GT(maximum, 0);
  EXPECT_GT(base::sum_over_ranks(comm, slips), 50);
}

TEST(Dissipation, IsNeverNegativeWithDamageAndDilation) {
  for (const std::string scene : {"contact/damage_cycles_2d.xml", "contact/damage_turns_3d.xml"})
    for (const std::string damage : {"isotropic", "anisotropic"})
      for (const std::string driver : {"slip", "compression", "frictional work"}) {
        std::vector<std::string> overrides = {"Materials.joint.damage=" + damage,
                                              "Materials.joint.damage driver=" + driver};
        if (driver != "slip") overrides.push_back("Materials.joint.reference stress=0.3");
        SCOPED_TRACE(damage + ", " + driver);
        expect_dissipation(scene, overrides);
      }
}

TEST(AnisotropicDamage, IsThatOfTheSumOverAllStepsIn3D) {
  model::Model model(read_scene("contact/damage_turns_3d.xml"), Tpetra::getDefaultComm());
  std::vector<std::vector<Segment>> paths;
  Real largest_error = 0;
  int slips = 0;
  run(model, [&](const Faces& now, const Faces& before) {
    paths.resize(now.state.size());
    for (std::size_t f = 0; f < paths.size(); ++f) {
      const Real *p = &now.plastic[3 * f + 1], *old = &before.plastic[3 * f + 1], *traction = &now.traction[3 * f];
      paths[f].push_back({{old[0], old[1]}, {p[0], p[1]}});
      const Real size = std::hypot(p[0], p[1]);
      if (size < 5e-3) continue;  // near sector boundaries
      const Real exact = history_along(paths[f], {p[0], p[1]});
      EXPECT_LE(std::abs(now.history[f] - exact), now.error[f] * length(paths[f]) + 1e-9) << f;
      EXPECT_NEAR(1 - now.damage[f], 0.7 + 0.3 * std::exp(-now.history[f] / 10), 1e-12);
      largest_error = std::max(largest_error, now.error[f]);
      if (now.state[f] != 2) continue;
      ++slips;
      EXPECT_NEAR(std::hypot(traction[1], traction[2]), -0.6 * (1 - now.damage[f]) * traction[0], 1e-9);
    }
  });
  EXPECT_TRUE(anywhere(*model.mesh().comm, slips > 50));
  EXPECT_TRUE(anywhere(*model.mesh().comm, largest_error > 0));  // more directions than the table can store
  EXPECT_LT(largest_error, 1e-3);
}

}  // namespace
}  // namespace sprekk::tests
