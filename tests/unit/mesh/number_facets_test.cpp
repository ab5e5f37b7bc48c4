#include "mesh/number_facets.hpp"

#include <gtest/gtest.h>

#include <Teuchos_CommHelpers.hpp>
#include <Tpetra_Core.hpp>

#include <algorithm>
#include <cmath>

#include "mesh/distribute.hpp"
#include "mesh/facets.hpp"
#include "mesh/periodic.hpp"
#include "mesh/refine.hpp"
#include "meshes.hpp"

namespace sprekk::mesh::testing {
namespace {

/// Returns the sum over all ranks. Collective.
template <class T>
std::vector<T> total(const Comm& comm, const std::vector<T>& here) {
  std::vector<T> all(here.size());
  Teuchos::reduceAll(comm, Teuchos::REDUCE_SUM, static_cast<int>(here.size()), here.data(), all.data());
  return all;
}

/// Numbers the facets of a mesh. Checks that each facet has one owner and equal coordinates on all ranks. Returns the
/// centres by number. With tied sides, only owned cells and faces are compared. Collective.
std::vector<Vector> places(const GlobalMesh& global, bool tied = false, int refinements = 0) {
  const auto comm = Tpetra::getDefaultComm();
  RCP<const Mesh> mesh = make_distributed(global, comm);
  if (refinements > 0) mesh = refined(*mesh, refinements);
  mesh = with_facets(mesh);
  const auto& facets = *mesh->facets;
  const auto n = total<long long>(*comm, {facets.n_owned})[0];
  std::vector<int> owners(n, 0);
  for (LocalIndex k = 0; k < facets.n_owned; ++k) ++owners.at(facets.id[k]);
  EXPECT_EQ(total(*comm, owners), std::vector<int>(n, 1));
  const int n_faces = mesh::n_faces(mesh->shape), n_ridges = n_face_corners(mesh->shape);
  std::vector<Real> sums(3 * n, 0), times(n, 0);
  const auto each = [&](LocalIndex n_cells, LocalIndex n_fracture_faces, const auto& work) {
    for (LocalIndex face = 0; face < n_cells * n_faces; ++face)
      work(facets.id.at(facets.of_cell.at(face)), face_centre(face_corners(*mesh, face / n_faces, face % n_faces)));
    for (LocalIndex ridge = 0; ridge < n_fracture_faces * n_ridges; ++ridge)
      work(facets.id.at(facets.ridge.at(ridge)), ridge_centre(*mesh, ridge / n_ridges, ridge % n_ridges));
    for (LocalIndex face = 0; face < n_fracture_faces; ++face)
      work(facets.id.at(facets.fracture_face.at(face)), mesh->fracture_faces[face].centre);
  };
  each(mesh->n_owned_cells, mesh->n_owned_fracture_faces, [&](GlobalIndex id, const Vector& x) {
    for (int i = 0; i < 3; ++i) sums.at(3 * id + i) += x[i];
    ++times.at(id);
  });
  sums = total(*comm, sums);
  times = total(*comm, times);
  std::vector<Vector> result;
  for (long long k = 0; k < n; ++k) {
    EXPECT_GE(times[k], 1);
    result.push_back((1 / times[k]) * Vector{sums[3 * k], sums[3 * k + 1], sums[3 * k + 2]});
  }
  each(tied ? 0 : mesh->n_cells(), mesh->n_fracture_faces(),
       [&](GlobalIndex id, const Vector& x) { EXPECT_LT(norm(x - result.at(id)), 1e-14); });
  return result;
}

/// Returns a box with two fractures of 4 and 2 steps; the longer one crosses all of the shorter one. In 3D both extend
/// two steps in the third direction.
GlobalMesh crossing(const std::string& cell) {
  const bool flat = dim_of(cell) == 2;
  auto box = unit_steps(cell, flat ? std::vector<int>{4, 4} : std::vector<int>{4, 4, 2});
  box.fractures["a"] = flat ? fracture({0, 2}, {4, 2}) : fracture({0, 2, 0}, {4, 2, 2});
  box.fractures["b"] = flat ? fracture({2, 1}, {2, 3}) : fracture({2, 1, 0}, {2, 3, 2});
  return make_box(box);
}

TEST(NumberFacets, OneBetweenCellsOneForAFractureFaceOneForEachRidge) {
  for (const auto& cell : all_cells) {
    const bool flat = dim_of(cell) == 2;
    auto box = unit_steps(cell, flat ? std::vector<int>{4, 4} : std::vector<int>{4, 4, 2});
    const auto plain = make_box(box);
    const std::size_t n = (plain.n_cells() * mesh::n_faces(plain.shape) + plain.boundary_faces.size()) / 2;
    EXPECT_EQ(places(plain).size(), n) << cell;
    const std::size_t diagonals = cell == "tetrahedron" ? 6 * 2 : 0;
    const std::size_t n_ridges = flat ? 5 + 3 - 1 : 4 * 3 + 5 * 2 + 2 * 3 + 3 * 2 - 2 + diagonals;
    EXPECT_EQ(places(crossing(cell)).size(), n + n_ridges) << cell;
  }
}

/// A mesh refined on the ranks has the facets of the fine box.
TEST(NumberFacets, RefinedFracturesKeepTheirRidges) {
  for (const auto& cell : all_cells) {
    if (cell == "tetrahedron") continue;  // tetrahedra: refinement does not give the cells of a finer box
    const bool flat = dim_of(cell) == 2;
    auto box = unit_steps(cell, flat ? std::vector<int>{8, 8} : std::vector<int>{8, 8, 4});
    box.fractures["a"] = flat ? fracture({0, 4}, {8, 4}) : fracture({0, 4, 0}, {8, 4, 4});
    box.fractures["b"] = flat ? fracture({4, 2}, {4, 6}) : fracture({4, 2, 0}, {4, 6, 4});
    const auto sorted = [](std::vector<Vector> x, Real scale) {
      for (auto& one : x)
        for (Real& value : one) value = std::round(scale * value * 1e6) + 0.0;
      std::sort(x.begin(), x.end());
      return x;
    };
    EXPECT_EQ(sorted(places(crossing(cell), false, 1), 2), sorted(places(make_box(box)), 1)) << cell;
  }
  EXPECT_GT(places(crossing("tetrahedron"), false, 1).size(), 0u);
}

/// Rims on the boundary: in 2D both ends of the longer fracture; in 3D its lateral edges, and top and bottom of both
/// fractures.
TEST(NumberFacets, FindsWhereFracturesEndOnTheBoundary) {
  for (const auto& cell : all_cells) {
    const auto mesh = with_facets(make_distributed(crossing(cell), Tpetra::getDefaultComm()));
    std::vector<int> counts(6, 0);
    for (const auto& rim : mesh->facets->rims) {
      const auto x = ridge_centre(*mesh, rim.face, rim.ridge);
      const auto& side = mesh->boundary_names[rim.boundary];
      EXPECT_TRUE((side == "west" && x[0] == 0) || (side == "east" && x[0] == 4) || (side == "bottom" && x[2] == 0) ||
                  (side == "top" && x[2] == 2))
          << cell << ' ' << side;
      if (rim.face < mesh->n_owned_fracture_faces) ++counts[rim.boundary];
    }
    const auto all = total(*mesh->comm, counts);
    const auto of = [&](const std::string& side) {
      const auto found = std::find(mesh->boundary_names.begin(), mesh->boundary_names.end(), side);
      return all[found - mesh->boundary_names.begin()];
    };
    const bool flat = dim_of(cell) == 2;
    EXPECT_EQ(of("west"), flat ? 1 : 2) << cell;
    EXPECT_EQ(of("east"), flat ? 1 : 2) << cell;
    EXPECT_EQ(of("top"), flat ? 0 : 6) << cell;
    EXPECT_EQ(of("north"), 0) << cell;
  }
}

TEST(NumberFacets, CellsAcrossATiedSideShareOne) {
  for (unsigned n : {1, 2, 3})
    for (const char* cell : {"quadrilateral", "triangle"}) {
      auto mesh = make_box(unit_steps(cell, {static_cast<int>(n), 2}));
      mesh = tie_periodic(mesh, {{"west", "east"}});
      const unsigned diagonals = cell[0] == 't' ? 2 * n : 0;
      EXPECT_EQ(places(mesh, true).size(), 2 * n + 3 * n + diagonals) << cell << ' ' << n;
    }
}

}  // namespace
}  // namespace sprekk::mesh::testing
