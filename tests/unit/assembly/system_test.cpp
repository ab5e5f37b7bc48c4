#include "assembly/system.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <limits>

#include "unit/assembly/fake_modules.hpp"

namespace sprekk::assembly {
namespace {

using fields::BlockVector;
using fields::create_like;
using test::constrain;
using test::Dense;
using test::make_system;

constexpr Shape shape = Shape::triangle;
using Springs = test::Springs<shape>;
using Glue = test::Glue<shape>;
using Hardening = test::Hardening<shape>;

RCP<const mesh::Mesh> make_mesh() {
  return mesh::make_distributed(mesh::make_box(mesh::testing::crossed("triangle")), Tpetra::getDefaultComm());
}

/// Returns the mesh of make_mesh() with all cells on the last rank.
RCP<const mesh::Mesh> make_lopsided_mesh() {
  const auto comm = Tpetra::getDefaultComm();
  const auto global = mesh::make_box(mesh::testing::crossed("triangle"));
  return mesh::distribute(global, std::vector<int>(global.n_cells(), comm->getSize() - 1), comm);
}

std::unique_ptr<Springs> springs(Real force = 0, Real power = 0) {
  auto module = std::make_unique<Springs>();
  module->force = force;
  module->power = power;
  return module;
}

/// Springs with a force in direction x on every node, glue, and hardening: linear and nonlinear modules in one block.
test::Modules all_modules(Real force = 0, Real power = 0) {
  test::Modules modules;
  modules.push_back(springs(force, power));
  modules.push_back(std::make_unique<Glue>());
  modules.push_back(std::make_unique<Hardening>());
  return modules;
}

test::Modules only(std::unique_ptr<Module> module) {
  test::Modules modules;
  modules.push_back(std::move(module));
  return modules;
}

void expect_equal(const BlockVector& a, const BlockVector& b, Real tolerance = 1e-12) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    auto difference = rcp(new fields::Vector(*a[i], Teuchos::Copy));
    difference->update(-1, *b[i], 1);
    EXPECT_LE(difference->normInf(), tolerance) << "block " << i;
  }
}

TEST(System, RawResidualIsTheSumOfTheModulesResiduals) {
  for (const auto& mesh : {make_mesh(), make_lopsided_mesh()})
    for (Real power : {0.0, 2.0}) {
      auto system = make_system(mesh, all_modules(0.75, power));
      auto x = system->initial(), r = create_like(x), part = create_like(x), sum = create_like(x);
      for (Real t : {1.0, 3.0}) {
        system->set_time(t, 1);
        test::randomize(x, 0.8, static_cast<int>(t));
        system->raw_residual(x, r);
        for (const auto& v : sum) v->putScalar(0);
        for (int m = 0; m < 3; ++m) {
          system->module_residual(m, x, part);
          for (std::size_t b = 0; b < x.size(); ++b) sum[b]->update(1, *part[b], 1);
        }
        expect_equal(r, sum);
        EXPECT_GT(r[0]->normInf(), 1);
        system->raw_residual(x, part);  // no dependence on the previous content of r
        expect_equal(r, part, 0);
      }
    }
}

TEST(System, LoadsOfTheLinearPartFollowTime) {
  auto system = make_system(make_mesh(), only(springs(2, 3)));
  auto x = system->initial(), r = create_like(x);
  for (Real t : {1.0, 2.0, 0.5}) {
    system->set_time(t, 0.1);
    system->raw_residual(x, r);
    EXPECT_NEAR(r[0]->normInf(), 2 * t * t * t, 1e-13);
  }
}

TEST(System, JacobianIsTheSumOfTheModulesJacobiansAtTheLastPoint) {
  auto system = make_system(make_mesh(), all_modules());
  system->set_time(1, 1);
  auto x = system->initial();
  for (int seed : {1, 2}) {
    test::randomize(x, 0.8, seed);
    system->jacobian(x);
    auto part = system->create_matrix();
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) {
        ASSERT_EQ(system->matrix()(i, j).is_null(), i == 0 && j == 1);  // springs do not depend on the glue
        ASSERT_EQ(part(i, j).is_null(), i == 0 && j == 1);
        if (part(i, j).is_null()) continue;
        Dense total = test::gather(*system->matrix()(i, j));
        EXPECT_GT(test::largest(total), 0.5);
        for (int m = 0; m < 3; ++m) {
          system->module_jacobian(m, x, part);
          total = total - test::gather(*part(i, j));
        }
        EXPECT_LE(test::largest(total), 1e-12) << "block " << i << ", " << j;
      }
  }
}

