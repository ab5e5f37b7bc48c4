#include "mesh/ahead.hpp"

#include "base/over_ranks.hpp"

#include <algorithm>
#include <limits>

namespace sprekk::mesh {

std::optional<FaceAhead> first_face_ahead(const Mesh& mesh, const Vector& x, const Vector& direction, int except) {
  constexpr Real none = std::numeric_limits<Real>::max();
  const auto left = [&](const Vector& r) { return direction[0] * r[1] - direction[1] * r[0]; };
  Real nearest = none;
  LocalIndex found = -1;
  for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) {
    if (mesh.fracture_faces[f].single == except) continue;
    const Vector a = face_corner(mesh, f, 0) - x, b = face_corner(mesh, f, 1) - x;
    const Real at_a = left(a), at_b = left(b);
    if (at_a == at_b || at_a * at_b > 0) continue;
    const Real distance = dot((at_b / (at_b - at_a)) * a - (at_a / (at_b - at_a)) * b, direction);
    if (distance > 0 && distance < nearest) nearest = distance, found = f;
  }
  const auto& comm = *mesh.comm;
  const Real first = base::min_over_ranks(comm, nearest);
  if (first == none) return {};
  const int rank = comm.getRank(), owner = base::min_over_ranks(comm, nearest == first ? rank : comm.getSize());
  FaceAhead ahead;
  std::array<Real, 3> known{};  // single fracture, vector
  GlobalIndex cell = -1;
  if (rank == owner) {
    ahead.face = found;
    const auto& face = mesh.fracture_faces[found];
    Vector along = face_corner(mesh, found, 1) - face_corner(mesh, found, 0);
    along = ((left(along) > 0 ? 1 : -1) / norm(along)) * along;
    known = {static_cast<Real>(face.single), along[0], along[1]};
    cell = mesh.cell_id[face.cell[dot(face.frame[0], direction) > 0 ? plus : minus]];
  }
  known = base::sum_over_ranks(comm, known);
  cell = base::max_over_ranks(comm, cell);
  ahead.single = static_cast<int>(known[0]);
  ahead.along = {known[1], known[2], 0};
  const auto own = std::find(mesh.cell_id.begin(), mesh.cell_id.begin() + mesh.n_owned_cells, cell);
  if (own != mesh.cell_id.begin() + mesh.n_owned_cells)
    ahead.cell = static_cast<LocalIndex>(own - mesh.cell_id.begin());
  return ahead;
}

}  // namespace sprekk::mesh
