#include "assembly/constraints.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <cmath>

#include "assembly/prescribed_error.hpp"
#include "base/check.hpp"
#include "mesh/distribute.hpp"
#include "unit/assembly/dense.hpp"
#include "unit/mesh/meshes.hpp"

namespace sprekk::assembly {
namespace {

using mesh::testing::crossed;
using ::testing::AllOf;
using ::testing::HasSubstr;

base::Expression text(const std::string& formula) {
  base::Expression e(formula);
  e.compile();
  return e;
}

struct ConstrainedProblem {
  mesh::GlobalMesh global;
  RCP<const mesh::Mesh> mesh;
  fields::Layout layout;

  explicit ConstrainedProblem(const std::string& cell)
      : global(mesh::make_box(crossed(cell))),
        mesh(mesh::make_distributed(global, Tpetra::getDefaultComm())),
        layout({"displacement", fields::Entity::node, mesh->dim(), "m"}, *mesh) {}

  DirichletCondition on(const std::string& name, const std::string& boundary,
                        std::vector<std::optional<base::Expression>> values) const {
    const auto& names = mesh->boundary_names;
    const auto number = std::find(names.begin(), names.end(), boundary) - names.begin();
    values.resize(mesh->dim());
    return {name, "displacement", static_cast<int>(number), std::move(values)};
  }

  Constraints constraints(const std::vector<DirichletCondition>& conditions) const {
    return {*mesh, layout, conditions};
  }

  /// Returns mask and value of every global unknown; the value is 0 where the unknown is free. Collective.
  std::array<test::Dense, 2> gather(const Constraints& c) const {
    fields::Vector mask(layout.owned()), values(layout.owned());
    for (LocalIndex i = 0; i < layout.n_owned(); ++i) {
      mask.replaceLocalValue(i, static_cast<Real>(c.mask()(i)));
      values.replaceLocalValue(i, c.values()(i));
    }
    return {test::gather(mask), test::gather(values)};
  }

