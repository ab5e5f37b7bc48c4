// Embedding of displacements of order 1 in order 2.
#include "assembly/order_one.hpp"

#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>

#include "assembly/quarter_points.hpp"
#include "mesh/distribute.hpp"
#include "unit/mesh/meshes.hpp"

namespace sprekk::assembly {
namespace {

/// A linear field at corners is extended to the same field at all nodes, including nodes at quarter points. Corners
/// are unchanged.
TEST(OrderOne, LinearFieldsAreMet) {
  for (const auto& cell : mesh::testing::all_cells)
    for (const bool quarter_points : {false, true}) {
      SCOPED_TRACE(cell);
      auto box = mesh::testing::crossed(cell);
      box.order = 2;
      auto global = mesh::make_box(box);
      if (quarter_points) move_to_quarter_points(global);
      const auto mesh = mesh::make_distributed(global, Tpetra::getDefaultComm());
      const int dim = mesh->dim();
      const fields::Layout layout({"displacement", fields::Entity::node, dim, "m"}, *mesh);
      const auto P = interpolation_from_corners(*mesh, layout);
      const auto value = [](const auto& x, std::size_t n, int i, int dim) {
        Real u = 1 + i;
        for (int j = 0; j < dim; ++j) u += (2 + i - 0.7 * j) * x(n, j);
        return u;
      };
      fields::MultiVector places(fields::owned_map({"place", fields::Entity::node, 1, "m"}, *mesh), dim);
      const auto X = places.getLocalViewHost(Tpetra::Access::ReadWrite);
      for (LocalIndex node = 0; node < mesh->n_owned_nodes; ++node)
        for (int i = 0; i < dim; ++i) X(node, i) = mesh->coordinates[node * dim + i];
      const auto corners = at_corners(*mesh, places);
      fields::Vector coarse(P->getDomainMap()), fine(layout.owned());
      {
        const auto x = corners->getLocalViewHost(Tpetra::Access::ReadOnly);
        const auto u = coarse.getLocalViewHost(Tpetra::Access::OverwriteAll);
        ASSERT_EQ(u.extent(0), x.extent(0) * dim);
        for (std::size_t n = 0; n < x.extent(0); ++n)
          for (int i = 0; i < dim; ++i) u(n * dim + i, 0) = value(x, n, i, dim);
      }
      P->apply(coarse, fine);
      const auto u = fine.getLocalViewHost(Tpetra::Access::ReadOnly);
      for (LocalIndex node = 0; node < mesh->n_owned_nodes; ++node)
        for (int i = 0; i < dim; ++i) ASSERT_NEAR(u(node * dim + i, 0), value(X, node, i, dim), 1e-13);
      EXPECT_LT(P->getGlobalNumCols(), P->getGlobalNumRows());
    }
}

}  // namespace
}  // namespace sprekk::assembly
