// Cells of bad shape and the sets of facets around them.
#include "mesh/flat_cells.hpp"

#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>

#include <algorithm>
#include <set>

#include "mesh/distribute.hpp"
#include "mesh/facets.hpp"
#include "mesh/number_facets.hpp"
#include "unit/mesh/meshes.hpp"

namespace sprekk::mesh {
namespace {

using testing::dim_of;

/// Returns a mesh of the crossed fractures in which the nodes around the given ones are at distance `height` from the
/// opposite face of one of their cells, so that this cell is flat.
RCP<const Mesh> flattened(const std::string& cell, const std::vector<Vector>& nodes, Real height) {
  auto global = make_box(testing::crossed(cell));
  const int dim = global.dim(), n = n_nodes(global.shape);
  for (const auto& x : nodes)
    for (GlobalIndex node = 0; node < global.n_nodes(); ++node) {
      if (norm(point(global, node) - x) > 1e-9) continue;
      const auto at = std::find(global.cells.begin(), global.cells.end(), node) - global.cells.begin();
      Vector centre{};  // of the opposite face
      for (int k = 0; k < n; ++k)
        if (k != at % n) centre = centre + (1.0 / dim) * point(global, global.cells[at / n * n + k]);
      for (int i = 0; i < dim; ++i) global.coordinates[node * dim + i] = centre[i] + height * (x[i] - centre[i]);
    }
  return with_facets(make_distributed(global, Tpetra::getDefaultComm()));
}

TEST(FlatCells, RadiusRatioOfKnownCells) {
  const Real root = std::sqrt(3.0);
  const auto ratio = [&](Shape shape, std::vector<Real> coordinates) {
    Mesh one;
    one.shape = shape;
    one.coordinates = std::move(coordinates);
    for (int k = 0; k < n_nodes(shape); ++k) one.cells.push_back(k);
    return radius_ratio(one, 0);
  };
  EXPECT_NEAR(ratio(Shape::triangle, {0, 0, 1, 0, 0.5, root / 2}), 1, 1e-14);
  EXPECT_NEAR(ratio(Shape::tetrahedron, {1, 1, 1, 1, -1, -1, -1, 1, -1, -1, -1, 1}), 1, 1e-14);
  // 3-4-5: r = 1, R = 5/2; corner of a cube with edges 1: r = (3 - sqrt 3)/6, R = sqrt(3)/2
  EXPECT_NEAR(ratio(Shape::triangle, {0, 0, 3, 0, 0, 4}), 0.8, 1e-14);
  EXPECT_NEAR(ratio(Shape::tetrahedron, {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}), (3 - root) / root, 1e-14);
  EXPECT_NEAR(ratio(Shape::triangle, {0, 0, 1, 0, 0.5, 0}), 0, 1e-14);
  EXPECT_NEAR(ratio(Shape::tetrahedron, {1, 0, 0, 0, 1, 0, -1, 0, 0, 0, -1, 0}), 0, 1e-14);
  EXPECT_EQ(ratio(Shape::quadrilateral, {0, 0, 1, 0, 1, 0, 0, 0}), 1);
}

/// The sets are disjoint and contain the owned facets of all flat cells, and no others. Facets of a cell are in one
/// set.
TEST(FlatCells, SetsContainTheFacetsOfFlatCells) {
  for (const std::string cell : {"triangle", "tetrahedron"}) {
    SCOPED_TRACE(cell);
    const bool flat = dim_of(cell) == 2;
    const auto mesh = flattened(
        cell, flat ? std::vector<Vector>{{1, 1, 0}, {5, 3, 0}} : std::vector<Vector>{{1, 1, 1}, {5, 3, 1}}, 1e-3);
    const int n = n_faces(mesh->shape);
    std::vector<LocalIndex> set_of(mesh->facets->id.size(), -1);
    const auto sets = facets_of_flat_cells(*mesh);
    for (std::size_t s = 0; s < sets.size(); ++s)
      for (const LocalIndex facet : sets[s]) {
        ASSERT_LT(facet, mesh->facets->n_owned);
        EXPECT_EQ(set_of[facet], -1);
        set_of[facet] = static_cast<LocalIndex>(s);
      }
    std::set<LocalIndex> expected;
    for (LocalIndex c = 0; c < mesh->n_cells(); ++c) {
      if (radius_ratio(*mesh, c) >= 0.1) continue;
      std::set<LocalIndex> of_cell;
      for (int k = 0; k < n; ++k)
        if (const LocalIndex facet = mesh->facets->of_cell[c * n + k]; facet < mesh->facets->n_owned) {
          expected.insert(facet);
          of_cell.insert(set_of[facet]);
        }
      EXPECT_LE(of_cell.size(), 1u);
    }
    std::set<LocalIndex> found;
    for (const auto& set : sets) found.insert(set.begin(), set.end());
    EXPECT_EQ(found, expected);
    EXPECT_GE(sets.size(), mesh->comm->getSize() == 1 ? 2u : 0u);
  }
}

/// Sets are limited in size, also if all cells are flat.
TEST(FlatCells, SetsAreSmall) {
  for (const std::string cell : {"triangle", "tetrahedron"}) {
    auto global = make_box(testing::unit_steps(cell, dim_of(cell) == 2 ? std::vector{20, 20} : std::vector{5, 5, 5}));
    for (std::size_t k = 0; k < global.coordinates.size(); k += global.dim()) global.coordinates[k] *= 1e3;
    const auto mesh = with_facets(make_distributed(global, Tpetra::getDefaultComm()));
    EXPECT_LT(radius_ratio(*mesh, 0), 0.1);
    std::size_t squares = 0;
    for (const auto& set : facets_of_flat_cells(*mesh, 20)) {
      EXPECT_LE(set.size(), 20u);
      squares += set.size() * set.size();
    }
    EXPECT_LE(squares, 10 * static_cast<std::size_t>(mesh->facets->n_owned));
    EXPECT_TRUE(facets_of_flat_cells(
                    *with_facets(make_distributed(make_box(testing::crossed("hexahedron")), Tpetra::getDefaultComm())))
                    .empty());
  }
}

}  // namespace
}  // namespace sprekk::mesh
