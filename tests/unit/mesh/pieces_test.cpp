// Blocks of rock between fractures, of whole meshes and of each rank's part.
#include <gtest/gtest.h>

#include <Teuchos_CommHelpers.hpp>
#include <Tpetra_Core.hpp>

#include "mesh/bodies.hpp"
#include "mesh/distribute.hpp"
#include "meshes.hpp"

namespace sprekk::mesh::testing {
namespace {

/// Returns a 4 x 4 [x 1] box cut at the given x and y by fractures from side to side.
BoxMesh cut(const std::string& cell, const std::vector<Real>& at_x, const std::vector<Real>& at_y) {
  const bool flat = dim_of(cell) == 2;
  auto box = unit_steps(cell, flat ? std::vector<int>{4, 4} : std::vector<int>{4, 4, 1});
  const auto add = [&](const std::string& name, std::vector<Real> lower, std::vector<Real> upper) {
    if (!flat) lower.push_back(0), upper.push_back(1);
    box.fractures[name] = fracture(lower, upper);
  };
  for (Real x : at_x) add(fmt::format("x{}", x), {x, 0}, {x, 4});
  for (Real y : at_y) add(fmt::format("y{}", y), {0, y}, {4, y});
  return box;
}

TEST(Pieces, AsManyAsThereAreBetweenCuts) {
  struct Case {
    std::vector<Real> at_x, at_y;
  };
  for (const auto& cell : all_cells)
    for (const auto& [at_x, at_y] : {Case{{}, {}}, {{1}, {}}, {{1}, {2}}, {{1, 2}, {3}}}) {
      const auto mesh = make_box(cut(cell, at_x, at_y));
      const auto pieces = find_pieces(mesh);
      ASSERT_EQ(pieces.n(), static_cast<int>((at_x.size() + 1) * (at_y.size() + 1))) << cell;
      EXPECT_EQ(find_bodies(mesh).n(), 1);
      // Each piece is a rectangle: its cells have the total volume of one and are on the same side of all cuts.
      std::vector<Real> volume(pieces.n(), 0);
      std::vector<Vector> first(pieces.n(), Vector{-1});
      const auto column = [](const std::vector<Real>& cuts, Real x) {
        return std::count_if(cuts.begin(), cuts.end(), [&](Real c) { return c < x; });
      };
      for (GlobalIndex c = 0; c < mesh.n_cells(); ++c) {
        const int piece = pieces.of_cell[c];
        const auto x = cell_centre(mesh, c);
        if (first[piece][0] < 0) first[piece] = x;
        volume[piece] += cell_volume(mesh, c);
        EXPECT_EQ(column(at_x, x[0]), column(at_x, first[piece][0]));
        EXPECT_EQ(column(at_y, x[1]), column(at_y, first[piece][1]));
      }
      if (at_x.size() == 1 && at_y.size() == 1) {
        std::sort(volume.begin(), volume.end());
        const Real areas[] = {2, 2, 6, 6};
        for (int k = 0; k < 4; ++k) EXPECT_NEAR(volume[k], areas[k], 1e-12);
      }
    }
}

TEST(Pieces, FracturesThatEndInRockSeparateNothing) {
  for (const auto& cell : all_cells) {
    auto box = crossed(cell);
    EXPECT_EQ(find_pieces(make_box(box)).n(), 1) << cell;
    box.fractures["a"].lower_corner[0] = 0;  // from the west side to the lower end of "c", which ends at the north
                                             // side
    EXPECT_EQ(find_pieces(make_box(box)).n(), 2) << cell;
  }
}

TEST(Pieces, EveryRankKnowsThoseOfItsCells) {
  const auto comm = Tpetra::getDefaultComm();
  for (const auto& cell : all_cells) {
    const auto global = make_box(cut(cell, {1}, {2}));
    const auto pieces = find_pieces(global);
    const auto mesh = make_distributed(global, comm);
    EXPECT_EQ(mesh->n_pieces, 4);
    ASSERT_EQ(mesh->cell_piece.size(), mesh->cell_id.size());
    for (LocalIndex c = 0; c < mesh->n_cells(); ++c)
      EXPECT_EQ(mesh->cell_piece[c], pieces.of_cell[mesh->cell_id[c]]) << cell << " cell " << mesh->cell_id[c];
    for (LocalIndex f = 0; f < mesh->n_owned_fracture_faces; ++f) {
      const auto& sides = mesh->fracture_faces[f].cell;
      EXPECT_NE(mesh->cell_piece[sides[minus]], mesh->cell_piece[sides[plus]]);
    }
  }
  EXPECT_EQ(make_distributed(make_box(cut("triangle", {}, {})), comm)->n_pieces, 1);
}

}  // namespace
}  // namespace sprekk::mesh::testing
