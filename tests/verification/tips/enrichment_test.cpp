// Crack tips with order 1.
#include "verification/tips/crack.hpp"

namespace sprekk::tests {
namespace {

/// 1,422 triangles; without enrichment the errors are 5.3e-2 and 9.0e-2.
TEST(Enrichment, OpeningAndSlidingOfACrack) {
  EXPECT_LE(jump_error(crack("opening", {"Mesh file.order=1"}), 1), 2.4e-2);
  EXPECT_LE(jump_error(crack("sliding", {"Mesh file.order=1"}), 0), 3.2e-2);
  EXPECT_GE(jump_error(crack("opening", {"Mesh file.order=1", "Mesh file.tips=plain"}), 1), 5e-2);
}

/// Eight faces, or eight by two triangles, along the crack.
TEST(Enrichment, OfAllCells) {
  for (const std::string cell : {"triangle", "quadrilateral", "tetrahedron", "hexahedron"})
    for (const auto& [name, direction] : {std::pair{"opening", 1}, std::pair{"sliding", 0}}) {
      const Real error = jump_error(crack_in_box(name, cell, 1, 16, "enriched"), direction),
                 plain = jump_error(crack_in_box(name, cell, 1, 16, "plain"), direction);
      SCOPED_TRACE(fmt::format("{} of {}: {} enriched, {} plain", name, cell, error, plain));
      EXPECT_LE(error, plain / 1.8);
      EXPECT_LE(error, 8e-2);
    }
}

}  // namespace
}  // namespace sprekk::tests
