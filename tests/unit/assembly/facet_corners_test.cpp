// Interpolation from corners to facets.
#include "assembly/facet_corners.hpp"

#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>

#include <set>

#include "base/over_ranks.hpp"
#include "mesh/distribute.hpp"
#include "mesh/facets.hpp"
#include "mesh/number_facets.hpp"
#include "unit/mesh/meshes.hpp"

namespace sprekk::assembly {
namespace {

struct Case {
  explicit Case(const mesh::GlobalMesh& global)
      : mesh(mesh::with_facets(mesh::make_distributed(global, Tpetra::getDefaultComm()))),
        layout({"pressure", fields::Entity::facet, 1, "Pa"}, *mesh),
        corners(facet_corners(*mesh, layout)) {}

  /// Returns P x for x = value(place of the unknown).
  template <class Value>
  std::vector<Real> interpolated(const Value& value) const {
    fields::Vector coarse(corners.interpolation->getDomainMap()), fine(layout.owned());
    {
      const auto x = corners.places->getLocalViewHost(Tpetra::Access::ReadOnly);
      const auto u = coarse.getLocalViewHost(Tpetra::Access::OverwriteAll);
      for (std::size_t n = 0; n < u.extent(0); ++n) {
        mesh::Vector at{};
        for (int i = 0; i < mesh->dim(); ++i) at[i] = x(n, i);
        u(n, 0) = value(at);
      }
    }
    corners.interpolation->apply(coarse, fine);
    const auto u = fine.getLocalViewHost(Tpetra::Access::ReadOnly);
    return {u.data(), u.data() + u.extent(0)};
  }

  RCP<const mesh::Mesh> mesh;
  fields::Layout layout;
  FacetCorners corners;
};

/// Linear fields at corners have their values at the centres of all facets. Each unknown has a facet.
TEST(FacetCorners, LinearFieldsAreMet) {
  for (const auto& cell : mesh::testing::all_cells) {
    SCOPED_TRACE(cell);
    const Case one(mesh::make_box(mesh::testing::crossed(cell)));
    const auto linear = [](const mesh::Vector& x) { return 1 + 2 * x[0] - 3 * x[1] + 0.7 * x[2]; };
    const auto u = one.interpolated(linear);
    const auto& mesh = *one.mesh;
    const int n = mesh::n_faces(mesh.shape), m = mesh::n_face_corners(mesh.shape);
    const auto check = [&](LocalIndex facet, const mesh::Vector& x) {
      if (facet >= mesh.facets->n_owned) return;
      EXPECT_NEAR(u[facet], linear(x), 1e-13);
    };
    for (LocalIndex face = 0; face < mesh.n_owned_cells * n; ++face)
      check(mesh.facets->of_cell[face], mesh::face_centre(mesh::face_corners(mesh, face / n, face % n)));
    for (LocalIndex ridge = 0; ridge < mesh.n_owned_fracture_faces * m; ++ridge)
      check(mesh.facets->ridge[ridge], mesh::ridge_centre(mesh, ridge / m, ridge % m));
    fields::Vector ones(one.layout.owned()), sums(one.corners.interpolation->getDomainMap());
    ones.putScalar(1);
    one.corners.interpolation->apply(ones, sums, Teuchos::TRANS);
    const auto sum = sums.getLocalViewHost(Tpetra::Access::ReadOnly);
    for (std::size_t k = 0; k < sum.extent(0); ++k) EXPECT_GT(sum(k, 0), 0);
  }
}

/// Returns the number of nodes of faces outside fractures.
GlobalIndex n_rock_nodes(const mesh::GlobalMesh& global) {
  std::set<std::pair<GlobalIndex, int>> in_fractures;
  for (const auto& face : global.fracture_faces)
    for (int side : {0, 1}) in_fractures.insert({face.cell[side], face.local_face[side]});
  std::set<GlobalIndex> nodes;
  for (GlobalIndex cell = 0; cell < global.n_cells(); ++cell)
    for (int k = 0; k < mesh::n_faces(global.shape); ++k)
      for (const GlobalIndex node : mesh::nodes_of_face(global, cell, k))
        if (node >= 0 && in_fractures.count({cell, k}) == 0) nodes.insert(node);
  return static_cast<GlobalIndex>(nodes.size());
}

GlobalIndex n_unknowns(const Case& one) {
  return static_cast<GlobalIndex>(one.corners.interpolation->getDomainMap()->getGlobalNumElements());
}

/// Number of unknowns: the nodes of the split mesh, and the points of fractures, once where fractures cross.
TEST(FacetCorners, SidesAndFracturesAreSeparate) {
  for (const auto& cell : mesh::testing::all_cells) {
    SCOPED_TRACE(cell);
    const auto global = mesh::make_box(mesh::testing::crossed(cell));
    std::set<GlobalIndex> points;
    for (const auto& face : global.fracture_faces)
      for (const GlobalIndex node : mesh::nodes_of_face(global, face.cell[0], face.local_face[0]))
        if (node >= 0) points.insert(global.point_of(node));
    EXPECT_EQ(n_unknowns(Case(global)), n_rock_nodes(global) + static_cast<GlobalIndex>(points.size()));
  }
}

/// Two fractures that touch in a point have separate unknowns there, two that share an edge have common ones.
TEST(FacetCorners, TouchingFracturesAreSeparate) {
  for (const std::string cell : {"hexahedron", "tetrahedron"})
    for (const bool touch : {true, false}) {
      SCOPED_TRACE(cell);
      auto box = mesh::testing::unit_steps(cell, {4, 4, 4});
      box.fractures["a"] = mesh::testing::fracture({1, 1, 2}, {2, 2, 2});
      box.fractures["b"] =
          touch ? mesh::testing::fracture({2, 2, 2}, {3, 3, 2}) : mesh::testing::fracture({2, 1, 2}, {3, 2, 2});
      const auto global = mesh::make_box(box);
      EXPECT_EQ(n_unknowns(Case(global)), n_rock_nodes(global) + (touch ? 8 : 6));
    }
}

}  // namespace
}  // namespace sprekk::assembly