  /// Returns the message of the Error of evaluate(), on every rank. Collective.
  std::string error_of(Constraints constraints, Real t) const {
    return mesh::testing::error_of([&] { base::collectively(*mesh->comm, [&] { constraints.evaluate(t); }); });
  }
};

TEST(Constraints, HoldTheGivenComponentsOfAllCopiesOfABoundarysNodes) {
  for (const auto& cell : mesh::testing::all_cells) {
    const ConstrainedProblem p(cell);
    const int dim = p.mesh->dim();
    auto constraints = p.constraints(
        {p.on("lid", "north", {text("2*x+t"), std::nullopt}), p.on("wall", "west", {std::nullopt, text("y*y")})});
    constraints.evaluate(0.5);
    const auto [mask, values] = p.gather(constraints);
    int copies = 0;  // copies of the node where fracture "c" ends on the north side
    for (int node = 0; node < static_cast<int>(p.global.n_nodes()); ++node) {
      const Real x = p.global.coordinates[node * dim], y = p.global.coordinates[node * dim + 1];
      const bool constrained[] = {y == 4, x == 0, false};
      copies += x == 4 && y == 4;
      for (int c = 0; c < dim; ++c) {
        EXPECT_EQ(mask(node * dim + c, 0), constrained[c]) << x << " " << y;
        EXPECT_EQ(values(node * dim + c, 0), !constrained[c] ? 0 : c == 0 ? 2 * x + 0.5 : y * y);
      }
    }
    EXPECT_EQ(copies, dim == 2 ? 2 : 6);
    Real here = constraints.largest(), all = 0;
    Teuchos::reduceAll(*p.mesh->comm, Teuchos::REDUCE_MAX, 1, &here, &all);
    EXPECT_EQ(all, 16);
    for (const auto& entry : constraints.entries()) {
      const LocalIndex node = entry.unknown / dim;
      EXPECT_EQ(entry.unknown % dim, entry.component);
      for (int i = 0; i < dim; ++i) EXPECT_EQ(entry.x[i], p.mesh->coordinates[node * dim + i]);
    }
  }
}

/// Fracture "c" ends on the north side at x = 4. Values with a jump at x = 4 differ between its sides; other values
/// are equal to the values at the nodes.
TEST(Constraints, GiveEachSideOfAFractureItsLimit) {
  for (const auto& cell : mesh::testing::all_cells)
    for (const int order : {1, 2}) {
      auto box = crossed(cell);
      box.order = order;
      const auto global = mesh::make_box(box);
      const auto mesh = mesh::make_distributed(global, Tpetra::getDefaultComm());
      const int dim = mesh->dim();
      const fields::Layout layout({"displacement", fields::Entity::node, dim, "m"}, *mesh);
      const auto& names = mesh->boundary_names;
      const int north = static_cast<int>(std::find(names.begin(), names.end(), "north") - names.begin());
      const auto given = [&](const std::string& formula) {
        std::vector<std::optional<base::Expression>> values(dim);
        values[0] = text(formula);
        Constraints constraints(*mesh, layout, {{"lid", "displacement", north, values}});
        constraints.evaluate(0.5);
        std::vector<std::array<Real, 3>> found;  // x, the mean x of the cells on the node's side, value
        const int n = mesh->nodes_per_cell();
        for (const auto& entry : constraints.entries()) {
          Real side = 0;
          for (LocalIndex k = 0; k < static_cast<LocalIndex>(mesh->cells.size()); ++k)
            if (mesh->cells[k] == entry.unknown / dim) side += mesh::cell_centre(*mesh, k / n)[0] - entry.x[0];
          found.push_back({entry.x[0], side, constraints.values()(entry.unknown)});
        }
        return found;
      };
      for (const std::string step : {"x > 4 ? 2*t+x : -1", "x >= 4 ? 2*t+x : -1"})
        for (const auto& [x, side, value] : given(step))
          EXPECT_NEAR(value, x > 4 || (x == 4 && side > 0) ? 1 + x : -1, 1e-14) << cell << " " << order;
      for (const auto& [x, side, value] : given("sqrt(abs(x-4))")) EXPECT_EQ(value, std::sqrt(std::abs(x - 4)));
      for (const auto& [x, side, value] : given("1e9+x/3")) EXPECT_EQ(value, 1e9 + x / 3);
      for (const auto& [x, side, value] : given("x > 3 ? 1 : 0")) EXPECT_EQ(value, x > 3);  // no fracture ends at 3
      std::vector<std::optional<base::Expression>> step(dim);
      step[0] = text("x > 4 ? 2 : -1");
      const auto error = prescribed_error(*mesh, layout, {{"lid", "displacement", north, step}}, 0);
      const auto values = error.getLocalViewHost(Tpetra::Access::ReadOnly);
      for (LocalIndex i = 0; i < layout.n_owned(); ++i) EXPECT_NEAR(values(i, 0), 0, 1e-14);
    }
}

/// Faces have edges of length 1. A function with second derivative g'' along an edge exceeds its linear interpolant by
/// -g''/12 on average, also on triangles. At a node of two boundaries, the error lies between the errors on both.
TEST(Constraints, MissCurvedValuesBetweenNodes) {
  for (const auto& cell : mesh::testing::all_cells) {
    const ConstrainedProblem p(cell);
    const int dim = p.mesh->dim();
    const auto g = text("3*x*x+6*t*y*y+x-y"), linear = text("t*x-2*y");
    const std::vector<DirichletCondition> conditions = {p.on("lid", "north", {g, linear}), p.on("wall", "west", {g})};
    const auto error = test::gather(prescribed_error(*p.mesh, p.layout, conditions, 2));
    for (int node = 0; node < static_cast<int>(p.global.n_nodes()); ++node) {
      const Real x = p.global.coordinates[node * dim], y = p.global.coordinates[node * dim + 1];
      SCOPED_TRACE(fmt::format("{} {} {}", cell, x, y));
      const Real west = -2, north = -0.5, found = error(node * dim, 0);
      if (x == 0 && y == 4) {
        EXPECT_GT(found, west + 0.1);
        EXPECT_LT(found, north - 0.1);
      } else {
        EXPECT_NEAR(found, x == 0 ? west : y == 4 ? north : 0, 1e-13);
      }
      for (int c = 1; c < dim; ++c) EXPECT_NEAR(error(node * dim + c, 0), 0, 1e-13);
    }
  }
}

/// The values exist at the nodes, but not in the middle of one face.
TEST(Constraints, HaveNoValueBetweenNodesOnAnyRank) {
  const ConstrainedProblem p("quadrilateral");
  const auto conditions = {p.on("lid", "north", {text("sqrt(abs(x-1.5)-0.45)")})};
  EXPECT_EQ(p.error_of(p.constraints(conditions), 0), "");
  EXPECT_THROW(prescribed_error(*p.mesh, p.layout, conditions, 0), Error);
}

/// Order 2 reproduces a quadratic function. A function with fourth derivative g4 has the mean error -g4/2880 on an
/// edge.
TEST(Constraints, MissLessAtOrderTwo) {
  for (const auto& [formula, missed] : {std::pair{"3*y*y", 0.0}, {"y^4", -24.0 / 2880}}) {
    auto box = crossed("quadrilateral");
    box.order = 2;
    const auto mesh = mesh::make_distributed(mesh::make_box(box), Tpetra::getDefaultComm());
    const fields::Layout layout({"displacement", fields::Entity::node, 2, "m"}, *mesh);
    const auto& names = mesh->boundary_names;
    const int west = static_cast<int>(std::find(names.begin(), names.end(), "west") - names.begin());
    const auto error =
        prescribed_error(*mesh, layout, {{"wall", "displacement", west, {text(formula), std::nullopt}}}, 0);
    const auto values = error.getLocalViewHost(Tpetra::Access::ReadOnly);
    for (LocalIndex i = 0; i < layout.n_owned(); ++i) {
      const bool constrained = i % 2 == 0 && mesh->coordinates[i] == 0;
      EXPECT_NEAR(values(i, 0), constrained ? missed : 0, 1e-13) << formula;
    }
  }
}

TEST(Constraints, MayMeetWhereTheyAgree) {
  const ConstrainedProblem p("quadrilateral");
  auto constraints = p.constraints({p.on("lid", "north", {text("t*x")}), p.on("wall", "east", {text("6*t")})});
  for (Real t : {0.0, 1.0, -2.5}) EXPECT_EQ(p.error_of(constraints, t), "");
  constraints.evaluate(2);
  const auto [mask, values] = p.gather(constraints);
  Real n_constrained = 0;
  for (Real m : mask.values) n_constrained += m;
  EXPECT_EQ(n_constrained, 8 + 5 - 1);  // 7 nodes and a copy on the north side, 5 on the east side, one corner
  Real n_entries = static_cast<Real>(constraints.entries().size()), all = 0;
  Teuchos::reduceAll(*p.mesh->comm, Teuchos::REDUCE_SUM, 1, &n_entries, &all);
  EXPECT_EQ(all, n_constrained);
}

TEST(Constraints, ConflictsNameBothConditionsAndThePlace) {
  for (const std::string cell : {"triangle", "hexahedron"}) {
    const ConstrainedProblem p(cell);
    const auto constraints = p.constraints(
        {p.on("lid", "north", {std::nullopt, text("0.25*t")}), p.on("wall", "east", {text("1"), text("0")})});
    EXPECT_EQ(p.error_of(constraints, 0), "");  // they agree at t = 0
    EXPECT_THAT(p.error_of(constraints, 3),
                AllOf(HasSubstr("\"lid\""), HasSubstr("\"wall\""), HasSubstr("0.75"), HasSubstr("component y"),
                      HasSubstr("displacement"), HasSubstr("(6, 4, "), HasSubstr("t = 3")));
  }
}

TEST(Constraints, SameConditionMayGiveANodeItsValueFromManyFaces) {
  const ConstrainedProblem p("tetrahedron");
  EXPECT_EQ(p.error_of(p.constraints({p.on("lid", "north", {text("x*y+z"), text("1"), text("t")})}), 1), "");
}

TEST(Constraints, NoneHoldNothing) {
  const ConstrainedProblem p("triangle");
  auto constraints = p.constraints({});
  constraints.evaluate(1);
  EXPECT_TRUE(constraints.entries().empty());
  EXPECT_EQ(constraints.largest(), 0);
  const auto [mask, values] = p.gather(constraints);
  EXPECT_EQ(test::largest(mask), 0);
  EXPECT_EQ(test::largest(values), 0);
}

}  // namespace
}  // namespace sprekk::assembly
