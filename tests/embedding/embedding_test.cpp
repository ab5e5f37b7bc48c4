// Interface for hosts: scenes built in C++ are checked like files, and fields are accessible in place. Modules of the
// host have the same services as built-in modules, and their unknowns are part of the system.
#include "assembly/capabilities.hpp"
#include "assembly/jacobian_check.hpp"
#include "base/xml.hpp"
#include "hosts/grout.hpp"
#include "physics/mechanics/elastic_foundation.hpp"
#include "solve/local_elimination.hpp"
#include "unit/io/scratch.hpp"
#include "verification/scenes.hpp"

#include <gmock/gmock.h>

namespace sprekk::tests {
namespace {

using ::testing::HasSubstr;

constexpr Real E = 10e9, K = 0.5e9, thickness = 0.02, squeeze = 5e-4;  // Pa, Pa, m, m

/// Returns a column of 1 m with a fracture through its middle, between rollers. Its top moves down by 1 mm per unit of
/// time.
model::Scene column(const Discretisation& cells) {
  const bool flat = cells.cell == "quadrilateral" || cells.cell == "triangle";
  const int dim = flat ? 2 : 3;
  model::Scene scene;
  scene.mesh.cell = cells.cell;
  scene.mesh.order = cells.order;
  scene.mesh.lower_corner.assign(dim, 0);
  scene.mesh.upper_corner.assign(dim, 1);
  scene.mesh.cells.assign(dim, 2);
  scene.mesh.cells[1] = 4;
  auto& fracture = scene.mesh.fractures["void"];
  fracture.lower_corner.assign(dim, 0);
  fracture.upper_corner.assign(dim, 1);
  fracture.lower_corner[1] = fracture.upper_corner[1] = 0.5;
  auto& rock = scene.materials["rock"];
  rock.type = "elastic";
  rock.E = E;
  rock.nu = 0;
  auto& walls = scene.materials["walls"];
  walls.type = "joint";
  walls.friction_coefficient = 0.6;
  walls.initial_gap = -squeeze;
  scene.bulk.material = "rock";
  scene.fractures["void"].material = "walls";
  const auto constrain = [&](const std::string& boundary, int direction, const base::Expression& value) {
    auto& condition = scene.boundary_conditions[boundary];
    condition.boundary = boundary;
    condition.displacement.assign(dim, base::Expression("free"));
    condition.displacement[direction] = value;
  };
  constrain("south", 1, 0);
  constrain("north", 1, base::Expression("-1e-3*t"));
  for (const char* side : {"west", "east"}) constrain(side, 0, 0);
  if (!flat)
    for (const char* side : {"bottom", "top"}) constrain(side, 2, 0);
  return scene;
}

model::ModuleFactory grout(const std::string& local_group, Real bulk_modulus = K) {
  return [=](const mesh::Mesh& mesh) {
    std::vector<std::unique_ptr<assembly::Module>> modules;
    modules.push_back(hosts::make_grout(mesh, thickness, bulk_modulus, local_group));
    return modules;
  };
}

const std::vector<Discretisation> all = {{"quadrilateral", 1}, {"quadrilateral", 2}, {"triangle", 1},
                                         {"triangle", 2},      {"hexahedron", 1},    {"hexahedron", 2},
                                         {"tetrahedron", 1},   {"tetrahedron", 2}};

/// Calls visit with the grout in the local group of contact, and as a separate block.
template <class Visit>
void for_each_column(const std::vector<Discretisation>& some, const Visit& visit) {
  for (const auto& cells : some)
    for (const std::string group : {"fracture face", ""}) {
      SCOPED_TRACE(fmt::format("{}, local group \"{}\"", cells.name(), group));
      visit(column(cells), grout(group));
    }
}

std::string error_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Grout, JacobianIsTheDerivativeOfTheResidual) {
  for (const auto& cells : all) {
    SCOPED_TRACE(cells.name());
    model::Model model(column(cells), Tpetra::getDefaultComm(), grout(""));
    auto& system = model.system();
    system.set_time(1, 1);
    auto x = system.initial();
    for (std::size_t b = 0; b < x.size(); ++b) {
      x[b]->randomize(-1, 1);
      x[b]->scale(system.blocks()[b].kinematic_scale);
    }
    int n = 0;
    for (const auto& error : assembly::check_jacobian(system, x)) {
      if (error.module != "grout") continue;
      ++n;
      EXPECT_LT(error.error, 1e-8) << error.row << ", " << error.column;
    }
    EXPECT_EQ(n, 16);  // pairs of blocks
  }
}

/// Springs in series, d = p (1 m/E + h/K), until the sides touch; then only the rock deforms.
TEST(Grout, CarriesTheColumnThenTheWallsDo) {
  const std::vector<Discretisation> some = {{"quadrilateral", 1}, {"tetrahedron", 2}};
  for (const std::string solver : {"direct", "iterative"})
    for_each_column(solver == "direct" ? all : some, [&](model::Scene scene, const model::ModuleFactory& modules) {
      scene.solver.linear_solver.type = solver;
      scene.solver.linear_solver.preconditioner.blocks["displacement"].multigrid.emplace().coarsest =
          20;  // otherwise multigrid is a direct solver
      model::Model model(scene, Tpetra::getDefaultComm(), modules);
      for (Real t : {1, 3}) {
        const auto report = model.step_to(t);
        ASSERT_TRUE(report.converged) << report.reason;
        if (solver == "iterative") {
          EXPECT_GT(solve::iterations(report.linear_solves), report.newton_iterations);
        }
        const Real d = 1e-3 * t, full = squeeze * K / thickness, p = std::min(d / (1 / E + thickness / K), full);
        const Real contact = t == 3 ? (d - squeeze) * E - full : 0;
        const auto pressure = model.field("grout pressure").values;
        const auto traction = model.field("traction").values;
        const auto shown = model.output("grout pressure").values;
        const auto opening = model.output("opening").values;
        for (std::size_t f = 0; f < pressure.extent(0); ++f) {
          EXPECT_NEAR(pressure(f, 0), p, 1e-9 * p);
          EXPECT_EQ(shown[f], pressure(f, 0));
          EXPECT_NEAR(opening[f], -p * thickness / K, 1e-9 * squeeze);
          EXPECT_NEAR(traction(f, 0), -contact, 1e-9 * p);
        }
      }
    });
}

/// Checks y^T A_rs x = x^T A_sr y for all remaining blocks, as declared by the grout.
TEST(Grout, CondensedSystemIsSymmetric) {
  for_each_column(
      {{"triangle", 1}, {"hexahedron", 1}}, [](const model::Scene& scene, const model::ModuleFactory& modules) {
        model::Model model(scene, Tpetra::getDefaultComm(), modules);
        auto& system = model.system();
        for (Real t : {1, 3}) {
          ASSERT_TRUE(model.step_to(t).converged);
          system.jacobian(model.state());
          EXPECT_TRUE(system.symmetric());
          solve::LocalElimination elimination(system);
          ASSERT_EQ(elimination.update(system).failure, "");
          const auto& remaining = elimination.remaining();
          const int n = static_cast<int>(remaining.size());
          for (int r = 0; r < n; ++r)
            for (int s = 0; s < n; ++s) {
              const auto there = elimination.condensed(r, s), back = elimination.condensed(s, r);
              fields::Vector x(there->getDomainMap()), y(there->getRangeMap()), Ax(y.getMap()), Ay(x.getMap());
              x.randomize();
              y.randomize();
              there->apply(x, Ax);
              back->apply(y, Ay);
              const auto& A = system.matrix()(remaining[r], remaining[s]);  // null where its values are in `there`
              const Real norm = (A.is_null() ? *there->crs() : *A).getFrobeniusNorm();
              const Real size = norm * x.norm2() * y.norm2();
              EXPECT_NEAR(y.dot(Ax), x.dot(Ay), 1e-13 * size) << r << ", " << s;
            }
        }
      });
}

/// Errors of a scene have equal messages for a scene built in code and one read from a file.
TEST(SceneInCpp, IsCheckedLikeOneFromAFile) {
  const auto comm = Tpetra::getDefaultComm();
  const test::Scratch scratch(*comm);
  const std::string file = scratch / "scene.xml";
  const std::vector<std::pair<std::string, std::function<void(model::Scene&)>>> mistakes = {
      {"Did you mean \"rock\"", [](auto& s) { s.bulk.material = "rok"; }},
      {"must be", [](auto& s) { s.materials["rock"].nu = 0.7; }},
      {"exactly two are needed", [](auto& s) { s.materials["rock"].G = 1; }},
      {"must be one of", [](auto& s) { s.materials["walls"].friction = "Coloumb"; }},
      {"has no section here", [](auto& s) { s.fractures.clear(); }},
      {"has 1 value", [](auto& s) { s.boundary_conditions["north"].displacement.resize(1); }},
      {"times must increase", [](auto& s) { s.time.end = -1; }},
      {"unknown name",
       [](auto& s) { s.boundary_conditions["north"].displacement[1] = base::Expression("velocity*t"); }},
      {"not on t", [](auto& s) { s.materials["rock"].E = base::Expression("1e9*(1 + t)"); }},
      {"it may depend on the position, not on t",
       [](auto& s) { s.bulk.initial_stress.assign(4, base::Expression("-1e6*t")); }}};
  for (const auto& [words, make] : mistakes) {
    auto scene = column({"quadrilateral", 1});
    make(scene);
    const auto built = error_of([&] { model::Model model(scene, comm); });
    scratch.on_rank_0([&] { std::ofstream(file) << base::to_xml(base::effective(scene, "Sprekk")); });
    const auto read = error_of([&] { model::read_scene(*comm, file); });
    EXPECT_NE(built, "");
    const auto with_file = [&](std::string text) {
      for (std::size_t at = 0; (at = text.find("scene: ", at)) != text.npos; at += file.size())
        text.replace(at, 5, file);
      return text;
    };
    EXPECT_EQ(with_file(built), read);
    EXPECT_THAT(built, HasSubstr(words));
    comm->barrier();
  }
}

TEST(SceneInCpp, IsMadeReady) {
  auto scene = column({"quadrilateral", 1});
  scene.bulk.material = "gneiss";  // of the material library
  scene.tables["ramp"] = {{0, 1}, {0, -1e-3}};
  scene.boundary_conditions["north"].displacement[1] = base::Expression("ramp(t)");
  model::Model model(scene, Tpetra::getDefaultComm());
  ASSERT_TRUE(model.step_to(1).converged);
  EXPECT_THROW(model.step_to(1), Error);  // no time step
  EXPECT_EQ(model.scene().materials.count("gneiss"), 1u);
}

/// Unknowns written by a host are the initial guess; changes of history variables affect later steps.
TEST(Fields, AreReachedInPlace) {
  const auto comm = Tpetra::getDefaultComm();
  const auto scene = column({"quadrilateral", 2});
  model::Model touched(scene, comm), left(scene, comm);
  ASSERT_TRUE(touched.step_to(1).converged);
  ASSERT_TRUE(left.step_to(1).converged);
  const auto displacement = touched.field("displacement");
  EXPECT_EQ(displacement.field.n_components, 2);
  EXPECT_EQ(displacement.values.extent(0), static_cast<std::size_t>(touched.mesh().n_owned_nodes));
  Kokkos::deep_copy(displacement.values, 1e-4);
  if (displacement.values.extent(0) > 0) {
    EXPECT_EQ(touched.output("displacement").values[0], 1e-4);
  }
  ASSERT_TRUE(touched.step_to(2).converged);
  ASSERT_TRUE(left.step_to(2).converged);
  const auto a = touched.field("displacement").values, b = left.field("displacement").values;
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a.data()[i], b.data()[i], 1e-12);
  EXPECT_EQ(error_of([&] { touched.field("displacment"); }),
            "there is no field \"displacment\", but \"displacement\", \"side bubble\", \"traction\", \"elastic-plastic "
            "jump: plastic jump\", \"elastic-plastic jump: slid\". Did you mean \"displacement\"?");
  EXPECT_THAT(error_of([&] { touched.output("aperure"); }), HasSubstr("Did you mean \"aperture\"?"));
}

