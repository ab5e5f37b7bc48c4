// Transfer of a state to a bisected mesh: exact functions, amounts, histories, and the steps that follow.
#include "base/over_ranks.hpp"
#include "mesh/facets.hpp"
#include "verification/scenes.hpp"

namespace sprekk::tests {
namespace {

using mesh::Vector;

/// Returns a scene whose model can be refined.
model::Scene bisected_scene(const std::string& name, const std::vector<std::string>& overrides = {}) {
  auto scene = read_scene(name, overrides);
  scene.bisection = std::make_shared<std::optional<mesh::Bisection>>();
  return scene;
}

Vector point(const mesh::Mesh& mesh, LocalIndex node) {
  Vector x{};
  std::copy_n(&mesh.coordinates[node * mesh.dim()], mesh.dim(), x.begin());
  return x;
}

/// Bisects the cells in the lower part of the domain, 0.6 of its length in each direction. Collective.
void refine(model::Model& model) {
  const auto& mesh = model.mesh();
  Vector lowest{1e30, 1e30, 1e30}, highest{-1e30, -1e30, -1e30};
  for (LocalIndex node = 0; node < mesh.n_nodes(); ++node)
    for (int i = 0; i < 3; ++i) {
      lowest[i] = std::min(lowest[i], point(mesh, node)[i]);
      highest[i] = std::max(highest[i], point(mesh, node)[i]);
    }
  lowest = base::min_over_ranks(*mesh.comm, lowest);
  highest = base::max_over_ranks(*mesh.comm, highest);
  std::vector<GlobalIndex> cells;
  for (LocalIndex c = 0; c < mesh.n_owned_cells; ++c) {
    const auto x = mesh::cell_centre(mesh, c);
    bool inside = true;
    for (int i = 0; i < mesh.dim(); ++i) inside = inside && x[i] < lowest[i] + 0.6 * (highest[i] - lowest[i]);
    if (inside) cells.push_back(mesh.cell_id[c]);
  }
  const auto before = mesh.n_global_cells;
  model.refine(base::gather_over_ranks(*mesh.comm, cells));
  ASSERT_GT(model.mesh().n_global_cells, before);
}

using Table = std::vector<std::vector<Real>>;  ///< [local entity][component]

Table values_of(model::Model& model, const std::string& field) {
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), model.field(field).values);
  Table values(host.extent(0), std::vector<Real>(host.extent(1)));
  for (std::size_t e = 0; e < values.size(); ++e)
    for (std::size_t k = 0; k < values[e].size(); ++k) values[e][k] = host(e, k);
  return values;
}

template <class Value>
void set(model::Model& model, const std::string& field, const Value& value) {
  const auto view = model.field(field).values;
  const auto host = Kokkos::create_mirror_view(view);
  for (std::size_t e = 0; e < host.extent(0); ++e)
    for (std::size_t k = 0; k < host.extent(1); ++k)
      host(e, k) = value(static_cast<LocalIndex>(e), static_cast<int>(k));
  Kokkos::deep_copy(view, host);
}

/// Block with a fracture through it at half of its height, or with one that ends inside.
model::Scene block(const std::string& cell, int order, bool ends = false) {
  const bool flat = cell == "triangle";
  std::vector<std::string> overrides = {"Mesh.cell=" + cell, fmt::format("Mesh.order={}", order)};
  overrides.push_back(flat ? "Mesh.cells={4, 4}" : "Mesh.cells={2, 2, 2}");
  if (ends)
    overrides.push_back("Mesh.fractures.fracture.upper corner=" + std::string(flat ? "{0.5, 0.5}" : "{0.5, 1, 0.5}"));
  return bisected_scene(flat ? "verification/cyclic_2d.xml" : "verification/cyclic_3d.xml", overrides);
}

using Cell = std::pair<std::string, int>;  ///< name, order