TEST(System, LinearBlocksAreAssembledOnce) {
  test::Modules modules = all_modules();
  modules.pop_back();  // without hardening, the displacement block is linear
  auto system = make_system(make_mesh(), std::move(modules));
  system->set_time(1, 1);
  auto x = system->initial();
  system->jacobian(x);
  const auto block = system->matrix()(0, 0);
  const Dense before = test::gather(*block);
  test::randomize(x, 1, 3);
  system->jacobian(x);
  EXPECT_EQ(system->matrix()(0, 0), block);
  EXPECT_EQ(test::gather(*block).values, before.values);
}

TEST(System, ExchangesOnlyWhatModulesReadFromOthers) {
  const auto mesh = make_mesh();
  const int here = mesh->n_nodes() > mesh->n_owned_nodes;
  int anywhere = 0;
  Teuchos::reduceAll(*mesh->comm, Teuchos::REDUCE_MAX, 1, &here, &anywhere);
  EXPECT_EQ(make_system(mesh, only(springs()))->exchanged(0), anywhere == 1);
  const auto all = make_system(mesh, all_modules());
  EXPECT_EQ(all->exchanged(0), anywhere == 1);
  EXPECT_FALSE(all->exchanged(1));
  EXPECT_FALSE(make_system(make_lopsided_mesh(), all_modules())->exchanged(0));
}

TEST(System, BlocksAndGroupsFollowTheDeclarations) {
  const auto mesh = make_mesh();
  const auto system = make_system(mesh, all_modules());
  ASSERT_EQ(system->blocks().size(), 2u);
  const auto &u = system->blocks()[0], &q = system->blocks()[1];
  EXPECT_EQ(u.name, "displacement");
  EXPECT_EQ(u.n_components, 2);
  EXPECT_EQ(u.near_null_space.make()->getNumVectors(), 3u);
  EXPECT_EQ(u.coordinates->getNumVectors(), 2u);
  EXPECT_EQ(q.name, "glue");
  EXPECT_TRUE(q.near_null_space.make().is_null());
  EXPECT_EQ(static_cast<GlobalIndex>(q.map->getGlobalNumElements()), 2 * mesh->n_global_fracture_faces);
  ASSERT_EQ(system->local_groups().size(), 1u);
  EXPECT_EQ(system->local_groups()[0].name, "face");
  EXPECT_EQ(system->local_groups()[0].blocks, std::vector<int>{1});
}

TEST(System, UnknownFieldsAreNamed) {
  test::Modules modules;
  modules.push_back(std::make_unique<Glue>());
  EXPECT_THAT(mesh::testing::error_of([&] { make_system(make_mesh(), std::move(modules)); }),
              ::testing::HasSubstr("\"displacement\""));
}

TEST(System, ConstrainedRowsAreTheDistanceToTheValue) {
  const auto mesh = make_mesh();
  auto system =
      make_system(mesh, all_modules(0.75), {constrain(*mesh, "wall", "west", {base::Expression(0.25), std::nullopt})});
  system->set_time(1, 1);
  auto x = system->initial(), r = create_like(x), raw = create_like(x);
  test::randomize(x, 1, 5);
  system->residual(x, r);
  system->raw_residual(x, raw);
  const auto constrained = system->constrained(0);
  ASSERT_EQ(static_cast<LocalIndex>(constrained.extent(0)), mesh->n_owned_nodes * 2);
  for (LocalIndex i = 0; i < mesh->n_owned_nodes * 2; ++i) {
    EXPECT_EQ(constrained(i), i % 2 == 0 && mesh->coordinates[i] == 0);
    EXPECT_EQ(r[0]->getData()[i], constrained(i) ? x[0]->getData()[i] - 0.25 : raw[0]->getData()[i]);
  }
  auto difference = rcp(new fields::Vector(*r[1], Teuchos::Copy));
  difference->update(-1, *raw[1], 1);
  EXPECT_EQ(difference->normInf(), 0);
}