/// Module that counts the steps on every node.
class Counter : public assembly::Module, public assembly::Steps {
 public:
  explicit Counter(const std::string& of = "steps") : of_(of) {}
  std::string name() const override { return "counter"; }
  assembly::Declaration declare(const mesh::Mesh&) const override {
    assembly::Declaration d;
    d.history = {{of_, fields::Entity::node, 1}};
    return d;
  }
  void bind(const assembly::Context&) override {}
  void residual(const assembly::State&, const assembly::Rows&) const override {}
  void jacobian(const assembly::State&, fields::BlockMatrix&) const override {}
  void commit(assembly::State& state) const override {
    for (std::size_t n = 0; n < state.history[0].extent(0); ++n) state.history[0](n, 0) += 1;
  }

 private:
  std::string of_;
};

TEST(OwnModules, AreSavedAndRestored) {
  const auto comm = Tpetra::getDefaultComm();
  const auto modules = [](const mesh::Mesh& mesh) {
    auto list = grout("")(mesh);
    list.push_back(std::make_unique<Counter>());
    return list;
  };
  const auto values = [](model::Model& model, const std::string& name) {
    const auto v = model.field(name).values;
    return std::vector<Real>(v.data(), v.data() + v.size());
  };
  auto scene = column({"quadrilateral", 1});
  scene.solver.linear_solver.reproducible = true;
  model::Model model(scene, comm, modules);
  for (Real t : {0.5, 1.0}) ASSERT_TRUE(model.step_to(t).converged);
  const auto saved = model.save();
  const auto pressure = values(model, "grout pressure"), steps = values(model, "counter: steps");
  for (Real n : steps) EXPECT_EQ(n, 2);
  ASSERT_TRUE(model.step_to(2).converged);
  const auto later = values(model, "grout pressure");
  if (!later.empty()) {
    EXPECT_NE(later, pressure);
  }
  model::Model other(scene, comm, modules);
  for (auto* restored : {&model, &other}) {
    restored->restore(saved);
    EXPECT_EQ(values(*restored, "grout pressure"), pressure);
    EXPECT_EQ(values(*restored, "counter: steps"), steps);
    ASSERT_TRUE(restored->step_to(2).converged);
    EXPECT_EQ(values(*restored, "grout pressure"), later);
  }
  model::Model without(scene, comm), without_counter(scene, comm, grout("")), softer(scene, comm, grout("", K / 2));
  const auto refusal = [&](model::Model& refusing) { return error_of([&] { refusing.restore(saved); }); };
  EXPECT_THAT(refusal(without), HasSubstr("they differ in: module \"counter\", module \"grout\", unknowns;"));
  EXPECT_THAT(refusal(without_counter), HasSubstr("they differ in: module \"counter\", unknowns;"));
  const auto of_grout = without_counter.save();
  EXPECT_THAT(error_of([&] { softer.restore(of_grout); }), HasSubstr("they differ in: module \"grout\";"));
}

