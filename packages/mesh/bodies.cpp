#include "mesh/bodies.hpp"

#include <utility>

#include "mesh/facets.hpp"
#include "mesh/union_find.hpp"

namespace sprekk::mesh {

namespace {

UnionFind joined_through_faces(const GlobalMesh& mesh) {
  UnionFind sets(mesh.n_cells());
  const auto across = face_neighbours(mesh);
  for (GlobalIndex face = 0; face < static_cast<GlobalIndex>(across.size()); ++face)
    if (across[face] > face) sets.join(face / n_faces(mesh.shape), across[face] / n_faces(mesh.shape));
  return sets;
}

Bodies bodies_of(const GlobalMesh& mesh, UnionFind sets) {
  Bodies bodies;
  for (GlobalIndex cell = 0; cell < mesh.n_cells(); ++cell) {
    const GlobalIndex lowest = sets.find(cell);
    bodies.of_cell.push_back(lowest == cell ? bodies.n() : bodies.of_cell[lowest]);
    if (lowest == cell) bodies.n_cells.push_back(0);
    ++bodies.n_cells[bodies.of_cell[cell]];
  }
  return bodies;
}

}  // namespace

Bodies find_bodies(const GlobalMesh& mesh) {
  auto sets = joined_through_faces(mesh);
  for (const auto& face : mesh.fracture_faces) sets.join(face.cell[minus], face.cell[plus]);
  return bodies_of(mesh, std::move(sets));
}

Bodies find_pieces(const GlobalMesh& mesh) { return bodies_of(mesh, joined_through_faces(mesh)); }

}  // namespace sprekk::mesh
