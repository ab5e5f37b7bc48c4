#include "mesh/raise_order.hpp"

#include "base/check.hpp"

#include <algorithm>
#include <array>
#include <unordered_map>

namespace sprekk::mesh {
namespace {

using Corners = std::array<GlobalIndex, 4>;  ///< sorted; unused entries are -1 and come first

struct Hash {
  std::size_t operator()(const Corners& corners) const {
    std::size_t h = 0;
    for (GlobalIndex corner : corners) h = (h ^ static_cast<std::size_t>(corner + 1)) * 0x9e3779b97f4a7c15ULL;
    return h ^ (h >> 29);
  }
};

/// Returns for each added node the corners whose mean is this node. The result is derived from the node lists of faces,
/// so only one table defines the numbers.
std::vector<std::vector<int>> parents(Shape shape) {
  const int n_added = n_nodes(shape) - n_corners(shape), n_around = n_face_corners(shape);
  std::vector<std::vector<int>> result(n_added);
  const auto faces = face_nodes(shape);
  for (int f = 0; f < n_faces(shape); ++f) {
    const int n_edges = dimension(shape) == 2 ? 1 : n_around;
    for (int k = 0; k < n_edges; ++k)
      result[faces[f][n_around + k] - n_corners(shape)] = {faces[f][k], faces[f][(k + 1) % n_around]};
    if (n_face_nodes(shape) == 9) result[faces[f][8] - n_corners(shape)] = {faces[f].begin(), faces[f].begin() + 4};
  }
  if (!is_simplex(shape))
    for (int k = 0; k < n_corners(shape); ++k) result.back().push_back(k);
  return result;
}

}  // namespace

GlobalMesh raise_order(GlobalMesh mesh) {
  SPREKK_CHECK(order(mesh.shape) == 1 && mesh.fracture_faces.empty(), "raise order: needs an unsplit mesh of order 1");
  const int n_before = n_nodes(mesh.shape), dim = mesh.dim();
  mesh.shape = quadratic(mesh.shape);
  const auto added = parents(mesh.shape);
  std::unordered_map<Corners, GlobalIndex, Hash> known;
  std::vector<GlobalIndex> cells;
  cells.reserve(mesh.n_cells() * n_nodes(mesh.shape));
  for (GlobalIndex cell = 0; cell < mesh.n_cells(); ++cell) {
    const auto* corner = &mesh.cells[cell * n_before];
    cells.insert(cells.end(), corner, corner + n_before);
    for (const auto& of : added) {
      Corners key{-1, -1, -1, -1};
      const bool is_inside = of.size() == static_cast<std::size_t>(n_before) && !is_simplex(mesh.shape);
      for (std::size_t k = 0; k < of.size() && k < 4; ++k) key[k] = corner[of[k]];
      std::sort(key.begin(), key.end());
      const auto id = mesh.n_nodes();
      const auto [found, is_new] = is_inside ? std::make_pair(known.end(), true) : known.emplace(key, id);
      cells.push_back(is_inside ? id : found->second);
      if (!is_new) continue;
      for (int i = 0; i < dim; ++i) {
        Real sum = 0;
        for (int k : of) sum += mesh.coordinates[corner[k] * dim + i];
        mesh.coordinates.push_back(sum / static_cast<Real>(of.size()));
      }
    }
  }
  mesh.cells = std::move(cells);
  return mesh;
}

}  // namespace sprekk::mesh