/// T + T^3/S^2 = 2 S at every node, with the solution T = S.
struct CubicNode {
  static constexpr int n = 4;
  using Columns = assembly::Slots<assembly::Slot<n, 1>>;
  using Rows = Columns;
  static constexpr auto loop = assembly::Loop::cells;
  static constexpr std::array fields = {"T"};

  View<Real**> S;  // [cell, node]

  KOKKOS_INLINE_FUNCTION void residual(int cell, const Real (&T)[n], Real (&r)[n]) const {
    for (int a = 0; a < n; ++a) r[a] = T[a] + T[a] * T[a] * T[a] / (S(cell, a) * S(cell, a)) - 2 * S(cell, a);
  }
  KOKKOS_INLINE_FUNCTION void jacobian(int cell, const Real (&T)[n], Real (&J)[n][n]) const {
    for (int a = 0; a < n; ++a)
      for (int b = 0; b < n; ++b) J[a][b] = a == b ? 1 + 3 * T[a] * T[a] / (S(cell, a) * S(cell, a)) : 0;
  }
};

TEST(OwnModules, MayBeNonlinearAndShowUnknownsOfNodes) {
  auto scene = column({"quadrilateral", 1});
  scene.mesh.periodic = {"x"};  // tied nodes without unknowns
  for (const char* side : {"west", "east"}) scene.boundary_conditions.erase(side);
  for (const char* end : {"south", "north"}) scene.boundary_conditions[end].displacement[0] = 0;
  const auto exact = [](const mesh::Mesh& mesh, LocalIndex node) {
    return 1e-3 * (1 + mesh.coordinates[2 * node + 1]);
  };
  const auto cubic = [&](const mesh::Mesh& mesh) {
    assembly::Description d{"cubic", ""};
    d.unknowns = {{{"T", fields::Entity::node, 1, "m"}, "displacement", {{"displacement"}}}};
    d.merit_weight = E;  // times m: the stiffness of the rock
    const View<Real**> S("S", mesh.n_cells(), 4);
    for (LocalIndex c = 0; c < mesh.n_cells(); ++c)
      for (int a = 0; a < 4; ++a) S(c, a) = exact(mesh, mesh.cells[c * 4 + a]);
    std::vector<std::unique_ptr<assembly::Module>> modules;
    modules.push_back(assembly::make_kernel_module(d, CubicNode{S}));
    return modules;
  };
  model::Model model(scene, Tpetra::getDefaultComm(), cubic);
  const auto report = model.step_to(1);
  ASSERT_TRUE(report.converged) << report.reason;
  const auto shown = model.output("T");
  EXPECT_EQ(shown.unit, "m");
  ASSERT_EQ(shown.values.size(), static_cast<std::size_t>(model.mesh().n_nodes()));
  for (LocalIndex n = 0; n < model.mesh().n_nodes(); ++n)
    EXPECT_NEAR(shown.values[n], exact(model.mesh(), n), 1e-9 * shown.values[n]);
  for (const auto& error : assembly::check_jacobian(model.system(), model.state()))
    if (error.module == "cubic") {
      EXPECT_LT(error.error, 1e-7) << error.row << ", " << error.column;
    }
}

