#include "assembly/loop.hpp"

#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>

#include "mesh/distribute.hpp"
#include "unit/assembly/dense.hpp"
#include "unit/mesh/meshes.hpp"

namespace sprekk::assembly {
namespace {

using fields::Entity;
using fields::Layout;
using mesh::testing::crossed;

/// Mesh with the layouts of displacement (nodes), side bubble and traction (faces).
struct LoopProblem {
  mesh::GlobalMesh global;
  RCP<const mesh::Mesh> mesh;
  int dim;
  Layout u, beta, lambda;

  explicit LoopProblem(const std::string& cell)
      : global(mesh::make_box(crossed(cell))),
        mesh(mesh::make_distributed(global, Tpetra::getDefaultComm())),
        dim(mesh->dim()),
        u({"displacement", Entity::node, dim, "m"}, *mesh),
        beta({"side bubble", Entity::fracture_face, 2 * dim, "m"}, *mesh),
        lambda({"traction", Entity::fracture_face, dim, "Pa"}, *mesh) {}

  /// Returns the global numbers of the nodes of a cell.
  std::vector<GlobalIndex> nodes(GlobalIndex cell) const {
    const int n = mesh::n_nodes(global.shape);
    return {global.cells.begin() + cell * n, global.cells.begin() + (cell + 1) * n};
  }