TEST(System, ScalesFollowTheLoadsAndNeverShrink) {
  const auto mesh = make_mesh();
  base::Expression pulled("-0.5*t");
  pulled.compile();
  auto system = make_system(mesh, all_modules(3, 1), {constrain(*mesh, "wall", "west", {pulled, base::Expression(0)})});
  system->set_time(1, 1);
  EXPECT_DOUBLE_EQ(system->scales().at("stress"), 25);  // E u/L exceeds the load 3
  EXPECT_DOUBLE_EQ(system->scales().at("displacement"), 0.5);
  EXPECT_DOUBLE_EQ(system->blocks()[0].kinematic_scale, 0.5);
  const Real face = std::sqrt(24.0 / 48);  // face of a cell of average size
  EXPECT_NEAR(system->blocks()[0].residual_scale, 25 * face, 1e-12);
  EXPECT_DOUBLE_EQ(system->blocks()[1].kinematic_scale, 25);
  system->set_time(0.1, 1);
  EXPECT_DOUBLE_EQ(system->scales().at("stress"), 25);
  auto pulled_only = make_system(mesh, all_modules(3, 1));
  pulled_only->set_time(2, 1);
  EXPECT_DOUBLE_EQ(pulled_only->scales().at("stress"), 6);
  EXPECT_DOUBLE_EQ(pulled_only->scales().at("displacement"), 6 * 2 / 100.0);
}

TEST(System, MeasuresAreRelativeToTheScales) {
  const auto mesh = make_mesh();
  auto system = make_system(mesh, all_modules(3),
                            {constrain(*mesh, "wall", "west", {base::Expression(0.5), base::Expression(0.5)})});
  system->set_time(1, 1);
  auto x = system->initial(), r = create_like(x);
  x[1]->putScalar(-50);
  auto set = [&](int block, GlobalIndex unknown, Real value) { r[block]->replaceGlobalValue(unknown, value); };
  if (r[0]->getMap()->isNodeGlobalElement(0)) set(0, 0, 0.75);  // node 0 lies on the west side
  if (r[1]->getMap()->isNodeGlobalElement(3)) set(1, 3, -5);
  auto measures = system->measures(x, r);
  ASSERT_EQ(measures.size(), 3u);
  EXPECT_EQ(measures[0].name, "displacement");
  EXPECT_NEAR(measures[0].value, 0.75 / 0.5, 1e-14);
  EXPECT_NEAR(measures[1].value, 5 / system->scales().at("stress"), 1e-14);
  EXPECT_EQ(measures[2].name, "largest glue");
  EXPECT_NEAR(measures[2].value, 50 / system->scales().at("stress"), 1e-14);
  for (GlobalIndex first : {2, 3}) {  // a NaN gives no small measure, in any position
    r[1]->putScalar(0);
    if (r[1]->getMap()->isNodeGlobalElement(first)) set(1, first, std::numeric_limits<Real>::quiet_NaN());
    EXPECT_FALSE(system->measures(x, r)[1].value < 1e300) << first;
  }
}

TEST(System, MeritIsAnEnergyOfTheFreeRows) {
  const auto mesh = make_mesh();
  auto system = make_system(mesh, only(springs()),
                            {constrain(*mesh, "wall", "west", {base::Expression(0), base::Expression(0)})});
  system->set_time(1, 1);
  auto x = system->initial(), r = create_like(x);
  test::randomize(r, 1, 9);
  system->jacobian(x);
  const Dense A = test::gather(*system->matrix()(0, 0)), row = test::gather(*r[0]);
  fields::Vector mask(r[0]->getMap());
  for (LocalIndex i = 0; i < static_cast<LocalIndex>(mask.getLocalLength()); ++i)
    mask.replaceLocalValue(i, system->constrained(0)(i));
  const Dense constrained = test::gather(mask);
  Real energy = 0;
  for (int i = 0; i < A.n_rows; ++i)
    if (constrained(i, 0) == 0) energy += row(i, 0) * row(i, 0) / A(i, i);
  EXPECT_NEAR(system->merit(x, r), energy, 1e-12 * energy);
}