TEST(OwnModules, MayHoldTheRock) {
  auto scene = column({"quadrilateral", 1});
  scene.boundary_conditions.clear();
  auto& pull = scene.boundary_conditions["pull"];
  pull.boundary = "north";
  pull.traction = {0, 1e6};
  EXPECT_THAT(error_of([&] { model::Model model(scene, Tpetra::getDefaultComm()); }), HasSubstr("nothing constrains"));
  scene.mesh.fractures.clear();
  scene.fractures.clear();
  const Real k = 1e9;
  const auto springs = [&](const mesh::Mesh& mesh) {
    std::vector<std::unique_ptr<assembly::Module>> modules;
    modules.push_back(physics::make_elastic_foundation(mesh, {2, {k, k, k}}));  // 2: south
    return modules;
  };
  model::Model model(scene, Tpetra::getDefaultComm(), springs);
  ASSERT_TRUE(model.step_to(1).converged);
  const auto u = model.field("displacement").values;
  for (std::size_t n = 0; n < u.extent(0); ++n) {
    EXPECT_NEAR(u(n, 0), 0, 1e-12);
    EXPECT_NEAR(u(n, 1), 1e6 / k + 1e6 / E * model.mesh().coordinates[2 * n + 1], 1e-12);
  }
}

TEST(OwnModules, MistakesAreErrorsOnEveryRank) {
  const auto comm = Tpetra::getDefaultComm();
  const auto scene = column({"quadrilateral", 1});
  const auto twice = [](const mesh::Mesh& mesh) {
    auto modules = grout("")(mesh);
    modules.push_back(std::move(grout("")(mesh).front()));
    return modules;
  };
  EXPECT_EQ(error_of([&] { model::Model model(scene, comm, twice); }),
            "modules declare the field \"grout pressure\" twice");
  const auto counters = [](const mesh::Mesh&) {
    std::vector<std::unique_ptr<assembly::Module>> modules;
    for (int i = 0; i < 2; ++i) modules.push_back(std::make_unique<Counter>());
    return modules;
  };
  EXPECT_EQ(error_of([&] { model::Model model(scene, comm, counters); }),
            "modules declare the history \"counter: steps\" twice");
  const auto ratio = [](const mesh::Mesh&) {
    std::vector<std::unique_ptr<assembly::Module>> modules;
    modules.push_back(std::make_unique<Counter>("steps/s"));
    return modules;
  };
  EXPECT_EQ(error_of([&] { model::Model model(scene, comm, ratio); }),
            "modules declare the history \"counter: steps/s\": a name must not be empty or contain \"/\"");
  const auto on_rank_0 = [](const mesh::Mesh& mesh) -> std::vector<std::unique_ptr<assembly::Module>> {
    if (mesh.comm->getRank() == 0) throw Error("the host's file is missing");
    return {};
  };
  EXPECT_EQ(error_of([&] { model::Model model(scene, comm, on_rank_0); }), "the host's file is missing");
}

}  // namespace
}  // namespace sprekk::tests
