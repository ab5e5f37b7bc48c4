#include "mesh/extents.hpp"

#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>

#include "mesh/distribute.hpp"
#include "meshes.hpp"

namespace sprekk::mesh::testing {
namespace {

TEST(Extents, OfTheDomainAndOfEachFracture) {
  for (const auto& cell : all_cells)
    for (int order : {1, 2}) {
      auto box = crossed(cell);
      box.order = order;
      const auto mesh = make_distributed(make_box(box), Tpetra::getDefaultComm());
      const Real depth = dim_of(cell) == 2 ? 0 : 2;
      EXPECT_EQ(domain_extents(*mesh), (Vector{6, 4, depth})) << cell;
      EXPECT_EQ(fracture_extents(*mesh), (std::vector<Vector>{{4, 0, depth}, {0, 2, depth}, {0, 2, depth}})) << cell;
    }
}

TEST(Extents, NoFractures) {
  const auto mesh = make_distributed(make_box(unit_steps("quadrilateral", {1, 1})), Tpetra::getDefaultComm());
  EXPECT_EQ(domain_extents(*mesh), (Vector{1, 1, 0}));
  EXPECT_TRUE(fracture_extents(*mesh).empty());
}

}  // namespace
}  // namespace sprekk::mesh::testing
