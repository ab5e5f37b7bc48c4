#include "mesh/number_facets.hpp"

#include <gtest/gtest.h>

#include <Teuchos_CommHelpers.hpp>
#include <Tpetra_Core.hpp>

#include "mesh/distribute.hpp"
#include "mesh/facets.hpp"
#include "mesh/periodic.hpp"
#include "meshes.hpp"

namespace sprekk::mesh::testing {
namespace {

/// The sum over all ranks.
template <class T>
std::vector<T> total(const Comm& comm, const std::vector<T>& here) {
  std::vector<T> all(here.size());
  Teuchos::reduceAll(comm, Teuchos::REDUCE_SUM, static_cast<int>(here.size()), here.data(), all.data());
  return all;
}

/// Numbers the facets of a mesh, and checks that each is owned once and lies in one place on all ranks. Returns the
/// places in the order of the numbers. Where sides are tied, of the cells of one of them.
std::vector<Vector> places(const GlobalMesh& global, bool tied = false) {
  const auto comm = Tpetra::getDefaultComm();
  const auto mesh = with_facets(make_distributed(global, comm));
  const auto& facets = *mesh->facets;
  const auto n = total<long long>(*comm, {facets.n_owned})[0];
  std::vector<int> owners(n, 0);
  for (LocalIndex k = 0; k < facets.n_owned; ++k) ++owners.at(facets.id[k]);
  EXPECT_EQ(total(*comm, owners), std::vector<int>(n, 1));
  const int n_faces = mesh::n_faces(mesh->shape);
  std::vector<Real> sums(3 * n, 0), cells(n, 0);
  const auto each = [&](LocalIndex n_cells, const auto& work) {
    for (LocalIndex face = 0; face < n_cells * n_faces; ++face)
      work(facets.id.at(facets.of_cell.at(face)), face_centre(face_corners(*mesh, face / n_faces, face % n_faces)));
  };
  each(mesh->n_owned_cells, [&](GlobalIndex id, const Vector& x) {
    for (int i = 0; i < 3; ++i) sums.at(3 * id + i) += x[i];
    ++cells.at(id);
  });
  sums = total(*comm, sums);
  cells = total(*comm, cells);
  std::vector<Vector> result;
  for (long long k = 0; k < n; ++k) {
    EXPECT_TRUE(cells[k] == 1 || cells[k] == 2);
    result.push_back((1 / cells[k]) * Vector{sums[3 * k], sums[3 * k + 1], sums[3 * k + 2]});
  }
  each(tied ? 0 : mesh->n_cells(), [&](GlobalIndex id, const Vector& x) { EXPECT_LT(norm(x - result.at(id)), 1e-14); });
  return result;
}

TEST(NumberFacets, OneBetweenCellsAndOneOnEachSideOfAFracture) {
  for (const auto& cell : all_cells) {
    const bool flat = dim_of(cell) == 2;
    auto box = unit_steps(cell, flat ? std::vector<int>{4, 3} : std::vector<int>{4, 3, 2});
    const auto plain = make_box(box);
    const auto n_boundary = static_cast<std::size_t>(plain.boundary_faces.size());
    const std::size_t n_faces = plain.n_cells() * mesh::n_faces(plain.shape);
    EXPECT_EQ(places(plain).size(), (n_faces + n_boundary) / 2) << cell;
    box.fractures["a"] = flat ? fracture({1, 1}, {3, 1}) : fracture({1, 1, 0}, {3, 1, 2});
    const auto split = make_box(box);
    EXPECT_EQ(places(split).size(), (n_faces + n_boundary) / 2 + split.fracture_faces.size()) << cell;
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