class RefinedCells : public ::testing::TestWithParam<Cell> {
 protected:
  /// Sets a linear displacement, on the upper side of the fracture another one if `jumps`, and compares it after two
  /// refinements. The values are below 0.02 m.
  void expect_exact(model::Model& model, bool jumps) const {
    const int height = model.mesh().dim() - 1;
    const auto exact = [&] {
      const auto& mesh = model.mesh();
      const int n = mesh.nodes_per_cell();
      std::vector<char> above(mesh.n_nodes());
      for (LocalIndex c = 0; c < mesh.n_cells(); ++c)
        for (int k = 0; k < n; ++k) above[mesh.cells[c * n + k]] = jumps && mesh::cell_centre(mesh, c)[height] > 0.5;
      return [&mesh, above](LocalIndex node, int i) {
        const auto x = point(mesh, node);
        return 1e-3 * ((i + 1) * (1 + x[0] - 2 * x[1] + 3 * x[2]) + above[node] * (2 + x[0] + i * x[1]));
      };
    };
    set(model, "displacement", exact());
    for (int pass = 0; pass < 2; ++pass) refine(model);
    const auto u = values_of(model, "displacement");
    const auto expected = exact();
    for (std::size_t node = 0; node < u.size(); ++node)
      for (std::size_t i = 0; i < u[node].size(); ++i)
        ASSERT_NEAR(u[node][i], expected(static_cast<LocalIndex>(node), static_cast<int>(i)), 1e-15);
  }
};

TEST_P(RefinedCells, KeepLinearFunctionsAndTheirJump) {
  model::Model model(block(GetParam().first, GetParam().second), Tpetra::getDefaultComm());
  expect_exact(model, true);
}

/// Cells of order 2 at the tip are curved.
TEST_P(RefinedCells, KeepLinearFunctionsAtTips) {
  model::Model model(block(GetParam().first, GetParam().second, true), Tpetra::getDefaultComm());
  expect_exact(model, false);
}

INSTANTIATE_TEST_SUITE_P(All, RefinedCells,
                         ::testing::Values(Cell{"triangle", 1}, Cell{"triangle", 2}, Cell{"tetrahedron", 1},
                                           Cell{"tetrahedron", 2}),
                         [](const auto& one) { return fmt::format("{}{}", one.param.first, one.param.second); });

/// A fracture that grows: nodes have moved out of their parents, also those of a turned extension.
TEST(Refinement, KeepsLinearFunctionsAroundGrowingTips) {
  for (const int order : {1, 2}) {
    model::Model model(block("triangle", order, true), Tpetra::getDefaultComm());
    const auto exact = [](const Vector& x, int i) { return 1e-3 * ((i + 1) * (1 + x[0] - 2 * x[1])); };
    set(model, "displacement", [&](LocalIndex node, int i) { return exact(point(model.mesh(), node), i); });
    const Real c = std::cos(0.6), s = std::sin(0.6);
    const mesh::Extension extension{{0.5, 0.5}, {c, s}, 0.2, 0.08};
    const auto made = model.change_mesh({{}, {extension}, {{{0.5, 0.5}, {0.5 + 0.2 * c, 0.5 + 0.2 * s}, 0.15}}});
    ASSERT_EQ(made.size(), 2u);
    for (const auto& one : made) EXPECT_EQ(one, mesh::Extended::tip);
    const auto u = values_of(model, "displacement");
    const auto& mesh = model.mesh();
    Real length = 0;
    for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) length += mesh.fracture_faces[f].area;
    EXPECT_NEAR(base::sum_over_ranks(*mesh.comm, length), 0.7, 1e-12);
    for (std::size_t node = 0; node < u.size(); ++node)
      for (int i = 0; i < 2; ++i)
        ASSERT_NEAR(u[node][i], exact(point(mesh, static_cast<LocalIndex>(node)), i), 1e-14) << order;
    const auto moved = model.save();
    model::Model other(block("triangle", order, true), Tpetra::getDefaultComm());
    other.restore(moved);
    EXPECT_EQ(values_of(other, "displacement"), u);
  }
}

/// With u = 0 at the old nodes and the enrichment q, the function is (rho^(1/2) - rho) q. At a new node the enrichment
/// is rho^(1/2) q, with rho = 1/2 at the middle of an edge at the tip, 1 on the opposite side of the old cell, and 3/4
/// between them.
TEST(Refinement, KeepsTheSquareRootAtTips) {
  for (const std::string cell : {"triangle", "tetrahedron"}) {
    model::Model model(block(cell, 1, true), Tpetra::getDefaultComm());
    set(model, "tip displacement", [](LocalIndex, int i) { return 1e-3 * (i + 1); });
    refine(model);
    const auto& mesh = model.mesh();
    const auto u = values_of(model, "displacement"), q = values_of(model, "tip displacement");
    int n_middle = 0;
    for (LocalIndex node = 0; node < mesh.n_owned_nodes; ++node) {
      const LocalIndex e = mesh.enriched[node];
      if (e < 0) continue;
      const Real root = q[e][0] / 1e-3;
      EXPECT_TRUE(std::abs(root - 1) < 1e-12 || std::abs(root - std::sqrt(0.5)) < 1e-12 ||
                  std::abs(root - std::sqrt(0.75)) < 1e-12)
          << root;
      n_middle += root < 0.9;
      for (int i = 0; i < mesh.dim(); ++i) {
        EXPECT_NEAR(q[e][i], root * 1e-3 * (i + 1), 1e-16);
        EXPECT_NEAR(u[node][i], (root - root * root) * 1e-3 * (i + 1), 1e-16);
      }
    }
    EXPECT_GT(base::sum_over_ranks(*mesh.comm, n_middle), 0);
  }
}

