#include "fields/layout.hpp"

#include <gtest/gtest.h>

#include <Teuchos_CommHelpers.hpp>
#include <Tpetra_Core.hpp>
#include <set>

#include "mesh/distribute.hpp"
#include "unit/mesh/meshes.hpp"

namespace sprekk::fields {
namespace {

using mesh::testing::all_cells;
using mesh::testing::crossed;

/// Returns meshes of all shapes, partitioned by METIS, and with all cells on the last rank (other ranks own nothing).
std::vector<RCP<const mesh::Mesh>> meshes() {
  const auto comm = Tpetra::getDefaultComm();
  std::vector<RCP<const mesh::Mesh>> result;
  for (const auto& cell : all_cells) {
    const auto global = mesh::make_box(crossed(cell));
    result.push_back(mesh::make_distributed(global, comm));
    result.push_back(mesh::distribute(global, std::vector<int>(global.n_cells(), comm->getSize() - 1), comm));
  }
  return result;
}

const std::vector<Field> all_fields = {{"displacement", Entity::node, 3, "m"},
                                       {"pressure", Entity::cell, 1, "Pa"},
                                       {"side bubble", Entity::fracture_face, 4, "m"}};

TEST(Maps, StoreNoNumbersThatFollowOneAnother) {
  const auto comm = Tpetra::getDefaultComm();
  const int rank = comm->getRank(), size = comm->getSize();
  std::vector<GlobalIndex> in_order, dealt;
  for (GlobalIndex i = 0; i < rank + 2; ++i) {
    in_order.push_back(GlobalIndex(rank) * (rank + 3) / 2 + i);  // 2, 3, 4, ... unknowns on ranks 0, 1, 2, ...
    dealt.push_back(i * size + (size - 1 - rank));
  }
  const auto first = make_map(in_order, comm);
  EXPECT_TRUE(first->isContiguous());
  for (std::size_t i = 0; i < in_order.size(); ++i) EXPECT_EQ(first->getGlobalElement(i), in_order[i]);
  const auto second = make_map(dealt, comm);
  EXPECT_EQ(base::n_local_elements(*second), dealt.size());
  for (std::size_t i = 0; i < dealt.size(); ++i) EXPECT_EQ(second->getGlobalElement(i), dealt[i]);
  const auto none = make_map(rank == 0 ? std::vector<GlobalIndex>{0, 1} : std::vector<GlobalIndex>(), comm);
  EXPECT_TRUE(none->isContiguous());
  EXPECT_EQ(none->getGlobalNumElements(), 2u);
  EXPECT_EQ(base::n_local_elements(*none), rank == 0 ? 2u : 0u);
}

GlobalIndex n_global(const mesh::Mesh& mesh, Entity entity) {
  return entity == Entity::node   ? mesh.n_global_nodes
         : entity == Entity::cell ? mesh.n_global_cells
                                  : mesh.n_global_fracture_faces;
}

GlobalIndex id(const mesh::Mesh& mesh, Entity entity, LocalIndex i) {
  return entity == Entity::node   ? mesh.node_id[i]
         : entity == Entity::cell ? mesh.cell_id[i]
                                  : mesh.fracture_faces[i].id;
}

TEST(Layout, ComponentsOfAnEntityAreAdjacentLocallyAndGlobally) {
  for (const auto& mesh : meshes())
    for (const auto& field : all_fields) {
      const Layout layout(field, *mesh);
      const LocalIndex n = n_entities(*mesh, field.entity, true), width = field.n_components;
      ASSERT_EQ(static_cast<LocalIndex>(base::n_local_elements(*layout.ghosted())), n * width);
      for (LocalIndex i = 0; i < n; ++i)
        for (int c = 0; c < width; ++c)
          EXPECT_EQ(layout.ghosted()->getGlobalElement(i * width + c), id(*mesh, field.entity, i) * width + c);
    }
}

TEST(Layout, OwnedUnknownsComeFirstAndEachHasOneOwner) {
  for (const auto& mesh : meshes())
    for (const auto& field : all_fields) {
      const Layout layout(field, *mesh);
      EXPECT_EQ(layout.field().name, field.name);
      EXPECT_EQ(layout.n_owned_entities(), n_entities(*mesh, field.entity, false));
      EXPECT_EQ(layout.n_owned(), layout.n_owned_entities() * field.n_components);
      ASSERT_EQ(static_cast<LocalIndex>(base::n_local_elements(*layout.owned())), layout.n_owned());
      for (LocalIndex i = 0; i < layout.n_owned(); ++i)
        EXPECT_EQ(layout.owned()->getGlobalElement(i), layout.ghosted()->getGlobalElement(i));
      EXPECT_TRUE(layout.owned()->isOneToOne());
      EXPECT_EQ(static_cast<GlobalIndex>(layout.owned()->getGlobalNumElements()),
                n_global(*mesh, field.entity) * field.n_components);
    }
}

TEST(Layout, ImportsEveryGhost) {
  for (const auto& mesh : meshes())
    for (const auto& field : all_fields) {
      const Layout layout(field, *mesh);
      Vector owned(layout.owned()), ghosted(layout.ghosted());
      for (LocalIndex i = 0; i < layout.n_owned(); ++i)
        owned.replaceLocalValue(i, 3.0 * static_cast<Real>(layout.owned()->getGlobalElement(i)) + 1);
      ghosted.putScalar(-1);
      ghosted.doImport(owned, *layout.import(), Tpetra::REPLACE);
      const auto view = ghosted.getLocalViewHost(Tpetra::Access::ReadOnly);
      for (std::size_t i = 0; i < view.extent(0); ++i)
        EXPECT_EQ(view(i, 0),
                  3.0 * static_cast<Real>(layout.ghosted()->getGlobalElement(static_cast<LocalIndex>(i))) + 1);
      EXPECT_EQ(layout.halo_bytes(), (view.extent(0) - layout.n_owned()) * sizeof(Real));
      const auto ghosts = base::local_elements(*layout.ghosted())(layout.n_owned(), view.extent(0) - layout.n_owned());
      std::vector<int> owners(ghosts.size());
      layout.owned()->getRemoteIndexList(ghosts, Teuchos::arrayView(owners.data(), owners.size()));
      EXPECT_EQ(layout.halo_messages(), std::set<int>(owners.begin(), owners.end()).size());
    }
}

TEST(Layout, RanksWithoutCellsHoldNothing) {
  const auto comm = Tpetra::getDefaultComm();
  const auto global = mesh::make_box(crossed("triangle"));
  const auto mesh = mesh::distribute(global, std::vector<int>(global.n_cells(), comm->getSize() - 1), comm);
  const bool holds_all = comm->getRank() == comm->getSize() - 1;
  for (const auto& field : all_fields) {
    const Layout layout(field, *mesh);
    EXPECT_EQ(layout.n_owned(), holds_all ? n_global(*mesh, field.entity) * field.n_components : 0);
    EXPECT_EQ(layout.halo_bytes(), 0u);
    EXPECT_EQ(layout.halo_messages(), 0u);
  }
}

}  // namespace
}  // namespace sprekk::fields
