// Small meshes and geometric measures for the tests of the mesh package.
#pragma once

#include <string>
#include <vector>

#include "base/check.hpp"
#include "mesh/box.hpp"
#include "mesh/split.hpp"

namespace sprekk::mesh::testing {

inline const std::vector<std::string> all_cells{"triangle", "quadrilateral", "tetrahedron", "hexahedron"};

inline int dim_of(const std::string& cell) { return cell == "triangle" || cell == "quadrilateral" ? 2 : 3; }

inline BoxMesh::Fracture fracture(std::vector<Real> lower, std::vector<Real> upper) {
  BoxMesh::Fracture result;
  result.lower_corner = std::move(lower);
  result.upper_corner = std::move(upper);
  return result;
}

/// Returns the box [0, n] with cells of unit size.
inline BoxMesh unit_steps(const std::string& cell, std::vector<int> n) {
  BoxMesh box;
  box.cell = cell;
  box.lower_corner.assign(n.size(), 0);
  box.upper_corner.assign(n.begin(), n.end());
  box.cells = std::move(n);
  return box;
}

/// Returns a 6 x 4 [x 2] box with three fractures: "a" is immersed, "b" crosses "a", "c" extends from "a" to the north
/// side.
inline BoxMesh crossed(const std::string& cell) {
  if (dim_of(cell) == 2) {
    auto box = unit_steps(cell, {6, 4});
    box.fractures["a"] = fracture({1, 2}, {5, 2});
    box.fractures["b"] = fracture({3, 1}, {3, 3});
    box.fractures["c"] = fracture({4, 2}, {4, 4});
    return box;
  }
  auto box = unit_steps(cell, {6, 4, 2});
  box.fractures["a"] = fracture({1, 2, 0}, {5, 2, 2});
  box.fractures["b"] = fracture({3, 1, 0}, {3, 3, 2});
  box.fractures["c"] = fracture({4, 2, 0}, {4, 4, 2});
  return box;
}

/// Returns the volume of a cell: the sum over the tetrahedra (2D: triangles) between its first node and its faces.
inline Real cell_volume(const GlobalMesh& mesh, GlobalIndex cell) {
  const int dim = mesh.dim();
  const auto x = [&](int k) { return point(mesh, mesh.cells[cell * n_nodes(mesh.shape) + k]); };
  Real volume = 0;
  for (int f = 0; f < n_faces(mesh.shape); ++f) {
    const auto nodes = face_nodes(mesh.shape)[f];
    const Vector a = x(nodes[0]) - x(0), b = x(nodes[1]) - x(0);
    if (dim == 2) volume += cross(a, b)[2] / 2;
    for (int k = 2; dim == 3 && k < n_face_nodes(mesh.shape); ++k)
      volume += dot(x(nodes[0]) - x(0), cross(x(nodes[k - 1]) - x(0), x(nodes[k]) - x(0))) / 6;
  }
  return volume;
}

inline Vector cell_centre(const GlobalMesh& mesh, GlobalIndex cell) {
  const int n = n_nodes(mesh.shape);
  Vector sum{};
  for (int k = 0; k < n; ++k) sum = sum + point(mesh, mesh.cells[cell * n + k]);
  return (1.0 / n) * sum;
}

/// Returns the unit normal of a fracture face, from minus to plus.
inline Vector normal(const GlobalMesh& mesh, const GlobalMesh::FractureFace& face) {
  const Vector area = area_vector(mesh, face.cell[minus], face.local_face[minus]);
  return (1 / norm(area)) * area;
}

/// Returns the faces whose centre satisfies `selected`, marked as `fracture` from the cell with the lower number.
template <class Predicate>
std::vector<MarkedFace> mark(const GlobalMesh& mesh, int fracture, const Predicate& selected) {
  std::vector<MarkedFace> result;
  const auto neighbour = face_neighbours(mesh);
  for (GlobalIndex face = 0; face < static_cast<GlobalIndex>(neighbour.size()); ++face) {
    const GlobalIndex cell = face / n_faces(mesh.shape);
    const int local_face = static_cast<int>(face % n_faces(mesh.shape));
    if (neighbour[face] > face && selected(face_centre(mesh, cell, local_face)))
      result.push_back({fracture, cell, local_face});
  }
  return result;
}

/// Returns the message of the Error that `work` throws; empty if there is none.
template <class Work>
std::string error_of(const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

}  // namespace sprekk::mesh::testing