/// Flow, heat and contact in deformable rock with fractures and wells; in 3D with two fractures that cross.
model::Scene doublet(bool flat, const std::vector<std::string>& more = {}) {
  std::vector<std::string> overrides = {flat ? "Mesh.cells={20, 20}" : "Mesh.cells={10, 10, 10}", "Time.scheme=BDF2"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  if (flat) return bisected_scene("thm/doublet_2d.xml", overrides);
  auto scene = bisected_scene("thm/doublet_3d.xml", overrides);
  scene.mesh.cells = {4, 4, 4};
  std::erase_if(scene.mesh.fractures, [](const auto& one) { return one.first != "injected" && one.first != "middle"; });
  std::erase_if(scene.fractures, [&](const auto& one) { return scene.mesh.fractures.count(one.first) == 0; });
  scene.mesh.fractures["injected"].lower_corner = {50, 50, 100};
  scene.mesh.fractures["injected"].upper_corner = {150, 150, 100};
  scene.mesh.fractures["middle"].lower_corner = {100, 50, 50};
  scene.mesh.fractures["middle"].upper_corner = {100, 150, 150};
  return scene;
}

/// Sum and sum of magnitudes, by name.
using Sums = std::map<std::string, std::array<Real, 2>>;

/// Returns the stored masses and energies since the start, from the storage terms of a step back to the initial state,
/// and the amounts in histories. Collective.
Sums stored(model::Model& model) {
  constexpr Real dt = 1e6;
  auto& system = model.system();
  const auto start = system.initial();
  auto r = fields::create_like(start);
  system.set_time(model.time() + dt, dt);
  Sums sums;
  const auto add = [&](const std::string& name, Real value) {
    sums[name][0] += value;
    sums[name][1] += std::abs(value);
  };
  for (std::size_t m = 0; m < system.modules().size(); ++m) {
    if (!system.modules()[m].declaration.stores) continue;
    system.module_residual(static_cast<int>(m), start, r);
    for (std::size_t b = 0; b < r.size(); ++b) {
      if (!system.blocks()[b].balance) continue;
      const auto rows = r[b]->getLocalViewHost(Tpetra::Access::ReadOnly);
      add(system.layouts()[b].field().name, 0);
      for (std::size_t k = 0; k < rows.extent(0); ++k) add(system.layouts()[b].field().name, dt * rows(k, 0));
    }
  }
  for (const auto& [field, values] : system.histories(false)) {
    if (!field.is_amount) continue;
    const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), values);
    add(field.name, 0);
    for (std::size_t e = 0; e < host.extent(0); ++e) add(field.name, host(e, 0));
  }
  for (auto& [name, sum] : sums) sum = base::sum_over_ranks(*system.comm(), sum);
  return sums;
}

TEST(Refinement, KeepsStoredMassAndEnergy) {
  for (const bool flat : {true, false}) {
    model::Model model(doublet(flat), Tpetra::getDefaultComm());
    for (const Real t : {1e6, 3e6}) ASSERT_TRUE(model.step_to(t).converged);
    const auto before = stored(model);
    refine(model);
    const auto after = stored(model);
    ASSERT_EQ(before.size(), after.size());
    for (const char* name : {"pressure", "face pressure", "temperature", "gain of pressure", "gain of temperature"})
      EXPECT_GT(before.at(name)[1], 0) << name;
    for (const auto& [name, sum] : before) EXPECT_NEAR(after.at(name)[0], sum[0], 1e-10 * sum[1]) << name << flat;
    ASSERT_TRUE(model.step_to(5e6).converged);
  }
}

