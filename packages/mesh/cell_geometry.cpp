#include "mesh/cell_geometry.hpp"

#include <algorithm>

namespace sprekk::mesh {
namespace {

/// Other ends of the edges from a corner, in right-handed order.
std::array<int, 3> adjacent_corners(Shape shape, int corner) {
  constexpr int tetrahedron[][3] = {{1, 2, 3}, {2, 0, 3}, {0, 1, 3}, {0, 2, 1}};
  constexpr int hexahedron[][3] = {{1, 3, 4}, {2, 0, 5}, {3, 1, 6}, {0, 2, 7},
                                   {7, 5, 0}, {4, 6, 1}, {5, 7, 2}, {6, 4, 3}};
  const int n = n_corners(shape);
  if (dimension(shape) == 2) return {(corner + 1) % n, (corner + n - 1) % n, -1};
  const int* result = is_simplex(shape) ? tetrahedron[corner] : hexahedron[corner];
  return {result[0], result[1], result[2]};
}

unsigned bits(const int* corners, int n) {
  unsigned result = 0;
  for (int k = 0; k < n; ++k) result |= 1u << corners[k];
  return result;
}

}  // namespace

std::vector<unsigned> corners_of_nodes(Shape shape) {
  const int n_around = n_face_corners(shape), n = n_nodes(shape);
  std::vector<unsigned> result(n, (1u << n_corners(shape)) - 1);  // nodes on no face are inside
  for (int k = 0; k < n_corners(shape); ++k) result[k] = 1u << k;
  if (order(shape) == 1) return result;
  const CellGeometry geometry(shape);
  for (const auto& edge : geometry.edges()) result[edge.middle] = 1u << edge.from | 1u << edge.to;
  for (const auto& face : face_nodes(shape))
    if (n_face_nodes(shape) == 9) result[face[8]] = bits(face.data(), n_around);
  return result;
}

std::vector<int> mirrored_nodes(Shape shape) {
  const std::vector<int> corners = dimension(shape) == 2
                                       ? is_simplex(shape) ? std::vector<int>{0, 2, 1} : std::vector<int>{0, 3, 2, 1}
                                   : is_simplex(shape) ? std::vector<int>{0, 2, 1, 3}
                                                       : std::vector<int>{0, 3, 2, 1, 4, 7, 6, 5};
  const auto sets = corners_of_nodes(shape);
  std::vector<int> result;
  for (unsigned set : sets) {
    unsigned image = 0;
    for (int k = 0; k < n_corners(shape); ++k)
      if (set >> k & 1) image |= 1u << corners[k];
    result.push_back(static_cast<int>(std::find(sets.begin(), sets.end(), image) - sets.begin()));
  }
  return result;
}

CellGeometry::CellGeometry(Shape shape) : shape_(shape) {
  const auto faces = face_nodes(shape);
  const int n_around = n_face_corners(shape), n_edges = dimension(shape) == 2 ? 1 : n_around;
  for (int f = 0; f < n_faces(shape); ++f)
    for (int k = 0; k < n_edges; ++k) {
      const auto [a, b] = std::minmax(faces[f][k], faces[f][(k + 1) % n_around]);
      const Edge edge{a, b, order(shape) == 1 ? -1 : faces[f][n_around + k]};
      if (std::none_of(edges_.begin(), edges_.end(),
                       [&](const Edge& e) { return e.from == edge.from && e.to == edge.to; }))
        edges_.push_back(edge);
    }
}

std::array<Real, 2> CellGeometry::scaled_jacobian(const GlobalMesh& mesh, GlobalIndex cell) const {
  const int dim = dimension(shape_);
  const auto x = [&](int k) { return point(mesh, mesh.cells[cell * n_nodes(shape_) + k]); };
  const auto tangent = [&](int from, int to) {
    if (order(shape_) == 1) return x(to) - x(from);
    const auto edge = std::find_if(edges_.begin(), edges_.end(), [&](const Edge& e) {
      return e.from == std::min(from, to) && e.to == std::max(from, to);
    });
    const Vector chord = x(to) - x(from), start = 4.0 * x(edge->middle) - 3.0 * x(from) - x(to);
    return norm(start) > 1e-6 * norm(chord) ? start : chord;  // the tangent at a quarter-point node is 0
  };
  const auto unit = [](const Vector& v) { return norm(v) > 0 ? (1 / norm(v)) * v : Vector{}; };
  const Real regular = !is_simplex(shape_) ? 1 : dim == 2 ? 2 / std::sqrt(3.0) : std::sqrt(2.0);
  std::array<Real, 2> result{1e300, -1e300};
  for (int k = 0; k < n_corners(shape_); ++k) {
    const auto next = adjacent_corners(shape_, k);
    const Vector normal = cross(unit(tangent(k, next[0])), unit(tangent(k, next[1])));
    const Real value = regular * (dim == 2 ? normal[2] : dot(normal, unit(tangent(k, next[2]))));
    result = {std::min(result[0], value), std::max(result[1], value)};
  }
  return result;
}

Real CellGeometry::volume(const GlobalMesh& mesh, GlobalIndex cell) const {
  const Vector origin = point(mesh, mesh.cells[cell * n_nodes(shape_)]);
  Real sum = 0;
  for (int f = 0; f < n_faces(shape_); ++f)  // by the divergence theorem
    sum += dot(area_vector(mesh, cell, f), face_centre(mesh, cell, f) - origin);
  return sum / dimension(shape_);
}

}  // namespace sprekk::mesh
