// Comparison of meshes by coordinates instead of numbers.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "mesh/cell_geometry.hpp"
#include "mesh/tips.hpp"
#include "meshes.hpp"

namespace sprekk::mesh::testing {

/// Boxes whose fractures cross, or end at each other, at the boundary or in the rock; one face has tips all around.
inline std::vector<BoxMesh> boxes(const std::string& cell) {
  const bool flat = dim_of(cell) == 2;
  std::vector<BoxMesh> result{crossed(cell),
                              unit_steps(cell, flat ? std::vector<int>{3, 3} : std::vector<int>{3, 3, 2}),
                              unit_steps(cell, flat ? std::vector<int>{4, 2} : std::vector<int>{4, 4, 2})};
  result.push_back(unit_steps(cell, std::vector<int>(dim_of(cell), 1)));  // fewer cells than ranks
  result[0].rotation = 20;
  result[1].fractures["one face"] = flat ? fracture({1, 1}, {2, 1}) : fracture({1, 1, 1}, {2, 2, 1});
  result[1].regions["low"] = flat ? BoxMesh::Region{{0, 0}, {3, 1}} : BoxMesh::Region{{0, 0, 0}, {3, 3, 1}};
  result[2].fractures["through"] = flat ? fracture({0, 1}, {4, 1}) : fracture({0, 2, 0}, {4, 2, 2});
  result[2].fractures["square"] = flat ? fracture({2, 0}, {2, 1}) : fracture({1, 1, 1}, {3, 3, 1});
  return result;
}

/// Number of occurrences of each node, tip, cell and face (with its fracture or boundary), identified by coordinates.
using Places = std::map<std::vector<long long>, int>;

inline Places places_of(const GlobalMesh& mesh, bool with_cells = true) {
  enum Kind { a_node, a_tip, a_cell, a_boundary, a_minus_side, a_plus_side };
  using Key = std::vector<long long>;
  Places result;
  const auto key_of = [](const Vector& x) {
    return Key{std::llround(1e6 * x[0]), std::llround(1e6 * x[1]), std::llround(1e6 * x[2])};
  };
  const auto add = [&](Kind kind, long long group, const Vector& direction, const auto* nodes, int n) {
    std::vector<Key> keys{};
    for (int k = 0; k < n; ++k) keys.push_back(key_of(point(mesh, nodes[k])));
    std::sort(keys.begin(), keys.end());
    keys.push_back(key_of(direction));
    Key all{kind, group};
    for (const auto& key : keys) all.insert(all.end(), key.begin(), key.end());
    ++result[all];
  };
  const auto is_tip = tip_nodes(mesh);
  for (GlobalIndex node = 0; node < mesh.n_nodes(); ++node) {
    add(a_node, 0, {}, &node, 1);
    if (is_tip[node]) add(a_tip, 0, {}, &node, 1);
  }
  const int n = n_nodes(mesh.shape), n_around = n_face_nodes(mesh.shape);
  for (GlobalIndex c = 0; c < mesh.n_cells() && with_cells; ++c)
    add(a_cell, mesh.cell_region[c], {}, &mesh.cells[c * n], n);
  for (const auto& face : mesh.boundary_faces)
    add(a_boundary, face.boundary, {}, nodes_of_face(mesh, face.cell, face.local_face).data(), n_around);
  for (const auto& face : mesh.fracture_faces)
    for (int side : {minus, plus})
      add(side == minus ? a_minus_side : a_plus_side, face.fracture, normal(mesh, face),
          nodes_of_face(mesh, face.cell[side], face.local_face[side]).data(), n_around);
  return result;
}

/// Returns the shapes of the cells: sorted edge lengths, divided by volume^(1/dim).
inline std::set<std::vector<long long>> shapes_of(const GlobalMesh& mesh) {
  const CellGeometry geometry(mesh.shape);
  std::set<std::vector<long long>> result;
  for (GlobalIndex c = 0; c < mesh.n_cells(); ++c) {
    const auto x = [&](int k) { return point(mesh, mesh.cells[c * n_nodes(mesh.shape) + k]); };
    std::vector<long long> lengths;
    for (const auto& edge : geometry.edges())
      lengths.push_back(
          std::llround(1e6 * norm(x(edge.to) - x(edge.from)) / std::pow(geometry.volume(mesh, c), 1.0 / mesh.dim())));
    std::sort(lengths.begin(), lengths.end());
    result.insert(lengths);
  }
  return result;
}

}  // namespace sprekk::mesh::testing