/// Porous rock with a fracture that ends inside, and its growth by an extension that is turned.
struct PorousGrowth {
  static model::Scene scene(Real compressibility) {
    return bisected_scene("growth/edge_crack_2d.xml",
                          {"Mesh.cells={10, 20}", "Materials.rock.permeability={1e-15}", "Materials.rock.porosity=0.1",
                           "Materials.rock.compressibility of pores=2e-11", "Materials.rock.Biot coefficient=0.8",
                           "Materials.joint.residual aperture=1e-5", "Flow.viscosity=1e-3", "Flow.initial pressure=1e5",
                           fmt::format("Flow.compressibility={}", compressibility)});
  }
  static mesh::MeshChange change() {
    const Real c = std::cos(0.6), s = std::sin(0.6);
    return {{}, {{{0.6, 0}, {c, s}, 0.3, 0.12}}, {{{0.6, 0}, {0.6 + 0.3 * c, 0.3 * s}, 0.15}}};
  }
};

/// Nodes that move take no fluid from the rock.
TEST(Refinement, KeepsTheFluidInRockAroundGrowingTips) {
  auto scene = PorousGrowth::scene(1e-8);
  auto& source = scene.fractures.at("crack").source;
  source = base::Expression("x < 0.6 ? 1e-6*(1 + x) : 0");
  source.compile();
  model::Model model(scene, Tpetra::getDefaultComm());
  for (const Real t : {5, 10}) ASSERT_TRUE(model.step_to(t).converged);
  const auto fluid = [&] {
    const auto all = stored(model);
    const auto &cells = all.at("pressure"), &facets = all.at("face pressure");
    return std::array{cells[0] + facets[0], cells[1]};
  };
  const auto before = fluid();
  EXPECT_NEAR(before[0], -10e-6 * (0.6 + 0.18), 1e-12 * before[1]);  // from the present state back to the start
  model.change_mesh(PorousGrowth::change());
  EXPECT_NEAR(fluid()[0], before[0], 1e-12 * before[1]);
  ASSERT_TRUE(model.step_to(15).converged);
  EXPECT_NEAR(fluid()[0], 1.5 * before[0], 1e-10 * before[1]);
}

/// Nor do they take heat from the rock.
TEST(Refinement, KeepsTheHeatInRockAroundGrowingTips) {
  const std::string rock = "Materials.rock.";
  model::Model model(
      bisected_scene("growth/edge_crack_2d.xml",
                     {"Mesh.cells={10, 20}", rock + "thermal conductivity={3}", rock + "thermal expansion=1e-5",
                      rock + "volumetric heat capacity=2e6", "Heat.initial temperature=300"}),
      Tpetra::getDefaultComm());
  ASSERT_TRUE(model.step_to(1).converged);
  const char* const gained = "heat storage: gained temperature";
  set(model, gained, [&](LocalIndex c, int) { return std::sin(20 * mesh::cell_centre(model.mesh(), c)[0]); });
  const auto before = stored(model).at("temperature");
  model.change_mesh(PorousGrowth::change());
  EXPECT_GT(before[1], 1e5);
  EXPECT_NEAR(stored(model).at("temperature")[0], before[0], 1e-12 * before[1]);
}

/// Pressures that are linear in the rock remain so.
TEST(Refinement, KeepsLinearPressuresAroundGrowingTips) {
  model::Model model(PorousGrowth::scene(0), Tpetra::getDefaultComm());
  const auto at = [](const Vector& x) { return 1e6 * (1 + x[0] - 2 * x[1]); };
  const auto in_cells = [&](LocalIndex c, int) { return at(mesh::cell_centre(model.mesh(), c)); };
  set(model, "pressure", in_cells);
  set(model, "fluid storage: gained pressure", in_cells);
  const auto before = model.mesh().n_global_cells;
  model.change_mesh(PorousGrowth::change());
  ASSERT_GT(model.mesh().n_global_cells, before);
  for (const char* name : {"pressure", "fluid storage: gained pressure"}) {
    const auto p = values_of(model, name);
    Real largest = 0;
    for (std::size_t c = 0; c < p.size(); ++c)
      largest = std::max(largest, std::abs(p[c][0] - in_cells(static_cast<LocalIndex>(c), 0)));
    EXPECT_LT(largest, 1e-6) << name;
  }
}

