#include "mesh/subdivision.hpp"

#include <algorithm>
#include <bitset>

#include "mesh/cell_geometry.hpp"

namespace sprekk::mesh {
namespace {

/// Children at the corners of the cell. Corner i of child k is the midpoint node of the edge, face or cell spanned by
/// the corners k and i.
std::vector<std::array<int, 8>> corner_children(Shape shape) {
  const auto corners = corners_of_nodes(quadratic(shape));
  const auto size = [&](unsigned set) { return std::bitset<8>(set).count(); };
  std::vector<std::array<int, 8>> result;
  for (int k = 0; k < n_corners(shape); ++k) {
    auto& child = result.emplace_back();
    child.fill(-1);
    for (int i = 0; i < n_corners(shape); ++i)
      for (int node = 0; node < n_nodes(quadratic(shape)); ++node)
        if ((corners[node] >> k & corners[node] >> i & 1) &&
            (child[i] < 0 || size(corners[node]) < size(corners[child[i]])))
          child[i] = node;
  }
  return result;
}

/// Part of a face that is covered by a face of a child; child = -1 if the child's face lies elsewhere.
Subdivision::Part part_on(Shape shape, int face, int child, const std::array<int, 8>& nodes, int local_face) {
  const auto& all = face_nodes(quadratic(shape))[face];
  Subdivision::Part part{child, local_face, {-1, -1, -1, -1}};
  for (int i = 0; i < n_face_corners(shape); ++i) {
    const int node = nodes[face_nodes(shape)[local_face][i]];
    const auto found = std::find(all.begin(), all.begin() + n_face_nodes(quadratic(shape)), node);
    if (found == all.begin() + n_face_nodes(quadratic(shape))) part.child = -1;
    part.nodes[i] = static_cast<int>(found - all.begin());
  }
  return part;
}

std::vector<Subdivision::Part> parts_of(Shape shape, int face, const std::vector<std::array<int, 8>>& children) {
  std::vector<Subdivision::Part> result;
  for (int child = 0; child < static_cast<int>(children.size()); ++child)
    for (int f = 0; f < n_faces(shape); ++f)
      if (const auto part = part_on(shape, face, child, children[child], f); part.child >= 0) result.push_back(part);
  const auto lowest = [&](const Subdivision::Part& part) {  // corner of the face, if the part has one
    return *std::min_element(part.nodes.begin(), part.nodes.begin() + n_face_corners(shape));
  };
  std::sort(result.begin(), result.end(), [&](const auto& a, const auto& b) { return lowest(a) < lowest(b); });
  return result;
}

}  // namespace

Subdivision subdivision(Shape shape) {
  shape = linear(shape);
  Subdivision result{corner_children(shape), {}};
  const auto add = [&](std::array<int, 8> child) { result.children.push_back(child); };
  if (shape == Shape::triangle) add({3, 4, 5, -1, -1, -1, -1, -1});
  if (shape == Shape::tetrahedron)
    for (const auto& child : {std::array<int, 8>{4, 6, 7, 8, -1, -1, -1, -1},
                              {6, 5, 8, 4, -1, -1, -1, -1},
                              {6, 7, 8, 9, -1, -1, -1, -1},
                              {5, 8, 9, 6, -1, -1, -1, -1}})
      add(child);
  for (int face = 0; face < n_faces(shape); ++face) result.of_face.push_back(parts_of(shape, face, result.children));
  return result;
}

}  // namespace sprekk::mesh
