#include "mesh/bisect.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <numeric>

#include "bisected.hpp"
#include "mesh/cell_geometry.hpp"
#include "places.hpp"

namespace sprekk::mesh::testing {
namespace {

using ::testing::HasSubstr;

const std::vector<std::string> simplices{"triangle", "tetrahedron"};

using Front = std::function<Real(const Vector&)>;  ///< distance from the front

/// Bisects the cells that the front may cross, once per pass, in `times` passes.
void refine_towards(const Front& front, int times, Bisection& bisection) {
  for (int pass = 0; pass < times; ++pass) {
    const auto mesh = bisection.mesh();
    const int n = n_corners(mesh.shape);
    std::vector<GlobalIndex> marked;
    for (GlobalIndex c = 0; c < mesh.n_cells(); ++c) {
      const Vector centre = cell_centre(mesh, c);
      Real radius = 0;
      for (int k = 0; k < n; ++k) radius = std::max(radius, norm(point(mesh, mesh.cells[c * n + k]) - centre));
      if (front(centre) < 1.01 * radius) marked.push_back(c);
    }
    bisection.refine(marked);
  }
}

/// Returns the distance from a point (radius 0) or from a circle (3D).
Front ring(const Vector& middle, Real radius) {
  return [=](const Vector& x) {
    const Vector r = x - middle;
    return radius == 0 ? norm(r) : std::hypot(std::hypot(r[0], r[1]) - radius, r[2]);
  };
}

/// Returns a front around the lower corner of the first fracture, else around an inner point.
Front front_in(const BoxMesh& box) {
  Vector middle{0.6, 0.45, box.cells.size() == 2 ? 0 : 0.3};
  if (!box.fractures.empty())
    std::copy_n(box.fractures.begin()->second.lower_corner.begin(), box.cells.size(), middle.begin());
  return ring(middle, box.cells.size() == 2 ? 0 : 0.4);
}

TEST(Bisect, BeginsWithTheMeshThatItIsGiven) {
  for (const auto& cell : simplices)
    for (auto box : boxes(cell))
      for (int order : {1, 2}) {
        const Bisection bisection(make_box(box));
        auto same = box;
        same.order = order;
        EXPECT_TRUE(places_of(bisection.mesh(order)) == places_of(make_box(same))) << cell << " " << order;
      }
}

TEST(Bisect, ConformsAndKeepsRegionsBoundariesAndFractures) {
  for (const auto& cell : simplices)
    for (const auto& box : boxes(cell)) {
      const auto coarse = make_box(box);
      Bisection bisection(coarse);
      refine_towards(front_in(box), 7, bisection);
      const auto fine = bisection.mesh();
      EXPECT_GT(fine.n_cells(), coarse.n_cells() + 5);
      EXPECT_EQ(fine.n_cells(), bisection.n_cells());
      expect_conforming(fine);
      const auto sizes = sizes_of(fine);
      for (const auto& [name, size] : sizes_of(coarse))
        for (int i = 0; i < 4; ++i) EXPECT_NEAR(sizes.at(name)[i], size[i], 1e-10) << cell << " " << name;
      if (coarse.dim() == 2) {  // no fracture became longer or was divided
        EXPECT_EQ(n_tips(fine), n_tips(coarse));
      }
    }
}

/// Returns a box of 3 steps with displaced inner nodes.
GlobalMesh shaken(GlobalMesh mesh) {
  const int dim = mesh.dim();
  for (GlobalIndex node = 0; node < mesh.n_nodes(); ++node) {
    auto* const x = &mesh.coordinates[node * dim];
    if (std::any_of(x, x + dim, [](Real c) { return c == 0 || c == 3; })) continue;
    for (int i = 0; i < dim; ++i) x[i] += 0.15 * std::sin(12.9 * static_cast<Real>(node) + 78.2 * i);
  }
  return mesh;
}

/// Bisection towards a front produces a bounded number of shapes: the worst shape occurs in the first 6 passes.
TEST(Bisect, KeepsShapesTowardsAFront) {
  for (const auto& cell : simplices) {
    const auto box = unit_steps(cell, std::vector<int>(dim_of(cell), 3));
    const auto mesh = shaken(make_box(box));
    const CellGeometry geometry(mesh.shape);
    const auto worst = [&](const GlobalMesh& of) {
      Real minimum = 1;
      for (GlobalIndex c = 0; c < of.n_cells(); ++c) minimum = std::min(minimum, geometry.scaled_jacobian(of, c)[0]);
      return minimum;
    };
    Bisection bisection(mesh);
    refine_towards(front_in(box), 6, bisection);
    const Real early = worst(bisection.mesh());
    refine_towards(front_in(box), 12, bisection);
    const auto fine = bisection.mesh();
    expect_conforming(fine);
    EXPECT_GT(early, 0.25 * worst(mesh)) << cell;
    EXPECT_GT(worst(fine), 0.99 * early) << cell;
  }
}

/// Compresses the mesh along the diagonal until each cell has several longest edges.
GlobalMesh pressed(GlobalMesh mesh) {
  const int dim = mesh.dim();
  const Real less = (1 - (dim == 2 ? std::sqrt(1.0 / 3) : 0.5)) / dim;
  for (auto x = mesh.coordinates.begin(); x != mesh.coordinates.end(); x += dim) {
    const Real sum = std::accumulate(x, x + dim, Real{0});
    for (int i = 0; i < dim; ++i) x[i] -= less * sum;
  }
  return mesh;
}

/// Rotates the local node numbers of every second cell.
GlobalMesh turned(GlobalMesh mesh) {
  const int n = n_corners(mesh.shape);
  for (GlobalIndex c = 0; c < mesh.n_cells(); c += 2)
    std::rotate(&mesh.cells[c * n], &mesh.cells[c * n] + 1, &mesh.cells[c * n] + 3);
  const auto turn = [](GlobalIndex cell, int& face) {
    if (cell % 2 == 0 && face < 3) face = (face + 2) % 3;
  };
  for (auto& face : mesh.boundary_faces) turn(face.cell, face.local_face);
  for (auto& face : mesh.fracture_faces)
    for (int side : {minus, plus}) turn(face.cell[side], face.local_face[side]);
  return mesh;
}

/// The choice between edges of equal length, too, depends on coordinates only.
TEST(Bisect, DoesNotDependOnNumbers) {
  for (const auto& cell : simplices)
    for (auto box : boxes(cell)) {
      Bisection bisection(pressed(make_box(box)));
      box.renumbering_seed = 5;
      Bisection other(turned(pressed(make_box(box))));
      for (auto* one : {&bisection, &other}) refine_towards(front_in(box), 5, *one);
      EXPECT_TRUE(places_of(bisection.mesh()) == places_of(other.mesh())) << cell;
    }
}

/// As many bisections as dimensions halve the width of a cell. Both sides cut a face equally, so no cell needs more
/// bisections. Cells of boxes keep their shape.
TEST(Bisect, HalvesChildrenToo) {
  for (const auto& cell : simplices)
    for (const bool shakes : {false, true}) {
      auto mesh = make_box(unit_steps(cell, std::vector<int>(dim_of(cell), 3)));
      if (shakes) mesh = shaken(mesh);
      std::vector<GlobalIndex> all(mesh.n_cells());
      std::iota(all.begin(), all.end(), GlobalIndex{0});
      Bisection bisection(mesh);
      bisection.refine(all, mesh.dim());
      EXPECT_EQ(bisection.n_cells(), mesh.n_cells() << mesh.dim()) << cell << " " << shakes;
      expect_conforming(bisection.mesh());
      if (!shakes) {
        EXPECT_EQ(shapes_of(bisection.mesh()), shapes_of(mesh)) << cell;
      }
    }
}

/// The cells with the same parent have its volume and region, and the first moments of the volume.
TEST(Bisect, ReturnsTheParents) {
  for (const auto& cell : simplices) {
    const auto mesh = shaken(make_box(unit_steps(cell, std::vector<int>(dim_of(cell), 3))));
    Bisection bisection(mesh);
    const auto parent = bisection.refine({0, 1, 5}, 2);
    const auto fine = bisection.mesh();
    ASSERT_EQ(static_cast<GlobalIndex>(parent.size()), fine.n_cells());
    std::vector<Real> volume(mesh.n_cells(), 0);
    std::vector<Vector> moment(mesh.n_cells());
    for (GlobalIndex c = 0; c < fine.n_cells(); ++c) {
      volume[parent[c]] += cell_volume(fine, c);
      moment[parent[c]] = moment[parent[c]] + cell_volume(fine, c) * cell_centre(fine, c);
      EXPECT_EQ(fine.cell_region[c], mesh.cell_region[parent[c]]);
    }
    for (GlobalIndex c = 0; c < mesh.n_cells(); ++c) {
      EXPECT_NEAR(volume[c], cell_volume(mesh, c), 1e-13);
      EXPECT_LT(norm(moment[c] - cell_volume(mesh, c) * cell_centre(mesh, c)), 1e-12);
    }
  }
}

TEST(Bisect, RefusesOtherCells) {
  const auto of = [](BoxMesh box) { return error_of([&] { Bisection{make_box(box)}; }); };
  EXPECT_THAT(of(unit_steps("hexahedron", {2, 2, 2})), HasSubstr("needs triangles or tetrahedra"));
  auto tied = unit_steps("triangle", {3, 3});
  tied.periodic = {"x"};
  EXPECT_THAT(of(tied), HasSubstr("without periodic sides"));
}

}  // namespace
}  // namespace sprekk::mesh::testing