  /// Returns the global numbers of the nodes of a face of a cell.
  std::vector<GlobalIndex> nodes(GlobalIndex cell, int local_face) const {
    std::vector<GlobalIndex> result;
    for (int k = 0; k < mesh::n_face_nodes(global.shape); ++k)
      result.push_back(nodes(cell)[mesh::face_nodes(global.shape)[local_face][k]]);
    return result;
  }
};

/// Returns the global numbers of the first unknown of each group of an entity.
std::vector<GlobalIndex> groups(const Stencil& stencil, const Layout& layout, int entity) {
  std::vector<GlobalIndex> result;
  for (std::size_t g = 0; g < stencil.first.extent(1); ++g)
    result.push_back(layout.ghosted()->getGlobalElement(stencil.first(entity, g)));
  return result;
}

std::vector<GlobalIndex> times(std::vector<GlobalIndex> nodes, int width) {
  for (auto& node : nodes) node *= width;
  return nodes;
}

TEST(Stencil, CellsAndBoundaryFacesTouchTheirNodes) {
  for (const auto& cell : mesh::testing::all_cells) {
    const LoopProblem p(cell);
    const auto cells = make_stencil(*p.mesh, Loop::cells, p.u);
    EXPECT_EQ(cells.width, p.dim);
    ASSERT_EQ(static_cast<LocalIndex>(cells.first.extent(0)), p.mesh->n_cells());
    for (LocalIndex c = 0; c < p.mesh->n_cells(); ++c)
      EXPECT_EQ(groups(cells, p.u, c), times(p.nodes(p.mesh->cell_id[c]), p.dim));
    const auto faces = make_stencil(*p.mesh, Loop::boundary_faces, p.u);
    ASSERT_EQ(faces.first.extent(0), p.mesh->boundary_faces.size());
    for (std::size_t f = 0; f < p.mesh->boundary_faces.size(); ++f) {
      const auto& face = p.mesh->boundary_faces[f];
      EXPECT_EQ(groups(faces, p.u, static_cast<int>(f)),
                times(p.nodes(p.mesh->cell_id[face.cell], face.local_face), p.dim));
    }
  }
}

TEST(Stencil, FractureSidesTouchTheirCellAndTheirHalfOfATwoSidedField) {
  for (const auto& cell : mesh::testing::all_cells) {
    const LoopProblem p(cell);
    const auto sides = fracture_sides(*p.mesh);
    const auto u = make_stencil(*p.mesh, Loop::fracture_sides, p.u),
               beta = make_stencil(*p.mesh, Loop::fracture_sides, p.beta),
               lambda = make_stencil(*p.mesh, Loop::fracture_sides, p.lambda);
    EXPECT_EQ(beta.width, p.dim);
    EXPECT_EQ(lambda.width, p.dim);
    ASSERT_EQ(u.first.extent(0), sides.size());
    for (int s = 0; s < static_cast<int>(sides.size()); ++s) {
      const auto& face = p.mesh->fracture_faces[sides[s][0]];
      const int side = sides[s][1];
      EXPECT_EQ(groups(u, p.u, s), times(p.nodes(p.global.fracture_faces[face.id].cell[side]), p.dim));
      EXPECT_EQ(groups(beta, p.beta, s), std::vector<GlobalIndex>{face.id * 2 * p.dim + side * p.dim});
      EXPECT_EQ(groups(lambda, p.lambda, s), std::vector<GlobalIndex>{face.id * p.dim});
    }
  }
}

TEST(Stencil, OwnedFractureFacesTouchBothSides) {
  for (const auto& cell : mesh::testing::all_cells) {
    const LoopProblem p(cell);
    const auto u = make_stencil(*p.mesh, Loop::fracture_faces, p.u),
               beta = make_stencil(*p.mesh, Loop::fracture_faces, p.beta);
    EXPECT_EQ(beta.width, 2 * p.dim);
    ASSERT_EQ(static_cast<LocalIndex>(u.first.extent(0)), p.mesh->n_owned_fracture_faces);
    const int n = mesh::n_face_nodes(p.global.shape);
    for (LocalIndex f = 0; f < p.mesh->n_owned_fracture_faces; ++f) {
      const auto& face = p.global.fracture_faces[p.mesh->fracture_faces[f].id];
      const auto touched = groups(u, p.u, f);
      ASSERT_EQ(static_cast<int>(touched.size()), 2 * n);
      const auto minus = times(p.nodes(face.cell[0], face.local_face[0]), p.dim);
      const auto plus = times(p.nodes(face.cell[1], face.local_face[1]), p.dim);
      EXPECT_EQ(std::vector<GlobalIndex>(touched.begin(), touched.begin() + n), minus);
      EXPECT_TRUE(std::is_permutation(touched.begin() + n, touched.end(), plus.begin()));
      for (int k = 0; k < n; ++k)
        for (int i = 0; i < p.dim; ++i)
          EXPECT_EQ(p.global.coordinates[touched[k] + i], p.global.coordinates[touched[n + k] + i]);  // both sides
                                                                                                      // coincide
      EXPECT_EQ(groups(beta, p.beta, f), std::vector<GlobalIndex>{p.mesh->fracture_faces[f].id * 2 * p.dim});
    }
  }
}

TEST(Stencil, FieldsOutOfReachAreRefused) {
  const LoopProblem p("triangle");
  const Layout pressure({"pressure", Entity::cell, 1, "Pa"}, *p.mesh);
  EXPECT_THROW(make_stencil(*p.mesh, Loop::cells, p.beta), Error);
  EXPECT_THROW(make_stencil(*p.mesh, Loop::fracture_faces, pressure), Error);
}

void add_pairs(const std::vector<GlobalIndex>& rows, int row_width, const std::vector<GlobalIndex>& columns,
               int column_width, test::Dense& pattern) {
  for (auto r : rows)
    for (auto c : columns)
      for (int i = 0; i < row_width; ++i)
        for (int j = 0; j < column_width; ++j) pattern(static_cast<int>(r + i), static_cast<int>(c + j)) = 1;
}

test::Dense pattern_of(const fields::CrsMatrix& matrix) {
  fields::CrsMatrix ones(matrix, Teuchos::Copy);
  Kokkos::deep_copy(ones.getLocalMatrixDevice().values, 1.0);
  return test::gather(ones);
}

TEST(MakeMatrix, HasTheEntriesOfItsStencilsAndNoOthers) {
  for (const std::string cell : {"triangle", "quadrilateral", "tetrahedron"}) {
    const LoopProblem p(cell);
    const auto at = [&](Loop loop, const Layout& layout) { return make_stencil(*p.mesh, loop, layout); };
    const int n_u = static_cast<int>(p.u.owned()->getGlobalNumElements()),
              n_beta = static_cast<int>(p.beta.owned()->getGlobalNumElements());
    test::Dense uu(n_u, n_u), ub(n_u, n_beta);
    for (GlobalIndex c = 0; c < p.global.n_cells(); ++c)
      add_pairs(times(p.nodes(c), p.dim), p.dim, times(p.nodes(c), p.dim), p.dim, uu);
    for (std::size_t f = 0; f < p.global.fracture_faces.size(); ++f)
      for (int side : {0, 1})
        add_pairs(times(p.nodes(p.global.fracture_faces[f].cell[side]), p.dim), p.dim,
                  {static_cast<GlobalIndex>(f) * 2 * p.dim + side * p.dim}, p.dim, ub);
    const auto cells = at(Loop::cells, p.u), sides = at(Loop::fracture_sides, p.u),
               halves = at(Loop::fracture_sides, p.beta);
    EXPECT_EQ(pattern_of(*make_matrix(p.u, p.u, {{cells, cells}})).values, uu.values);
    EXPECT_EQ(pattern_of(*make_matrix(p.u, p.u, {{cells, cells}, {sides, sides}})).values, uu.values);
    EXPECT_EQ(pattern_of(*make_matrix(p.u, p.beta, {{sides, halves}})).values, ub.values);
    EXPECT_EQ(pattern_of(*make_matrix(p.beta, p.u, {{halves, sides}})).values, test::transpose(ub).values);
  }
}

TEST(FindPositions, PointAtTheColumnsOfOwnedRows) {
  for (const auto& cell : mesh::testing::all_cells) {
    const LoopProblem p(cell);
    const auto sides = make_stencil(*p.mesh, Loop::fracture_sides, p.u),
               halves = make_stencil(*p.mesh, Loop::fracture_sides, p.beta);
    const auto matrix = make_matrix(p.u, p.beta, {{sides, halves}});
    const auto positions = find_positions(*matrix, sides, halves);
    const auto local = matrix->getLocalMatrixHost();
    for (std::size_t e = 0; e < positions.extent(0); ++e)
      for (std::size_t r = 0; r < positions.extent(1); ++r) {
        const LocalIndex row = sides.first(e, r);
        if (row >= p.u.n_owned()) {
          EXPECT_EQ(positions(e, r, 0), -1);
          continue;
        }
        for (int i = 0; i < sides.width; ++i)
          for (int j = 0; j < halves.width; ++j)
            EXPECT_EQ(local.graph.entries(local.graph.row_map(row + i) + positions(e, r, 0) + j),
                      halves.first(e, 0) + j);
      }
  }
}

TEST(FindPositions, RefuseEntriesThatTheMatrixLacks) {
  const LoopProblem p("triangle");
  const auto faces = make_stencil(*p.mesh, Loop::fracture_faces, p.lambda),
             sides = make_stencil(*p.mesh, Loop::fracture_faces, p.u);
  const auto diagonal = make_matrix(p.lambda, p.lambda, {{faces, faces}});
  EXPECT_NO_THROW(find_positions(*diagonal, faces, faces));
  if (p.mesh->n_owned_fracture_faces > 0) {
    EXPECT_THROW(find_positions(*diagonal, faces, sides), Error);
  }
  EXPECT_THROW(make_matrix(p.beta, p.u,
                           {{make_stencil(*p.mesh, Loop::fracture_sides, p.beta),
                             make_stencil(*p.mesh, Loop::fracture_sides, p.u)},
                            {make_stencil(*p.mesh, Loop::fracture_faces, p.beta), sides}}),
               Error);  // groups of rows with two widths
}

}  // namespace
}  // namespace sprekk::assembly
