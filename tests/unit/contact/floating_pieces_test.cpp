// Floating blocks for prescribed contact constraints.
#include <gmock/gmock.h>

#include <algorithm>
#include <numeric>

#include "floating_column.hpp"

namespace sprekk::test {
namespace {

Real largest(const contact::FloatingPieces::Motion& motion) {
  return motion.largest.empty() ? 0 : *std::max_element(motion.largest.begin(), motion.largest.end());
}

Real sum(const std::vector<Real>& values) { return std::accumulate(values.begin(), values.end(), Real(0)); }

using ::testing::AnyOf;
using ::testing::Eq;
using ::testing::HasSubstr;

TEST(FloatingPieces, NothingToWatchWhereAllIsConstrainedByConditions) {
  for (const auto& cell : all_cells) {
    auto box = column_box(cell);
    EXPECT_TRUE(Column(box, {"south", "north"}).pieces.possible()) << cell;
    EXPECT_FALSE(Column(box, {"west"}).pieces.possible()) << cell;
    box.fractures.erase("upper");
    EXPECT_FALSE(Column(box, {"south", "north"}).pieces.possible()) << cell;
    box.fractures.clear();
    EXPECT_FALSE(Column(box, {"south"}).pieces.possible()) << cell;
  }
}

TEST(FloatingPieces, SticksTogether) {
  for (const auto& cell : all_cells) {
    Column column(column_box(cell), {"south"});
    column.find(open, open);
    EXPECT_TRUE(column.pieces.any());
    column.find(stick, stick);
    EXPECT_FALSE(column.pieces.any()) << cell;
    EXPECT_EQ(column.pieces.proximal().normInf(), 0);
  }
}

/// Open faces around the middle block, whose opening is resisted: only sliding remains free.
TEST(FloatingPieces, SlidesIfOpeningIsResisted) {
  for (const auto& cell : all_cells) {
    Column column(column_box(cell), {"south", "north"});
    column.find(open, open);
    EXPECT_NEAR(column.n_motions(), dim_of(cell) == 2 ? 3 : 6, 1e-9) << cell;
    auto constraints = column.contact_constraints(open, open);
    for (auto& constraint : constraints) constraint.resisted = {0, 1, 0};
    column.pieces.find(constraints);
    EXPECT_NEAR(column.n_motions(), dim_of(cell) == 2 ? 1 : 3, 1e-9) << cell;
    // no free motion remains, but the term that makes the Jacobian of preconditioners regular
    constraints = column.contact_constraints(slip, open);
    for (auto& constraint : constraints) constraint.resisted = {1, 1, 1};
    const Real full = column.pieces.proximal().normInf();
    column.pieces.find(constraints);
    if (dim_of(cell) == 2) {
      EXPECT_FALSE(column.pieces.any()) << cell;
      EXPECT_TRUE(column.pieces.any_weakly_held()) << cell;
      EXPECT_NEAR(column.pieces.proximal().normInf(), 1e-8 * full, 1e-12 * full);
    }
  }
}

TEST(FloatingPieces, SlidesBetweenTwoThatAreConstrained) {
  for (const auto& cell : all_cells) {
    Column column(column_box(cell), {"south", "north"});
    column.find(slip, slip);
    ASSERT_NEAR(column.n_motions(), 1, 1e-9) << cell;
    const auto motion = column.pieces.part_of(column.rigid({RigidRow{9, 9, 0, 0, 0, 9}, {2, 3, 0, 0, 0, 5}, {8}}));
    ASSERT_EQ(motion.q.size(), 1u);
    for (int c = 0; c < 6; ++c) EXPECT_NEAR(motion.q[0][c], c == 0 ? 2 : 0, 1e-9);
    EXPECT_NEAR(largest(motion), 2, 1e-9);
    const auto n = column.mesh->n_global_cells / 3;
    const std::string where = dim_of(cell) == 2 ? "(1, 1.5)" : "(1, 1.5, 1)", zero = dim_of(cell) == 2 ? "" : ", 0";
    const auto text = [&](int sign) {
      return fmt::format("a piece of rock around {} ({} cells) can move along ({}, 0{})", where, n, sign, zero);
    };
    EXPECT_THAT(column.pieces.describe(column.pieces.first()), AnyOf(Eq(text(1)), Eq(text(-1))));
    column.find(slip, stick);
    EXPECT_FALSE(column.pieces.any());
    if (dim_of(cell) == 2) continue;
    column.find(slip, {Contact::slip, {0.6, 0, 0.8}});  // different directions
    EXPECT_FALSE(column.pieces.any());
    column.find({Contact::slip, {0.6, 0, 0.8}}, {Contact::slip, {0.6, 0, 0.8}});
    const auto oblique = column.pieces.part_of(column.rigid({RigidRow{}, {3, 0, 4}, {}}));
    EXPECT_NEAR(oblique.q.at(0)[0], 3, 1e-9);
    EXPECT_NEAR(oblique.q.at(0)[2], 4, 1e-9);
  }
}

TEST(FloatingPieces, FreeOfEverything) {
  for (const auto& cell : all_cells) {
    const int n = dim_of(cell) == 2 ? 3 : 6;
    Column constrained(column_box(cell), {"south", "north"}), standing(column_box(cell), {"south"});
    constrained.find(open, open);
    EXPECT_NEAR(constrained.n_motions(), n, 1e-8) << cell;
    standing.find(open, open);
    ASSERT_NEAR(standing.n_motions(), 2 * n, 1e-8) << cell;
    standing.find(stick, open);
    ASSERT_NEAR(standing.n_motions(), n, 1e-8) << cell;
    standing.find(open, stick);  // the two upper blocks together
    ASSERT_NEAR(standing.n_motions(), n, 1e-8) << cell;
    EXPECT_THAT(standing.pieces.describe(standing.pieces.first()), HasSubstr("and 1 more"));
  }
}

/// Tied sides allow no rotation, also with one layer of cells that has only one layer of independent nodes.
TEST(FloatingPieces, PeriodicSides) {
  for (const auto& cell : all_cells)
    for (int width : {2, 1}) {
      SCOPED_TRACE(cell);
      const int dim = dim_of(cell);
      auto box = column_box(cell, width);
      box.periodic = dim == 2 ? std::vector<std::string>{"x"} : std::vector<std::string>{"x", "z"};
      Column column(box, {"south"});
      column.find(stick, stick);
      EXPECT_FALSE(column.pieces.any());
      const auto expect_free = [&](const std::array<RigidRow, 3>& q) {
        auto u = column.rigid(q);
        column.pieces.add(std::vector<Real>(column.pieces.n_groups(), -1), column.pieces.part_of(u), u);
        EXPECT_NEAR(u.normInf(), 0, 1e-9);
      };
      fields::Vector any(column.layout.owned());
      any.randomize();
      for (const auto& upper : {open, slip}) {
        column.find(stick, upper);
        expect_free({RigidRow{}, {}, {1, 0, 0}});
        if (upper.state == Contact::open) expect_free({RigidRow{}, {}, {0, 1, 0}});
        const auto motion = column.pieces.part_of(any);
        ASSERT_EQ(motion.q.size(), 1u);
        for (int c = 3; c < 6; ++c) EXPECT_NEAR(motion.q[0][c], 0, 1e-9);
      }
      column.find(slip, open);
      expect_free({RigidRow{}, {1, 0, 0}, {0, 2, 0}});
    }
}

/// The blocks on both sides of a crack across a layer form one block: they are tied to each other at the other end.
TEST(FloatingPieces, TiedToEachOther) {
  for (const auto& cell : all_cells) {
    const int dim = dim_of(cell);
    auto box = column_box(cell);
    box.fractures.erase("upper");
    std::vector<Real> from{1, 1, 0}, to{1, 3, 2};
    from.resize(dim), to.resize(dim);
    box.fractures["crack"] = mesh::testing::fracture(from, to);
    box.periodic = {"x"};
    Column column(box, {"south"});
    ASSERT_EQ(column.mesh->n_pieces, 3);
    const auto blocks = column.block_of_node();
    fields::Vector u(column.layout.owned()), v(column.layout.owned());
    for (LocalIndex k = 0; k < column.layout.n_owned_entities(); ++k)
      if (blocks[k] > 0) u.replaceLocalValue(k * dim, 2.0);
    const auto part = [&](const Contact& lower, const Contact& crack) {
      column.find(lower, crack);
      v.putScalar(0);
      if (column.pieces.any())
        column.pieces.add(std::vector<Real>(column.pieces.n_groups(), 1), column.pieces.part_of(u), v);
      v.update(-1, u, 1);
      return v.normInf();
    };
    EXPECT_NEAR(part(slip, open), 0, 1e-9) << cell;
    EXPECT_NEAR(part(slip, stick), 0, 1e-9) << cell;
    EXPECT_EQ(part(stick, open), 2) << cell;
    EXPECT_FALSE(column.pieces.any());
    // only together
    column.find(slip, open);
    u.randomize();
    const auto motion = column.pieces.part_of(u);
    ASSERT_EQ(motion.q.size(), 2u);
    for (int c = 0; c < 6; ++c) {
      EXPECT_NEAR(motion.q[0][c], motion.q[1][c], 1e-9);
      EXPECT_NEAR(c > 0 ? motion.q[0][c] : 0, 0, 1e-9);
    }
  }
}

TEST(FloatingPieces, SlideTogetherThoughEachSticksToTheOther) {
  for (const auto& cell : all_cells) {
    Column column(column_box(cell), {"south"});
    column.find(slip, stick);
    ASSERT_NEAR(column.n_motions(), 1, 1e-9) << cell;
    const auto motion = column.pieces.part_of(column.rigid({RigidRow{}, {3}, {1}}));
    ASSERT_EQ(motion.q.size(), 2u);
    for (const auto& q : motion.q)
      for (int c = 0; c < 6; ++c) EXPECT_NEAR(q[c], c == 0 ? 2 : 0, 1e-9) << "the mean of both";
    EXPECT_THAT(column.pieces.describe(column.pieces.first()), HasSubstr("and 1 more can move along ("));
  }
}

/// A face transmits force at its centre.
TEST(FloatingPieces, TurnsAboutOneFace) {
  for (const std::string cell : {"quadrilateral", "hexahedron"}) {
    Column column(column_box(cell, 1), {"south", "north"});
    column.find(open, stick);
    ASSERT_TRUE(column.pieces.any());
    fields::Vector u(column.layout.owned()), back(column.layout.owned());
    u.randomize();
    const auto motion = column.pieces.part_of(u);
    ASSERT_EQ(motion.q.size(), 1u);
    EXPECT_GT(largest(motion), 1e-3);
    const bool flat = dim_of(cell) == 2;
    const RigidFrame frame{{0.5, 1.5, flat ? 0 : 0.5}, 1};
    const auto at_face = rigid_displacement(frame, motion.q[0], {0.5, 2, flat ? 0 : 0.5});
    for (Real v : at_face) EXPECT_NEAR(v, 0, 1e-9);
    EXPECT_THAT(column.pieces.describe(column.pieces.first()),
                HasSubstr(flat ? "can rotate about (0.5, 2)" : "can rotate about the axis ("));
  }
}

/// part_of() is a projection, and add() is its inverse.
TEST(FloatingPieces, PartsAddUp) {
  for (const auto& cell : all_cells)
    for (const auto& contacts : {std::pair{open, open}, {slip, stick}, {stick, slip}}) {
      Column column(column_box(cell), {"south"});
      column.find(contacts.first, contacts.second);
      fields::Vector u(column.layout.owned()), v(column.layout.owned());
      u.randomize();
      const auto motion = column.pieces.part_of(u);
      ASSERT_GT(largest(motion), 1e-3);
      column.pieces.add(std::vector<Real>(column.pieces.n_groups(), 2), motion, v);
      const auto twice = column.pieces.part_of(v);
      for (std::size_t k = 0; k < motion.q.size(); ++k)
        for (int c = 0; c < 6; ++c) EXPECT_NEAR(twice.q[k][c], 2 * motion.q[k][c], 1e-9);
      column.pieces.add(std::vector<Real>(column.pieces.n_groups(), -1), motion, u);
      EXPECT_NEAR(largest(column.pieces.part_of(u)), 0, 1e-9);
    }
}

/// Each mode is a free motion, and their number is correct; the modes are independent.
TEST(FloatingPieces, ModesAreFreeMotions) {
  for (const auto& cell : all_cells) {
    Column column(column_box(cell), {"south"});
    column.find(open, open);  // two groups of one block each
    const int n = dim_of(cell) == 2 ? 3 : 6;
    ASSERT_EQ(column.pieces.max_modes(), n);
    for (int k = 0; k < n; ++k) {
      const auto mode = column.pieces.mode(k);
      ASSERT_EQ(mode.largest.size(), 2u);
      fields::Vector u(column.layout.owned());
      column.pieces.add({1, 3}, mode, u);
      const auto part = column.pieces.part_of(u);
      for (std::size_t piece = 0; piece < 2; ++piece) {
        EXPECT_GT(mode.largest[piece], 0.1);
        for (int c = 0; c < 6; ++c) EXPECT_NEAR(part.q[piece][c], (piece == 0 ? 1 : 3) * mode.q[piece][c], 1e-9);
      }
      for (int l = 0; l < k; ++l) EXPECT_NE(column.pieces.mode(l).q, mode.q);
    }
    EXPECT_EQ(largest(column.pieces.mode(n)), 0);
  }
}

TEST(FloatingPieces, ProximalOnFloatingPieces) {
  for (const auto& cell : all_cells)
    for (bool periodic : {false, true}) {
      auto box = column_box(cell);
      if (periodic) box.periodic = {"x"};
      Column column(box, {"south", "north"});
      for (const auto& contacts : {std::pair{open, open}, {slip, slip}, {stick, slip}}) {
        column.find(contacts.first, contacts.second);
        const auto blocks = column.block_of_node();
        const auto proximal = column.pieces.proximal().getData();
        for (LocalIndex i = 0; i < column.layout.n_owned(); ++i)
          if (column.pieces.any() && blocks[i / column.mesh->dim()] == 1) {
            EXPECT_GT(proximal[i], 0);
            EXPECT_LT(proximal[i], 1e-4 * 7);
          } else {
            EXPECT_EQ(proximal[i], 0);
          }
      }
      EXPECT_FALSE(column.pieces.any());
    }
}

/// Minimum-norm displacement among those that differ by a free motion. It is zero for a motion of the floating block.
/// If the block must keep a distance of 0.1 from a neighbour, it is a translation by 0.1.
TEST(FloatingPieces, ComesToLieNearest) {
  for (const auto& cell : all_cells) {
    Column column(column_box(cell), {"south", "north"});
    column.find(open, open);
    ASSERT_EQ(column.pieces.n_groups(), 1);
    std::array<RigidRow, 3> moved{};
    for (int mode : contact::rigid_modes(column.mesh->dim())) moved[1][mode] = 0.3 + 0.1 * mode;
    for (const Real side : {0, 1, -1}) {  // the neighbour that is an obstacle
      std::vector<FloatingPieces::Obstacle> obstacles;
      for (LocalIndex f = 0; f < column.mesh->n_owned_fracture_faces && side != 0; ++f) {
        const auto& face = column.mesh->fracture_faces[f];
        const bool upper = column.mesh->fracture_names[face.fracture] == "upper";
        if (upper != (side > 0)) continue;
        const bool plus_above = face.frame[0][1] > 0;
        const Real sign = plus_above ? 1 : -1;
        const auto at = rigid_displacement(column.frame(1), moved[1], face.centre);
        obstacles.push_back({f, {0, sign, 0}, 0.1 + side * at[1]});
      }
      auto u = column.rigid(moved);
      const auto motion = column.pieces.nearest(column.pieces.places(u, {}), obstacles, 0.1);
      ASSERT_TRUE(motion);
      column.pieces.add({1}, {*motion, {}}, u);
      for (int mode : contact::rigid_modes(column.mesh->dim()))
        EXPECT_NEAR(column.coordinate(u, 1, mode), mode == 1 ? -0.1 * side : 0, 1e-10) << cell << side << mode;
    }
  }
}

/// A block that slides on both neighbours moves until both slips are equal, from any position. The motion is limited
/// so that no slip changes its sign.
TEST(FloatingPieces, SlidesToWhereSlipIsLeast) {
  for (const auto& cell : all_cells)
    for (const Real place : {0.0, 0.7}) {
      Column column(column_box(cell), {"south", "north"});
      column.find(slip, slip);
      ASSERT_EQ(column.pieces.n_groups(), 1);
      std::array<RigidRow, 3> moved{};
      moved[1][0] = place;
      std::vector<FloatingPieces::Slide> slides;
      std::vector<FloatingPieces::Obstacle> obstacles;
      for (LocalIndex f = 0; f < column.mesh->n_owned_fracture_faces; ++f) {
        const auto& face = column.mesh->fracture_faces[f];
        const bool upper = column.mesh->fracture_names[face.fracture] == "upper";
        const Vector along{face.frame[0][1] > 0 ? 1.0 : -1.0, 0, 0};  // slip of the block above relative to the block
                                                                      // below
        slides.push_back({f, along, upper ? 0.5 : 0.1, true});
        if (upper) obstacles.push_back({f, along, -0.15});
      }
      const auto u = column.rigid(moved);
      const auto places = column.pieces.places(u, slides);
      for (const bool blocked : {false, true}) {
        const auto found = column.pieces.nearest(places, blocked ? obstacles : decltype(obstacles){}, 0.1);
        ASSERT_TRUE(found);
        for (int c = 0; c < 6; ++c)
          EXPECT_NEAR((*found)[0][c], c == 0 ? (blocked ? 0.15 : 0.2) : 0, 1e-12) << cell << place << blocked;
      }
    }
}

/// A free motion whose slip is round-off returns by the displacement. The least slip would require a motion of 2.5e8.
TEST(FloatingPieces, RoundOffOfSlipDoesNotMoveBlocks) {
  for (const auto& cell : all_cells) {
    Column column(column_box(cell), {"south", "north"});
    column.find(slip, slip);
    ASSERT_EQ(column.pieces.n_groups(), 1);
    std::array<RigidRow, 3> moved{};
    moved[1][0] = 0.7;
    std::vector<FloatingPieces::Slide> slides;
    for (LocalIndex f = 0; f < column.mesh->n_owned_fracture_faces; ++f) {
      const bool upper = column.mesh->fracture_names[column.mesh->fracture_faces[f].fracture] == "upper";
      slides.push_back({f, {1e-9, 1, 0}, upper ? 0.5 : 0, false});
    }
    const auto motion = column.pieces.nearest(column.pieces.places(column.rigid(moved), slides), {}, 0.1);
    ASSERT_TRUE(motion);
    for (int c = 0; c < 6; ++c) EXPECT_NEAR((*motion)[0][c], c == 0 ? -0.7 : 0, 1e-10) << cell;
  }
}

/// Next to the softest block, the proximal term is as small as inside. Removal of rigid motions leaves zero.
TEST(FloatingPieces, BlocksOfOtherStiffness) {
  for (const auto& cell : all_cells) {
    Column column(column_box(cell), {"south"});
    const auto blocks = column.block_of_node();
    const int dim = column.mesh->dim();
    for (std::size_t k = 0; k < blocks.size(); ++k)
      for (int i = 0; i < dim; ++i) column.diagonal->replaceLocalValue(k * dim + i, blocks[k] == 1 ? 1e6 : 1);
    column.pieces.set_stiffness(*column.diagonal);
    EXPECT_NEAR(column.pieces.contrast(), 1e6, 1e-6 * 1e6);
    column.find(open, open);
    EXPECT_LT(column.pieces.proximal().normInf(), 1e-4 * 2);
    std::array<RigidRow, 3> moved{};
    for (int block = 0; block < 3; ++block)
      for (int mode : contact::rigid_modes(dim)) moved[block][mode] = 1 + block - 0.2 * mode;
    fields::Vector ghosted(column.layout.ghosted());
    ghosted.doImport(column.rigid(moved), *column.layout.import(), Tpetra::REPLACE);
    ASSERT_GT(ghosted.normInf(), 1);
    column.pieces.remove_rigid(ghosted);
    EXPECT_LT(ghosted.normInf(), 1e-12);
  }
}

/// Forces of tractions lambda on the sides of all faces, in equal parts at the nodes: -lambda on plus, lambda on
/// minus. The residual is their opposite. The excess part of lambda does no work.
TEST(FloatingPieces, WorkIsThatOfTheLaw) {
  const auto law = [](const Vector& x) { return Vector{1 + 0.3 * x[1], 0.2 * x[0] - 0.5, 0.4 + 0.1 * x[2]}; };
  const auto excess = [](const Vector& x) { return Vector{-7 + x[1], 5 * x[0], 2 * x[2] - x[0]}; };
  for (const auto& cell : all_cells)
    for (const auto& upper : {open, stick}) {
      Column column(column_box(cell), {"south"});
      const auto& mesh = *column.mesh;
      const int dim = mesh.dim(), n = mesh::n_face_nodes(mesh.shape);
      auto contact_constraints = column.contact_constraints(open, upper);
      for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f)
        for (int i = 0; i < dim; ++i) contact_constraints[f].excess[i] = excess(mesh.fracture_faces[f].centre)[i];
      column.pieces.find(contact_constraints);
      fields::Vector r(column.layout.owned()), u(column.layout.owned());
      for (const auto& face : mesh.fracture_faces)
        for (int side : {mesh::minus, mesh::plus})
          for (int k = 0; k < n; ++k)
            if (const auto node = face.nodes[side][k]; node >= 0 && node < column.layout.n_owned_entities())
              for (int i = 0; i < dim; ++i)
                r.sumIntoLocalValue(node * dim + i, (side == mesh::plus ? 1 : -1) * face.area / n *
                                                        (law(face.centre)[i] + excess(face.centre)[i]));
      for (int mode : contact::rigid_modes(dim)) {
        std::array<RigidRow, 3> q{};
        q[1][mode] = 0.3;
        q[2][mode] = upper.state == Contact::stick ? 0.3 : -0.4;
        const auto motion = column.pieces.part_of(column.rigid(q));
        Real here = 0, expected = 0;  // work of the face on the block above, minus work on the block below
        for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) {
          const auto& face = mesh.fracture_faces[f];
          const int below = face.centre[1] < 1.5 ? 0 : 1;
          const Real up = face.frame[0][1] > 0 ? 1 : -1;
          for (int i = 0; i < dim; ++i) {
            Real jump = 0;
            for (int side : {0, 1})
              if (below + side > 0)
                jump += (side == 1 ? 1 : -1) *
                        rigid_displacement(column.frame(below + side), motion.q.at(below + side - 1), face.centre)[i];
            here += up * jump * face.area * law(face.centre)[i];
          }
        }
        Teuchos::reduceAll(*mesh.comm, Teuchos::REDUCE_SUM, 1, &here, &expected);
        EXPECT_NEAR(sum(column.pieces.work(motion, r, contact_constraints)), expected, 1e-9)
            << cell << " mode " << mode;
      }
    }
}

}  // namespace
}  // namespace sprekk::test
