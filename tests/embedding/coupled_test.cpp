// Flow of a host, coupled by exchange and in one Jacobian, compared with Sprekk's own flow.
#include "assembly/jacobian_check.hpp"
#include "hosts/coupled.hpp"

#include <Tpetra_Core.hpp>
#include <gmock/gmock.h>

#include <set>

namespace sprekk::tests {
namespace {

using ::testing::HasSubstr;

/// Injection into a fracture, which opens: three implementations of the same equations.
TEST(CoupledFlow, IsTheSameByExchangeAndInOneJacobian) {
  const auto comm = Tpetra::getDefaultComm();
  for (const int dim : {2, 3})
    for (const std::string solver : {"direct", "iterative"}) {
      if (dim == 3 && solver == "direct") continue;
      SCOPED_TRACE(fmt::format("{}D, {}", dim, solver));
      const int cells = dim == 2 ? 8 : 4;
      auto scene = hosts::block(dim, cells);
      scene.solver.linear_solver.type = solver;
      scene.solver.linear_solver.preconditioner.blocks["displacement"].multigrid.emplace().coarsest =
          20;  // otherwise multigrid is a direct solver
      hosts::Exchange exchange(dim, cells, comm, scene);
      const auto together = hosts::make_together(scene, comm), sprekk = hosts::make_sprekk(scene, comm);
      std::set<std::array<int, 3>> states;
      for (const Real t : {hosts::dt, 2 * hosts::dt}) {
        hosts::Cost cost, of_sprekk;
        hosts::take(*together, t, cost);
        hosts::take(*sprekk, t, of_sprekk);
        EXPECT_LT(cost.newton, exchange.step(t, 1e-5).newton);
        EXPECT_EQ(cost.newton, of_sprekk.newton);
        states.insert(hosts::count_states(*together));
        const auto p = hosts::pressures(*together);
        EXPECT_LT(hosts::distance(exchange.pressures(), p, *comm), 1e-8);
        EXPECT_LT(hosts::distance(hosts::pressures(*sprekk), p, *comm), 1e-8);
        for (const char* name : {"displacement", "jump", "traction"}) {
          const auto values = together->output(name).values;
          EXPECT_LT(hosts::distance(exchange.model().output(name).values, values, *comm), 1e-8) << name;
          EXPECT_LT(hosts::distance(sprekk->output(name).values, values, *comm), 1e-8) << name;
        }
      }
      EXPECT_EQ(states.size(), 2u);  // contact states change
    }
}

TEST(CoupledFlow, JacobiansAreDerivativesOfResiduals) {
  for (const int dim : {2, 3}) {
    const auto model = hosts::make_together(hosts::block(dim, 4), Tpetra::getDefaultComm());
    auto& system = model->system();
    system.set_time(hosts::dt, hosts::dt);
    auto x = system.initial();
    for (std::size_t b = 0; b < x.size(); ++b) {
      x[b]->randomize(-1, 1);
      x[b]->scale(system.blocks()[b].kinematic_scale);
    }
    std::set<std::string> modules;
    for (const auto& error : assembly::check_jacobian(system, x)) {
      if (error.module != "own flow" && error.module != "poroelastic coupling") continue;
      modules.insert(error.module);
      EXPECT_LT(error.error, 1e-6) << error.module << ": " << error.row << ", " << error.column;
    }
    EXPECT_EQ(modules.size(), 2u);
  }
}

/// Under an all-round load P_0 and a uniform pressure p, the strain follows from the effective stress -P_0 + alpha (p
/// - p_0). The sides of fractures have the contact pressure P_0 - p, and the pore volume increases by alpha
/// tr(strain).
TEST(GivenPressure, ChangesTheEffectiveStress) {
  const auto comm = Tpetra::getDefaultComm();
  for (const int dim : {2, 3})
    for (const Real at_start : {0.0, 5e5}) {
      auto scene = hosts::block(dim, 4);
      scene.boundary_conditions["north"].traction[0] = 0;
      scene.host_fluid = physics::HostFluid{false, at_start};
      model::Model model(scene, comm);
      const auto& mesh = model.mesh();
      const Real P_0 = 2e6, p = 1e6, above = p - at_start;
      physics::set_fluid_pressure(model.system(), std::vector<Real>(mesh.n_owned_cells, p),
                                  std::vector<Real>(mesh.n_owned_fracture_faces, p));
      ASSERT_TRUE(model.step_to(1).converged);
      const Real lambda = hosts::E * hosts::nu / ((1 + hosts::nu) * (1 - 2 * hosts::nu));
      const Real strain = (-P_0 + hosts::alpha * above) / (hosts::E / (1 + hosts::nu) + dim * lambda);
      const auto u = model.output("displacement").values;
      for (std::size_t k = 0; k < u.size(); ++k) EXPECT_NEAR(u[k], strain * mesh.coordinates[k], -1e-9 * strain);
      for (const Real V : model.output("gained pore volume").values)
        EXPECT_NEAR(V, hosts::alpha * dim * strain * std::pow(0.25, dim), -1e-9 * strain);
      for (const Real b : model.output("widening").values) EXPECT_NEAR(b, 0, -1e-9 * strain);
      const auto traction = model.output("traction local").values;
      for (std::size_t f = 0; f < traction.size(); f += dim) EXPECT_NEAR(traction[f], p - P_0, 1e-9 * P_0);
    }
}

TEST(TakeBack, LeavesNoTrace) {
  const auto comm = Tpetra::getDefaultComm();
  auto scene = hosts::block(2, 8);
  scene.solver.linear_solver.reproducible = true;
  scene.time.scheme = "BDF2";
  const auto twice = hosts::make_together(scene, comm), once = hosts::make_together(scene, comm);
  for (const Real t : {hosts::dt, 2 * hosts::dt, 2.5 * hosts::dt}) {
    ASSERT_TRUE(twice->step_to(3 * t).converged);
    twice->take_back();
    ASSERT_TRUE(twice->step_to(t).converged);
    ASSERT_TRUE(once->step_to(t).converged);
    for (const char* name : {"displacement", "jump", "plastic jump", "traction"})
      EXPECT_LT(hosts::distance(twice->output(name).values, once->output(name).values, *comm), 1e-11) << name;
    EXPECT_LT(hosts::distance(hosts::pressures(*twice), hosts::pressures(*once), *comm), 1e-11);
  }
  EXPECT_EQ(twice->time(), 2.5 * hosts::dt);
}

TEST(TakeBack, MistakesAreErrors) {
  const auto comm = Tpetra::getDefaultComm();
  const auto error_of = [](const auto& work) -> std::string {
    try {
      work();
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  auto scene = hosts::block(2, 4);
  model::Model without(scene, comm);
  EXPECT_THAT(error_of([&] { without.take_back(); }), HasSubstr("there is no step to take back, at t = 0"));
  EXPECT_THAT(error_of([&] { physics::set_fluid_pressure(without.system(), {}, {}); }),
              HasSubstr("the scene has no host_fluid"));
  scene.host_fluid = physics::HostFluid();
  model::Model given(scene, comm);
  scene.fractures.begin()->second.fluid_pressure = 1;
  EXPECT_THAT(error_of([&] { model::Model twice(scene, comm); }), HasSubstr("is computed, not given"));
  scene.fractures.begin()->second.fluid_pressure = 0;
  EXPECT_THAT(error_of([&] { physics::set_fluid_pressure(given.system(), {}, {}); }),
              HasSubstr("pressures of 0 cells and 0 fracture faces are given, a rank has "));
  ASSERT_TRUE(given.step_to(1).converged);
  given.take_back();
  EXPECT_EQ(given.time(), 0);
  EXPECT_THAT(error_of([&] { given.take_back(); }), HasSubstr("no step to take back"));
  scene.host_fluid->unknown = true;
  EXPECT_THAT(error_of([&] { model::Model nobody(scene, comm); }),
              HasSubstr("no module declares the field \"pressure\""));
}

}  // namespace
}  // namespace sprekk::tests
