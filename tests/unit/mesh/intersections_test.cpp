#include "mesh/intersections.hpp"

#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <algorithm>
#include <map>
#include <set>

#include "mesh/distribute.hpp"
#include "mesh/mesh_info.hpp"
#include "mesh/number_facets.hpp"
#include "mesh/partition.hpp"
#include "mesh/refine.hpp"
#include "meshes.hpp"
#include "parts.hpp"

namespace sprekk::mesh::testing {
namespace {

/// Returns the length of all edges, or the number of points.
Real measure(const std::vector<Intersection>& intersections) {
  Real sum = 0;
  for (const auto& at : intersections) sum += at.x.size() == 1 ? 1 : norm(at.x[1] - at.x[0]);
  return sum;
}

/// Returns the intersections of a mesh. Checks that rank 0 has all of them, without duplicates, and as many as
/// mesh-info counts.
std::vector<Intersection> expect_as_counted(const GlobalMesh& global, const Mesh& mesh) {
  const auto found = intersections(mesh);
  EXPECT_EQ(static_cast<GlobalIndex>(found.size()), mesh.comm->getRank() == 0 ? describe(global).n_intersections : 0);
  std::set<std::vector<GlobalIndex>> nodes;
  for (const auto& at : found) nodes.insert(at.nodes);
  EXPECT_EQ(nodes.size(), found.size());
  return found;
}

/// Returns partitions of the cells: scattered, and two with one rank on each side of fracture "a". There, a rank has
/// no cells on the other side, hence does not see fractures that end there.
std::vector<std::vector<int>> other_parts(const GlobalMesh& mesh, int n) {
  std::vector<int> scattered, below, above;
  for (GlobalIndex c = 0; c < mesh.n_cells(); ++c) {
    scattered.push_back(static_cast<int>(c * c % 7) % n);
    above.push_back(cell_centre(mesh, c)[1] > 2 ? n - 1 : 0);
    below.push_back(n - 1 - above.back());
  }
  return {scattered, above, below};
}

TEST(Intersections, AreThoseOfTheMeshHoweverItIsDistributed) {
  const auto comm = Tpetra::getDefaultComm();
  for (const auto& cell : all_cells)
    for (int order : {1, 2}) {
      auto box = crossed(cell);
      box.order = order;
      const auto global = make_box(box);
      const auto found = expect_as_counted(global, *make_distributed(global, comm));
      for (const auto& part : other_parts(global, comm->getSize())) {
        const auto other = expect_as_counted(global, *distribute(global, part, comm));
        ASSERT_EQ(found.size(), other.size());
        for (std::size_t k = 0; k < found.size(); ++k) {
          EXPECT_EQ(found[k].nodes, other[k].nodes);
          EXPECT_EQ(found[k].x, other[k].x);
          EXPECT_EQ(found[k].fractures, other[k].fractures);
        }
      }
      for (const auto& at : found) {  // a crossing (X) and a T
        EXPECT_EQ(at.fractures, at.x[0][0] < 3.5 ? (std::vector<int>{0, 0, 1, 1}) : (std::vector<int>{0, 0, 2}));
        EXPECT_EQ(at.nodes.size(), global.dim() == 2 ? 1u : order + 1u);
        if (at.x.size() == 3) {
          EXPECT_LT(norm(at.x[0] + at.x[1] - 2.0 * at.x[2]), 1e-12);
        }
      }
      EXPECT_EQ(found.empty(), comm->getRank() > 0);
    }
}

/// Three fractures through the centre of a box, with unit edges. An owned edge has all edges at its ends: 6
/// intersections at the centre, 2 along a line, and at its end on the boundary the 4 borders that end there.
TEST(Intersections, JunctionsAreCompleteAtOwnedEdges) {
  const auto comm = Tpetra::getDefaultComm();
  for (const std::string cell : {"tetrahedron", "hexahedron"})
    for (const int refinements : {0, 1}) {
      auto box = unit_steps(cell, {4, 4, 4});
      box.fractures["a"] = fracture({0, 2, 0}, {4, 2, 4});
      box.fractures["b"] = fracture({2, 0, 0}, {2, 4, 4});
      box.fractures["c"] = fracture({0, 0, 2}, {4, 4, 2});
      auto global = make_box(box);
      if (refinements > 0) turn_for_refinement(global);
      auto parts = other_parts(global, comm->getSize());
      parts.push_back(partition(global, comm->getSize()));
      for (const auto& part : parts) {
        auto mesh = distribute(global, part, comm);
        if (refinements > 0) mesh = refined(*mesh, refinements);
        mesh = with_facets(mesh);
        std::map<std::pair<int, int>, int> ends;  // (intersections, borders) at both ends of owned intersections
        for (const auto& edges : junctions(*mesh)) {
          const auto lines = static_cast<int>(
              std::count_if(edges.begin(), edges.end(), [](const auto& e) { return e.is_intersection(); }));
          for (const auto& edge : edges) {
            if (edge.facet >= mesh->facets->n_owned || !edge.is_intersection()) continue;
            ++ends[{lines, static_cast<int>(edges.size()) - lines}];
            EXPECT_NEAR(norm(edge.to_point), refinements > 0 ? 0.25 : 0.5, 1e-12);
            EXPECT_EQ(edge.fractures.size(), 4u);
          }
        }
        for (const auto& [numbers, n] : ends)
          EXPECT_TRUE(numbers == std::pair(6, 0) || numbers == std::pair(2, 0) || numbers == std::pair(1, 4))
              << cell << ": " << numbers.first << ", " << numbers.second;
        std::vector<int> all = sum_over_ranks(*comm, {ends[{6, 0}], ends[{2, 0}], ends[{1, 4}]});
        const int n = 6 * (refinements > 0 ? 4 : 2);  // edges of half a line
        EXPECT_EQ(all, (std::vector<int>{6, 2 * n - 12, 6})) << cell;
      }
    }
}

TEST(Intersections, OfRefinedCells) {
  const auto comm = Tpetra::getDefaultComm();
  for (const std::string cell : {"triangle", "tetrahedron"}) {
    auto global = make_box(crossed(cell));
    const auto coarse = intersections(*make_distributed(global, comm));
    turn_for_refinement(global);
    const auto fine = intersections(*refined(*make_distributed(global, comm), 1));
    EXPECT_EQ(fine.size(), coarse.size() * (global.dim() - 1));
    EXPECT_NEAR(measure(fine), measure(coarse), 1e-12);
  }
}

}  // namespace
}  // namespace sprekk::mesh::testing
