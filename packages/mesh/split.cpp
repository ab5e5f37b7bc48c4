#include "mesh/split.hpp"

#include <algorithm>
#include <numeric>
#include <unordered_map>

#include "base/check.hpp"
#include "mesh/union_find.hpp"

namespace sprekk::mesh {
namespace {

using FractureFaces = std::vector<GlobalMesh::FractureFace>;

/// Marked faces with their two cells, each face once. Throws an Error for faces on the boundary or in two fractures.
FractureFaces two_sided(const GlobalMesh& mesh, const std::vector<MarkedFace>& marked,
                        const std::vector<GlobalIndex>& neighbour) {
  const int faces_per_cell = n_faces(mesh.shape);
  FractureFaces faces;
  std::vector<bool> has_face(mesh.fracture_names.size(), false);
  std::unordered_map<GlobalIndex, int> fracture_of_face;
  for (const auto& mark : marked) {
    const auto& name = mesh.fracture_names.at(mark.fracture);
    const GlobalIndex face = mark.cell * faces_per_cell + mark.local_face, other = neighbour[face];
    SPREKK_CHECK(other >= 0,
                 "fracture \"{}\": face {} of cell {} lies on the boundary; a fracture needs a cell on each side", name,
                 mark.local_face, mark.cell);
    const auto [known, is_new] = fracture_of_face.emplace(std::min(face, other), mark.fracture);
    SPREKK_CHECK(known->second == mark.fracture,
                 "fractures \"{}\" and \"{}\" overlap: both contain face {} of cell {}; a face belongs to one fracture",
                 mesh.fracture_names[known->second], name, mark.local_face, mark.cell);
    if (!is_new) continue;
    has_face[mark.fracture] = true;
    faces.push_back({mark.fracture,
                     {mark.cell, other / faces_per_cell},
                     {mark.local_face, static_cast<int>(other % faces_per_cell)},
                     mesh.single_fractures.empty() ? mark.fracture : mark.single});
  }
  for (std::size_t f = 0; f < has_face.size(); ++f)
    SPREKK_CHECK(has_face[f], "fracture \"{}\": has no interior face", mesh.fracture_names[f]);
  return faces;
}

/// Copies fracture nodes. Each set of cells at a node that is connected through unmarked faces gets its own copy.
void split_nodes(GlobalMesh& mesh) {
  const auto neighbour = face_neighbours(mesh);
  const int faces_per_cell = n_faces(mesh.shape), nodes_per_cell = n_nodes(mesh.shape), dim = mesh.dim();
  std::vector<bool> is_fracture_face(neighbour.size(), false), on_fracture(mesh.n_nodes(), false);
  for (const auto& face : mesh.fracture_faces)
    for (int side : {minus, plus}) {
      is_fracture_face[face.cell[side] * faces_per_cell + face.local_face[side]] = true;
      for (GlobalIndex node : nodes_of_face(mesh, face.cell[side], face.local_face[side]))
        if (node >= 0) on_fracture[node] = true;
    }

  const auto corner_of = [&](GlobalIndex cell, GlobalIndex node) {
    const auto first = mesh.cells.begin() + cell * nodes_per_cell;
    return std::find(first, first + nodes_per_cell, node) - mesh.cells.begin();
  };
  UnionFind sets(static_cast<GlobalIndex>(mesh.cells.size()));  // sets of cell corners [cell * n_nodes + local node]
  for (GlobalIndex face = 0; face < static_cast<GlobalIndex>(neighbour.size()); ++face) {
    if (neighbour[face] < face || is_fracture_face[face]) continue;
    const GlobalIndex cell = face / faces_per_cell, other = neighbour[face] / faces_per_cell;
    for (GlobalIndex node : nodes_of_face(mesh, cell, static_cast<int>(face % faces_per_cell)))
      if (node >= 0 && on_fracture[node]) sets.join(corner_of(cell, node), corner_of(other, node));
  }

  std::vector<bool> is_taken(mesh.n_nodes(), false);
  for (GlobalIndex corner = 0; corner < static_cast<GlobalIndex>(mesh.cells.size()); ++corner) {
    const GlobalIndex node = mesh.cells[corner], representative = sets.find(corner);
    if (representative < corner) {
      mesh.cells[corner] = mesh.cells[representative];
    } else if (on_fracture[node] && is_taken[node]) {
      mesh.cells[corner] = mesh.n_nodes();
      mesh.parent_node.push_back(node);
      for (int i = 0; i < dim; ++i) mesh.coordinates.push_back(mesh.coordinates[node * dim + i]);
    } else {
      is_taken[node] = true;
    }
  }
}

}  // namespace

GlobalMesh split(GlobalMesh mesh, const std::vector<MarkedFace>& marked, const std::vector<Orientation>& orientations) {
  SPREKK_CHECK(mesh.fracture_faces.empty(), "split: the mesh has fracture faces already; it must be unsplit");
  SPREKK_CHECK(orientations.empty() || orientations.size() == mesh.fracture_names.size(),
               "split: {} orientations for {} fractures; needs one each", orientations.size(),
               mesh.fracture_names.size());
  if (!mesh.fracture_names.empty()) {
    auto faces = two_sided(mesh, marked, face_neighbours(mesh));
    orient(mesh, faces, orientations);
    mesh.fracture_faces = std::move(faces);
  }
  if (mesh.single_fractures.empty())
    for (const auto& name : mesh.fracture_names)
      mesh.single_fractures.push_back({name, static_cast<int>(mesh.single_fractures.size())});
  return split_along_faces(std::move(mesh));
}

GlobalMesh split_along_faces(GlobalMesh mesh) {
  mesh.parent_node.resize(mesh.n_nodes());
  std::iota(mesh.parent_node.begin(), mesh.parent_node.end(), GlobalIndex{0});
  if (!mesh.fracture_faces.empty()) split_nodes(mesh);
  return mesh;
}

}  // namespace sprekk::mesh
