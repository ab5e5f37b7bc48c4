#include "mesh/refine.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Teuchos_DefaultMpiComm.hpp>
#include <Tpetra_Core.hpp>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "mesh/cell_geometry.hpp"
#include "mesh/distribute.hpp"
#include "mesh/partition.hpp"
#include "mesh/raise_order.hpp"
#include "mesh/subdivision.hpp"
#include "mesh/tips.hpp"
#include "msh_meshes.hpp"
#include "parts.hpp"
#include "places.hpp"

namespace sprekk::mesh::testing {
namespace {

using ::testing::HasSubstr;

RCP<const Comm> alone() { return rcp(new Teuchos::MpiComm<int>(MPI_COMM_SELF)); }

/// Returns the global mesh of a mesh on one rank.
GlobalMesh whole(const Mesh& mesh) {
  GlobalMesh result;
  result.shape = mesh.shape;
  result.coordinates = mesh.coordinates;
  result.cells.assign(mesh.cells.begin(), mesh.cells.end());
  result.cell_region = mesh.cell_region;
  for (const auto& face : mesh.fracture_faces)
    result.fracture_faces.push_back({face.fracture, {face.cell[minus], face.cell[plus]}, face.local_face});
  for (const auto& face : mesh.boundary_faces)
    result.boundary_faces.push_back({face.boundary, face.cell, face.local_face});
  result.region_names = mesh.region_names;
  result.boundary_names = mesh.boundary_names;
  result.fracture_names = mesh.fracture_names;
  result.parent_node.resize(result.n_nodes());
  std::iota(result.parent_node.begin(), result.parent_node.end(), 0);
  for (const auto& face : mesh.fracture_faces)
    for (const auto& nodes : face.nodes)
      for (int k = 0; k < n_face_corners(mesh.shape); ++k) result.parent_node[nodes[k]] = face.corners[k];
  return result;
}

GlobalMesh ready(const BoxMesh& box) {
  auto mesh = make_box(box);
  turn_for_refinement(mesh);
  return mesh;
}

GlobalMesh refined_alone(const GlobalMesh& mesh, int times) {
  return whole(*refined(*make_distributed(mesh, alone()), times));
}

TEST(Subdivision, HasEqualVolumesAndPartsOfFaces) {
  for (const auto& cell : all_cells) {
    const auto mesh = make_box(unit_steps(cell, std::vector<int>(dim_of(cell), 1)));
    const auto division = subdivision(mesh.shape);
    const int n = mesh.dim() == 2 ? 4 : 8;
    EXPECT_EQ(division.n_children(), n);
    EXPECT_EQ(division.n_parts(), n / 2);
    const auto fine = refined_alone(mesh, 1);
    for (GlobalIndex c = 0; c < fine.n_cells(); ++c)
      EXPECT_NEAR(cell_volume(fine, c), cell_volume(mesh, c / n) / n, 1e-15) << cell << " " << c;
    for (int f = 0; f < n_faces(mesh.shape); ++f)
      for (const auto& part : division.of_face[f]) {
        const Vector of_part = area_vector(fine, part.child, part.local_face), of_face = area_vector(mesh, 0, f);
        EXPECT_LT(norm(of_part - (2.0 / n) * of_face), 1e-15) << cell << " " << f;
      }
  }
}

/// Refinement gives the cells, nodes (with copies), fractures and tips of the box with twice the cells. Triangles
/// differ, because their diagonals alternate in boxes.
TEST(Refine, MakesTheBoxOfTwiceTheCells) {
  for (const auto& cell : all_cells)
    for (auto box : boxes(cell))
      for (int times : {1, 2}) {
        const auto fine = refined_alone(ready(box), times);
        auto twice = box;
        for (int& n : twice.cells) n <<= times;
        EXPECT_TRUE(places_of(fine, cell != "triangle") == places_of(make_box(twice), cell != "triangle"))
            << cell << " " << box.fractures.size() << " " << times;
      }
}

/// The comparison includes the marked tips.
TEST(Refine, IsTheSameOnAnyRanks) {
  const auto comm = Tpetra::getDefaultComm();
  for (const auto& cell : all_cells)
    for (const auto& box : boxes(cell)) {
      const auto coarse = ready(box);
      std::vector<int> scattered;
      for (GlobalIndex c = 0; c < coarse.n_cells(); ++c)
        scattered.push_back(static_cast<int>(c * c % 7) % comm->getSize());
      for (const auto& part : {partition(coarse, comm->getSize()), scattered})
        for (int times : {1, 2}) {
          if (times == 2 && coarse.dim() == 3 && part == scattered) continue;
          auto fine = refined_alone(coarse, times);
          std::vector<int> fine_part;
          for (GlobalIndex c = 0; c < fine.n_cells(); ++c)
            fine_part.push_back(part[c / (fine.n_cells() / coarse.n_cells())]);
          auto mesh = *refined(*distribute(coarse, part, comm), times);
          if (times == 1) expect_as_documented(fine, fine_part, mesh);
          mark_tips(fine);
          mark_tips(mesh);
          expect_identical(mesh, *distribute(fine, fine_part, comm));
        }
    }
}

/// Fractures with many kinds of intersections: nodes of order 2 are added before and after the split.
TEST(RaiseOrder, AfterTheSplitGivesTheSameNodes) {
  const auto comm = Tpetra::getDefaultComm();
  for (const auto& [name, n] :
       std::map<std::string, int>{{"star", 3}, {"triple", 3}, {"planes", 2}, {"y", 3}, {"reach", 1}}) {
    auto options = fractures(n);
    const auto mesh = raise_order(*make_distributed(read_msh(path_of(name), options), alone()));
    options.order = 2;
    EXPECT_TRUE(places_of(whole(*mesh)) == places_of(read_msh(path_of(name), options))) << name;
  }
}

TEST(RaiseOrder, IsTheSameOnAnyRanks) {
  const auto comm = Tpetra::getDefaultComm();
  for (const auto& cell : all_cells)
    for (const auto& box : boxes(cell)) {
      const auto coarse = make_box(box);
      const auto part = partition(coarse, comm->getSize());
      const auto fine = whole(*raise_order(*make_distributed(coarse, alone())));
      auto second = box;
      second.order = 2;
      EXPECT_TRUE(places_of(fine) == places_of(make_box(second))) << cell;
      const auto mesh = raise_order(*distribute(coarse, part, comm));
      expect_as_documented(fine, part, *mesh);
      expect_identical(*mesh, *distribute(fine, part, comm));
    }
}

Real smallest_jacobian(const GlobalMesh& mesh) {
  const CellGeometry geometry(mesh.shape);
  Real result = 1;
  for (GlobalIndex c = 0; c < mesh.n_cells(); ++c) result = std::min(result, geometry.scaled_jacobian(mesh, c)[0]);
  return result;
}

/// All descendants of a tetrahedron have at most three shapes, which occur after the first step.
TEST(Refine, KeepsShapesOfTetrahedra) {
  for (int seed = 0; seed < 5; ++seed) {
    auto mesh = make_box(unit_steps("tetrahedron", {1, 1, 1}));
    for (std::size_t i = 0; i < mesh.coordinates.size(); ++i)
      mesh.coordinates[i] += 0.2 * std::sin(17.0 * static_cast<Real>(i + 1) + seed);
    turn_for_refinement(mesh);
    for (GlobalIndex c = 0; c < mesh.n_cells(); ++c) {
      auto one = mesh;
      one.cells.assign(&mesh.cells[4 * c], &mesh.cells[4 * c] + 4);
      one.cell_region = {0};
      one.boundary_faces.clear();
      one.coordinates.clear();
      for (GlobalIndex& node : one.cells) {
        const Vector x = point(mesh, node);
        node = one.n_nodes();
        one.coordinates.insert(one.coordinates.end(), x.begin(), x.end());
      }
      const auto once = refined_alone(one, 1), later = refined_alone(one, 4);
      EXPECT_EQ(shapes_of(once).size(), 3u);
      EXPECT_EQ(shapes_of(later), shapes_of(once));
      EXPECT_GT(smallest_jacobian(later), 0.4 * smallest_jacobian(one));
    }
  }
}

TEST(Refine, Errors) {
  const auto comm = Tpetra::getDefaultComm();
  const auto mesh = make_distributed(make_box(unit_steps("hexahedron", {2, 2, 2})), comm);
  EXPECT_THAT(error_of([&] { refined(*mesh, 12); }), HasSubstr("refinements: 12 make 5.5e+11 cells of 8"));
  EXPECT_THAT(error_of([&] { refined(*mesh, 1000); }), HasSubstr("take fewer, or more ranks"));
  auto box = unit_steps("triangle", {4, 4});
  box.periodic = {"x"};
  EXPECT_THAT(error_of([&] { refined(*make_distributed(make_box(box), comm), 1); }),
              HasSubstr("without periodic sides"));
}

}  // namespace
}  // namespace sprekk::mesh::testing
