// Solvers and bisections of steps do not change results.
#include "solve/factor_cost.hpp"
#include "verification/scenes.hpp"

namespace sprekk::tests {
namespace {

struct Run {
  std::unique_ptr<model::Model> model;
  solve::StepReport report;
};

Run run(const std::string& name, const std::vector<std::string>& overrides, Real t) {
  Run run;
  run.model = std::make_unique<model::Model>(read_scene(name, overrides), Tpetra::getDefaultComm());
  run.report = run.model->step_to(t);
  return run;
}

/// Returns the largest difference of two states in a block, relative to the largest value. Collective.
Real difference_of(const Run& a, const Run& b, int block) {
  fields::Vector d(*a.model->state()[block], Teuchos::Copy);
  d.update(-1, *b.model->state()[block], 1);
  return d.normInf() / a.model->state()[block]->normInf();
}

TEST(LinearSolvers, GiveTheSameSolution) {
  for (const std::string name : {"verification/crossing_3d.xml", "seed/immersed_3d.xml"}) {
    SCOPED_TRACE(name);
    const std::string mesh =
        name[0] == 'v' ? "Mesh.cells={12, 12, 12}" : "Mesh.cells={9, 9, 9}";  // too large for one level
    const auto direct = run(name, {mesh, "Solver.Linear solver.type=direct"}, 1);
    const auto iterative = run(name, {mesh, "Solver.Linear solver.type=iterative"}, 1),
               automatic = run(name, {mesh}, 1);
    for (const auto* r : {&direct, &iterative, &automatic}) ASSERT_TRUE(r->report.converged) << r->report.reason;
    for (const int block : {0, 2}) {  // displacement, traction
      EXPECT_LT(difference_of(direct, iterative, block), 1e-8);
      EXPECT_LT(difference_of(direct, automatic, block), 1e-8);
    }
    EXPECT_EQ(solve::iterations(direct.report.linear_solves), direct.report.newton_iterations);
    EXPECT_GT(solve::iterations(iterative.report.linear_solves), iterative.report.newton_iterations);
  }
}

/// Multigrid of order 1 below order 2, quarter points and tip functions: about as many iterations as order 1 (18 on
/// one rank). Multigrid on all unknowns, or without the tip functions, needs 27 to 34.
TEST(LinearSolvers, AFineLevelKeepsIterationsLow) {
  const std::vector<std::string> iterative = {"Solver.Linear solver.type=iterative", "Mesh.cells={6, 6, 6}"};
  for (const std::string entry : {"Mesh.order=2", "Mesh.tips=enriched"}) {
    SCOPED_TRACE(entry);
    auto overrides = iterative;
    overrides.push_back(entry);
    const auto krylov = run("seed/immersed_3d.xml", overrides, 1);
    overrides[0] = "Solver.Linear solver.type=direct";
    const auto direct = run("seed/immersed_3d.xml", overrides, 1);
    ASSERT_TRUE(krylov.report.converged) << krylov.report.reason;
    for (std::size_t block = 0; block < direct.model->state().size(); ++block)
      if (block != 1) EXPECT_LT(difference_of(direct, krylov, static_cast<int>(block)), 1e-7) << block;
    EXPECT_LE(solve::iterations(krylov.report.linear_solves), 24 * krylov.report.newton_iterations);
  }
}

/// In 2D the second level of nodes is solved directly, which saves iterations.
TEST(LinearSolvers, TheSecondLevelIn2DIsSolvedDirectly) {
  const std::string name = "verification/crossing_2d.xml", mesh = "Mesh.cells={48, 48}";
  const auto direct = run(name, {mesh, "Solver.Linear solver.type=direct"}, 1),
             usual = run(name, {mesh, "Solver.Linear solver.type=iterative"}, 1),
             small = run(name,
                         {mesh, "Solver.Linear solver.type=iterative",
                          "Solver.Blocks.displacement.multigrid.coarsest level=300"},
                         1);
  for (const auto* r : {&direct, &usual, &small}) ASSERT_TRUE(r->report.converged) << r->report.reason;
  for (const int block : {0, 2}) EXPECT_LT(difference_of(direct, usual, block), 1e-8) << block;
  const auto levels = [](const auto& r) {
    return r.model->newton().linear().solver().solver->costs().back().n_unknowns.size();
  };
  EXPECT_EQ(levels(usual), 2u);
  EXPECT_GT(levels(small), 2u);
  EXPECT_LT(solve::iterations(usual.report.linear_solves), solve::iterations(small.report.linear_solves));
}

/// In 2D the corners of face pressures are one level, solved directly, also above the limit in 3D.
TEST(LinearSolvers, CornersIn2DAreSolvedDirectly) {
  constexpr GlobalIndex limit_in_3d = 4000;
  const std::string name = "flow/network_2d.xml", mesh = "Mesh.cells={70, 70}";
  const Real t = 1e5;  // s
  const auto direct = run(name, {mesh, "Solver.Linear solver.type=direct"}, t),
             iterative = run(name, {mesh, "Solver.Linear solver.type=iterative"}, t);
  for (const auto* r : {&direct, &iterative}) ASSERT_TRUE(r->report.converged) << r->report.reason;
  for (std::size_t block = 0; block < direct.model->state().size(); ++block)
    EXPECT_LT(difference_of(direct, iterative, static_cast<int>(block)), 1e-8) << block;
  const auto corners = iterative.model->newton().linear().solver().solver->costs().back();
  EXPECT_EQ(corners.name, "multigrid of 'face pressure'");
  ASSERT_EQ(corners.n_unknowns.size(), 1u);
  EXPECT_GT(corners.n_unknowns.front(), limit_in_3d);
}

/// Opening and closing faces change the zeros among couplings of order 2; multigrid of order 1 keeps its graph.
TEST(LinearSolvers, OrderTwoFollowsContact) {
  auto r = run("contact/masonry_wall_2d.xml",
               {"Solver.Linear solver.type=iterative", "Mesh.cells={32, 24}", "Mesh.order=2"}, 1);
  for (const Real t : {2.0, 3.0}) {
    ASSERT_TRUE(r.report.converged) << r.report.reason;
    EXPECT_LE(solve::iterations(r.report.linear_solves), 15 * r.report.newton_iterations);
    EXPECT_LE(r.report.newton_iterations, 10);  // 4, 7 and 8, as with MueLu
    r.report = r.model->step_to(t);
  }
  ASSERT_TRUE(r.report.converged) << r.report.reason;
}

/// Forcing ends linear solves early and saves iterations, during changes of contact states and afterwards. It changes
/// neither the solution nor, significantly, the number of Newton steps.
TEST(LinearSolvers, ForcingSavesIterations) {
  std::vector<std::string> overrides = {"Solver.Linear solver.type=iterative", "Mesh.tips=plain",
                                        "Materials.joint.friction coefficient=0.05",
                                        "Solver.Linear solver.forcing=true"};
  const auto forced = run("contact/network_3d.xml", overrides, 2);
  overrides.back() = "Solver.Linear solver.forcing=false";
  const auto exact = run("contact/network_3d.xml", overrides, 2);
  for (const auto* r : {&forced, &exact}) ASSERT_TRUE(r->report.converged) << r->report.reason;
  EXPECT_GT(exact.report.newton_iterations, 4);  // contact states change
  EXPECT_LE(forced.report.newton_iterations, exact.report.newton_iterations + 2);
  for (const int block : {0, 2}) EXPECT_LT(difference_of(exact, forced, block), 1e-8);
  EXPECT_LT(solve::iterations(forced.report.linear_solves), 0.65 * solve::iterations(exact.report.linear_solves));
  EXPECT_GT(forced.report.linear_solves.back().residual, 1e-11);
  for (const auto& linear : exact.report.linear_solves) EXPECT_LT(linear.residual, 1e-10);
}

/// The tolerance of the last linear solve follows from Newton's tolerance.
TEST(LinearSolvers, ForcingLooksAtTheToleranceOfNewton) {
  std::vector<std::string> overrides = {"Solver.Linear solver.type=iterative", "Mesh.tips=plain",
                                        "Materials.joint.friction coefficient=0.05", "Solver.tolerance=1e-11"};
  const auto tight = run("contact/network_3d.xml", overrides, 1);
  overrides.back() = "Solver.tolerance=1e-8";
  const auto loose = run("contact/network_3d.xml", overrides, 1);
  EXPECT_LE(loose.report.newton_iterations, tight.report.newton_iterations);
  EXPECT_GT(loose.report.linear_solves.back().residual, 10 * tight.report.linear_solves.back().residual);
}

TEST(LinearSolvers, AutomaticChoiceFollowsItsLimits) {
  const std::string name = "seed/immersed_3d.xml";
  const auto few = run(name, {"Solver.Linear solver.direct limit 3D=20000"}, 1),
             many = run(name, {"Solver.Linear solver.direct limit 3D=100"}, 1);
  EXPECT_EQ(few.model->newton().linear().solver().reason.substr(0, 6), "direct");
  EXPECT_EQ(many.model->newton().linear().solver().reason.substr(0, 9), "iterative");
}

/// Factors replace multigrid where their estimated cost is lower: on one rank for pressures in 2D, and in 3D without
/// other fields, but not for displacements.
TEST(LinearSolvers, AutomaticChoiceOfBlocksFollowsTheirCosts) {
  const std::string multigrid = "Solver.Linear solver.type=iterative";
  for (const std::string name : {"performance/flow_discs.xml", "poro/injection_3d.xml", "poro/injection_2d.xml"}) {
    SCOPED_TRACE(name);
    const bool alone = name.starts_with("performance");
    const int dim = name.ends_with("2d.xml") ? 2 : 3;
    const std::vector<std::string> limits = {fmt::format("Solver.Linear solver.direct limit {}D=100", dim)};
    const Real t = read_scene(name, {}).time.times().front();
    const auto automatic = run(name, limits, t), iterative = run(name, {multigrid}, t);
    for (const auto* r : {&automatic, &iterative}) ASSERT_TRUE(r->report.converged) << r->report.reason;
    const auto type_of = [](const tests::Run& r, const std::string& block) {
      const auto& blocks = r.model->newton().linear().solver().solver->parameters().sublist("Blocks");
      return blocks.isSublist(block) ? blocks.sublist(block).get<std::string>("type") : "";
    };
    const auto n_unknowns_of = [](const tests::Run& r, const std::string& block) {
      std::size_t n = 0;
      for (std::size_t b = 0; b < r.model->state().size(); ++b)
        if (r.model->system().layouts()[b].field().name == block) n = r.model->state()[b]->getGlobalLength();
      return static_cast<Real>(n);
    };
    const solve::FacetMatrix pressures{n_unknowns_of(automatic, "face pressure"), dim, alone,
                                       Tpetra::getDefaultComm()->getSize()};
    if (pressures.n_ranks == 1) EXPECT_EQ(solve::factors_are_cheaper(pressures), dim == 2 || alone);
    EXPECT_EQ(type_of(automatic, "face pressure") == "direct", solve::factors_are_cheaper(pressures));
    EXPECT_NE(type_of(iterative, "face pressure"), "direct");
    EXPECT_NE(type_of(automatic, "displacement"), "direct");
    for (std::size_t block = 0; block < automatic.model->state().size(); ++block)
      EXPECT_LT(difference_of(iterative, automatic, static_cast<int>(block)), 1e-6) << block;
    EXPECT_LE(solve::iterations(automatic.report.linear_solves), solve::iterations(iterative.report.linear_solves));
  }
}

/// Displacements, and pressures in rock and fractures, with all kinds of preconditioners by block names.
TEST(LinearSolvers, BlocksArePreconditionedAsAsked) {
  const std::string name = "poro/injection_2d.xml", blocks = "Solver.Blocks.";
  const Real t = 1800;  // s
  const auto direct = run(name, {"Solver.Linear solver.type=direct"}, t);
  ASSERT_TRUE(direct.report.converged) << direct.report.reason;
  for (const std::vector<std::string>& overrides : std::vector<std::vector<std::string>>{
           {"Solver.Sweep.type=symmetric"},
           {blocks + "displacement.type=MueLu", blocks + "face pressure.type=MueLu"},
           {blocks + "face pressure.type=Ifpack2", blocks + "face pressure.Ifpack2.type=ILUT",
            blocks + "face pressure.Ifpack2.fact: ilut level-of-fill=4.0",
            "Solver.Sweep.order={face pressure, displacement}"},
           {blocks + "displacement.type=direct", blocks + "face pressure.type=direct", "Solver.Sweep.type=diagonal"},
           {blocks + "displacement.type=direct", blocks + "face pressure.with=displacement"}}) {
    SCOPED_TRACE(overrides.front());
    auto all = overrides;
    all.push_back("Solver.Linear solver.type=iterative");
    const auto r = run(name, all, t);
    ASSERT_TRUE(r.report.converged) << r.report.reason;
    for (std::size_t block = 0; block < r.model->state().size(); ++block)
      EXPECT_LT(difference_of(direct, r, static_cast<int>(block)), 1e-6) << block;
  }
}

TEST(LinearSolvers, EntriesOfTheLibrariesTakeEffect) {
  const std::string name = "seed/immersed_3d.xml", iterative = "Solver.Linear solver.type=iterative",
                    to_the_end = "Solver.Linear solver.forcing=false";
  const auto usual = run(name, {iterative, "Mesh.tips=plain", to_the_end}, 1);
  ASSERT_TRUE(usual.report.converged);
  const auto unsmoothed = run(name,
                              {iterative, "Mesh.tips=plain", to_the_end, "Solver.Blocks.displacement.type=MueLu",
                               "Solver.Blocks.displacement.MueLu.multigrid algorithm=unsmoothed"},
                              1);
  ASSERT_TRUE(unsmoothed.report.converged);
  const auto per_solve = [](const auto& r) {
    return 1.0 * solve::iterations(r.report.linear_solves) / r.report.newton_iterations;
  };
  EXPECT_GT(per_solve(unsmoothed), per_solve(usual));
  const auto& muelu = unsmoothed.model->newton().linear().solver().solver->parameters();
  EXPECT_NE(unsmoothed.model->newton().linear().solver().describe().find("unsmoothed"), std::string::npos) << muelu;

  const auto impatient =
      run(name, {iterative, "Solver.Linear solver.Belos.Maximum Iterations=2", "Time.maximum halvings=0"}, 1);
  EXPECT_FALSE(impatient.report.converged);
  EXPECT_FALSE(impatient.report.reason.empty());
  const auto cg = run(name, {iterative, "Mesh.tips=plain", "Solver.Linear solver.Belos.Solver Type=Block CG"}, 1);
  ASSERT_TRUE(cg.report.converged) << cg.report.reason;
  EXPECT_NE(cg.model->newton().linear().solver().describe().find("Block CG"), std::string::npos);
  EXPECT_LT(difference_of(usual, cg, 0), 1e-8);
}

/// With a limit of three Newton steps, the full step fails and is bisected; the step must reach its end. The traction
/// on the sides is the exact shear traction min(2/3 d_t, 0.18), so every substep is exact.
TEST(StepCuts, ReachTheEndOfTheStep) {
  const std::string name = "verification/cyclic_3d.xml";
  const std::vector<std::string> path = {"Time.schedule={1}", "Tables.tangential.arguments={0, 1}",
                                         "Tables.tangential.values={0, 0.5}", "Tables.shear.arguments={0, 0.54, 1}",
                                         "Tables.shear.values={0, 0.18, 0.18}"};
  auto few = path;
  few.push_back("Solver.maximum iterations=3");
  few.push_back("Solver.tolerance=1e-10");
  few.push_back("Time.maximum halvings=8");
  few.push_back("Time.proximal continuation=false");
  const auto whole = run(name, path, 1), cut = run(name, few, 1);
  ASSERT_TRUE(whole.report.converged);
  EXPECT_EQ(whole.report.cuts, 0);
  ASSERT_TRUE(cut.report.converged) << cut.report.reason;
  EXPECT_GT(cut.report.cuts, 0);
  EXPECT_GT(cut.report.substeps, 1);
  EXPECT_EQ(cut.report.time, 1);
  EXPECT_EQ(cut.model->time(), 1);
  const Outputs out(*cut.model);
  for (LocalIndex f = 0; f < cut.model->mesh().n_owned_fracture_faces; ++f) {
    EXPECT_NEAR(out.vector("plastic jump", f)[0], 0.23, 1e-9);
    EXPECT_NEAR(out.vector("traction", f)[0], 0.18, 1e-9);
  }
}

TEST(StepCuts, FailureKeepsTheLastStateThatConverged) {
  model::Model model(
      read_scene("verification/crossing_2d.xml", {"Solver.maximum iterations=1", "Time.maximum halvings=2"}),
      Tpetra::getDefaultComm());
  const auto report = model.step_to(4);
  EXPECT_FALSE(report.converged);
  EXPECT_LT(report.time, 4);
  EXPECT_EQ(model.time(), report.time);
  EXPECT_GE(report.cuts, 2);
  EXPECT_NE(report.reason.find("no convergence in 1 iterations"), std::string::npos) << report.reason;
}

}  // namespace
}  // namespace sprekk::tests