TEST(System, ReactionsBalanceTheLoads) {
  const auto mesh = make_mesh();
  auto system = make_system(mesh, only(springs(0.75)),
                            {constrain(*mesh, "wall", "west", {base::Expression(0), base::Expression(0)}),
                             constrain(*mesh, "floor", "south", {std::nullopt, base::Expression(0)})});
  system->set_time(1, 1);
  auto x = system->initial(), r = create_like(x);
  system->residual(x, r);
  system->jacobian(x);
  Dense A = test::gather(*system->matrix()(0, 0));
  fields::Vector mask(x[0]->getMap());
  for (LocalIndex i = 0; i < static_cast<LocalIndex>(mask.getLocalLength()); ++i)
    mask.replaceLocalValue(i, system->constrained(0)(i));
  const Dense constrained = test::gather(mask);
  for (int i = 0; i < A.n_rows; ++i)
    for (int j = 0; constrained(i, 0) && j < A.n_columns; ++j) A(i, j) = i == j;
  const Dense step = test::solve(A, test::gather(*r[0]));
  for (LocalIndex i = 0; i < static_cast<LocalIndex>(x[0]->getLocalLength()); ++i)
    x[0]->replaceLocalValue(i, -step(static_cast<int>(x[0]->getMap()->getGlobalElement(i)), 0));
  system->residual(x, r);
  EXPECT_LE(r[0]->normInf(), 1e-12);
  const auto reactions = system->reactions(x);
  ASSERT_EQ(reactions.size(), 2u);
  EXPECT_EQ(reactions[0].condition, "wall");
  EXPECT_EQ(reactions[1].condition, "floor");
  EXPECT_NEAR(reactions[0].force[0], -0.75 * static_cast<Real>(mesh->n_global_nodes), 1e-10);  // all nodes are loaded
  EXPECT_EQ(reactions[1].force[0], 0);
  EXPECT_NEAR(reactions[0].force[1] + reactions[1].force[1], 0, 1e-10);
}

TEST(System, CommitMovesTheHistoriesOnAndNothingElseDoes) {
  const auto mesh = make_mesh();
  auto system = make_system(mesh, all_modules());
  system->set_time(1, 1);
  auto x = system->initial(), before = create_like(x), after = create_like(x);
  test::randomize(x, 0.5, 11);
  system->residual(x, before);
  system->jacobian(x);
  system->measures(x, before);
  system->residual(x, after);
  expect_equal(before, after, 0);
  system->commit(x);
  system->residual(x, after);
  after[1]->update(1, *x[1], 1);  // the residual contains the old glue with a negative sign
  expect_equal(before, after);
}

TEST(System, OutputsCoverGhostNodes) {
  const auto mesh = make_mesh();
  auto system = make_system(mesh, all_modules());
  system->set_time(1, 1);
  auto x = system->initial();
  test::randomize(x, 1, 13);
  const auto outputs = system->outputs(x);
  ASSERT_EQ(outputs.size(), 1u);
  ASSERT_EQ(static_cast<LocalIndex>(outputs[0].values.size()), 2 * mesh->n_nodes());
  for (LocalIndex i = 0; i < 2 * mesh->n_nodes(); ++i)
    EXPECT_EQ(outputs[0].values[i], test::pseudo_random(mesh->node_id[i / 2] * 2 + i % 2, 13));
}

TEST(System, ConflictingConditionsFailOnEveryRank) {
  const auto mesh = make_mesh();
  auto system = make_system(mesh, only(springs()),
                            {constrain(*mesh, "wall", "west", {base::Expression(1)}),
                             constrain(*mesh, "lid", "north", {base::Expression(2)})});
  EXPECT_THAT(mesh::testing::error_of([&] { system->set_time(1, 1); }), ::testing::HasSubstr("\"lid\""));
}

}  // namespace
}  // namespace sprekk::assembly
