#include <algorithm>
#include <utility>

#include "base/check.hpp"
#include "mesh/split.hpp"

namespace sprekk::mesh {
namespace {

using FractureFaces = std::vector<GlobalMesh::FractureFace>;

struct Neighbour {
  int face;
  bool reversed;  ///< the normals out of the two minus cells point to opposite sides
};

/// Returns for each fracture face its neighbours. Neighbours share an edge (2D: node) at which the fracture has exactly
/// two faces.
std::vector<std::vector<Neighbour>> neighbours(const GlobalMesh& mesh, const FractureFaces& faces) {
  struct Ridge {
    std::array<GlobalIndex, 3> key;  ///< fracture and nodes of the ridge, sorted
    int face;
    bool forward;  ///< node order of the face along the ridge is ascending; 2D: the face starts there
  };
  std::vector<Ridge> ridges;
  const int n = n_face_corners(mesh.shape);
  for (int f = 0; f < static_cast<int>(faces.size()); ++f) {
    const auto nodes = nodes_of_face(mesh, faces[f].cell[minus], faces[f].local_face[minus]);
    for (int k = 0; k < n; ++k) {
      const GlobalIndex a = nodes[k], b = n == 2 ? a : nodes[(k + 1) % n];
      ridges.push_back({{faces[f].fracture, std::min(a, b), std::max(a, b)}, f, n == 2 ? k == 0 : a < b});
    }
  }
  std::sort(ridges.begin(), ridges.end(), [](const Ridge& a, const Ridge& b) { return a.key < b.key; });

  std::vector<std::vector<Neighbour>> result(faces.size());
  for (auto first = ridges.begin(); first != ridges.end();) {
    const auto last = std::find_if(first, ridges.end(), [&](const Ridge& r) { return r.key != first->key; });
    if (last - first == 2) {
      const bool reversed = first[0].forward == first[1].forward;
      result[first[0].face].push_back({first[1].face, reversed});
      result[first[1].face].push_back({first[0].face, reversed});
    }
    first = last;
  }
  return result;
}

void swap_sides(GlobalMesh::FractureFace& face) {
  std::swap(face.cell[minus], face.cell[plus]);
  std::swap(face.local_face[minus], face.local_face[plus]);
}

/// Returns true if the normals of a consistent piece must be reversed to fulfil the rule of orient().
bool points_backward(const GlobalMesh& mesh, const FractureFaces& faces, const std::vector<int>& piece,
                     const Orientation& orientation) {
  constexpr Real tolerance = 1e-8;
  Vector sum{}, middle{};
  Real area = 0;
  for (int f : piece) {
    const Vector vector = area_vector(mesh, faces[f].cell[minus], faces[f].local_face[minus]);
    sum = sum + vector;
    area += norm(vector);
    middle = middle + norm(vector) * face_centre(mesh, faces[f].cell[minus], faces[f].local_face[minus]);
  }
  middle = (1 / area) * middle;
  if (orientation.reference) {
    const Vector& reference = *orientation.reference;
    const Real product = dot(sum, reference);
    SPREKK_CHECK(std::abs(product) > tolerance * area * norm(reference),
                 "fracture \"{}\": its normal ({}, {}, {}) is perpendicular to the reference normal ({}, {}, {})",
                 mesh.fracture_names[faces[piece[0]].fracture], sum[0] / area, sum[1] / area, sum[2] / area,
                 reference[0], reference[1], reference[2]);
    return product < 0;
  }
  for (int i : {2, 1, 0})
    if (std::abs(sum[i]) > tolerance * area) return sum[i] < 0;
  Real volume = 0;  // times dim, by the divergence theorem
  for (int f : piece)
    volume += dot(area_vector(mesh, faces[f].cell[minus], faces[f].local_face[minus]),
                  face_centre(mesh, faces[f].cell[minus], faces[f].local_face[minus]) - middle);
  return volume < 0;
}

}  // namespace

void orient(const GlobalMesh& mesh, FractureFaces& faces, const std::vector<Orientation>& orientations) {
  const auto neighbours_of = neighbours(mesh, faces);
  std::vector<bool> visited(faces.size(), false), reversed(faces.size(), false);
  for (int seed = 0; seed < static_cast<int>(faces.size()); ++seed) {
    if (visited[seed]) continue;
    visited[seed] = true;
    std::vector<int> piece{seed};
    for (std::size_t next = 0; next < piece.size(); ++next)
      for (const auto& neighbour : neighbours_of[piece[next]]) {
        const bool wanted = reversed[piece[next]] != neighbour.reversed;
        if (!visited[neighbour.face]) {
          visited[neighbour.face] = true;
          reversed[neighbour.face] = wanted;
          piece.push_back(neighbour.face);
        }
        SPREKK_CHECK(reversed[neighbour.face] == wanted,
                     "fracture \"{}\": is a one-sided surface (a Moebius strip); it needs two sides",
                     mesh.fracture_names[faces[seed].fracture]);
      }
    for (int f : piece)
      if (reversed[f]) swap_sides(faces[f]);
    const Orientation orientation = orientations.empty() ? Orientation{} : orientations[faces[seed].fracture];
    if (points_backward(mesh, faces, piece, orientation) != orientation.swap_sides)
      for (int f : piece) swap_sides(faces[f]);
  }
}

}  // namespace sprekk::mesh