/// Histories of new faces are those of old faces; their integrals remain, and those of tractions.
TEST(Refinement, KeepsHistoriesOfFaces) {
  for (const bool flat : {true, false}) {
    const std::string joint = "Materials.rough joint.";
    model::Model model(doublet(flat, {joint + "damage=isotropic", joint + "damage length of friction=0.02",
                                      joint + "residual part of friction=0.5", joint + "friction coefficient=0.25"}),
                       Tpetra::getDefaultComm());
    for (const Real t : {1e6, 3e6}) ASSERT_TRUE(model.step_to(t).converged);
    std::vector<std::string> names = {"traction", "side bubble"};
    for (const auto& [field, values] : model.system().histories())
      if (field.name.rfind("elastic-plastic jump: ", 0) == 0) names.push_back(field.name);
    ASSERT_GE(names.size(), 5);
    const auto summary = [&](const std::string& name) {
      const auto& mesh = model.mesh();
      std::vector<Real> all;
      std::array<Real, 2> integral{};
      const auto values = values_of(model, name);
      for (std::size_t f = 0; f < values.size(); ++f) {
        all.insert(all.end(), values[f].begin(), values[f].end());
        integral[0] += mesh.fracture_faces[f].area * values[f].back();
        integral[1] += mesh.fracture_faces[f].area * std::abs(values[f].back());
      }
      all = base::gather_over_ranks(*mesh.comm, all);
      std::sort(all.begin(), all.end());
      all.erase(std::unique(all.begin(), all.end()), all.end());
      return std::pair(all, base::sum_over_ranks(*mesh.comm, integral));
    };
    std::map<std::string, std::pair<std::vector<Real>, std::array<Real, 2>>> before;
    for (const auto& name : names) before[name] = summary(name);
    refine(model);
    for (const auto& name : names) {
      const auto [values, integral] = summary(name);
      EXPECT_NEAR(integral[0], before[name].second[0], 1e-12 * integral[1]) << name;
      if (name != "traction") {  // the initial traction is rounded
        EXPECT_EQ(values, before[name].first) << name;
      }
    }
    EXPECT_GT(before["elastic-plastic jump: plastic jump"].second[1], 0);
  }
}

/// Returns the largest difference of an unknown between two models of equal meshes, relative to its largest value.
Real difference(model::Model& a, model::Model& b, const std::string& field) {
  const auto x = values_of(a, field), y = values_of(b, field);
  std::vector<Real> largest(2, 0);
  for (std::size_t e = 0; e < x.size(); ++e)
    for (std::size_t k = 0; k < x[e].size(); ++k) {
      largest[0] = std::max(largest[0], std::abs(x[e][k] - y[e][k]));
      largest[1] = std::max(largest[1], std::abs(x[e][k]));
    }
  largest = base::max_over_ranks(*a.mesh().comm, largest);
  return largest[1] > 0 ? largest[0] / largest[1] : largest[0];
}

std::vector<std::string> unknowns(const model::Model& model) {
  std::vector<std::string> names;
  for (const auto& layout : model.system().layouts()) names.push_back(layout.field().name);
  return names;
}

/// A refined initial state is the initial state of the refined mesh, also for stress and pressure that vary with depth.
TEST(Refinement, OfTheInitialStateIsExact) {
  for (const bool flat : {true, false}) {
    auto scene = doublet(flat, {"Flow.initial pressure=1e7 - 1e4*y", "Heat.initial temperature=420 - 0.03*y"});
    model::Model model(scene, Tpetra::getDefaultComm());
    refine(model);
    model::Model fresh(scene, Tpetra::getDefaultComm());
    ASSERT_EQ(model.mesh().n_global_cells, fresh.mesh().n_global_cells);
    for (const auto& name : unknowns(model)) EXPECT_LT(difference(model, fresh, name), 1e-12) << name;
    for (auto* one : {&model, &fresh}) ASSERT_TRUE(one->step_to(1e6).converged);
    for (const auto& name : unknowns(model)) EXPECT_LT(difference(model, fresh, name), 1e-6) << name;
  }
}

/// Linear solves are reproducible, as in runs with checkpoints.
TEST(Refinement, IsPartOfCheckpoints) {
  const auto scene = [] { return doublet(true, {"Solver.Linear solver.reproducible=true"}); };
  model::Model model(scene(), Tpetra::getDefaultComm());
  ASSERT_TRUE(model.step_to(1e6).converged);
  refine(model);
  ASSERT_TRUE(model.step_to(2e6).converged);
  refine(model);
  const auto checkpoint = model.save();
  model::Model other(scene(), Tpetra::getDefaultComm());
  other.restore(checkpoint);
  ASSERT_EQ(other.mesh().n_global_cells, model.mesh().n_global_cells);
  for (auto* one : {&model, &other}) ASSERT_TRUE(one->step_to(3e6).converged);
  for (const auto& name : unknowns(model)) EXPECT_LT(difference(model, other, name), 1e-12) << name;
}

}  // namespace
}  // namespace sprekk::tests
