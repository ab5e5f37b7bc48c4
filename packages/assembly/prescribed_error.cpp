#include "assembly/prescribed_error.hpp"

#include "assembly/geometry.hpp"
#include "assembly/one_sided.hpp"
#include "base/check.hpp"

#include <algorithm>

namespace sprekk::assembly {

namespace {

LocalIndex node_of(const mesh::Mesh& mesh, const mesh::Mesh::BoundaryFace& face, int k) {
  return mesh.cells[face.cell * mesh.nodes_per_cell() + mesh::face_nodes(mesh.shape)[face.local_face][k]];
}

/// Returns the integral of g - I g over a face, and the area of the face. has_copies: [node], see nodes_with_copies().
/// Throws an Error where g has no value.
std::array<Real, 2> missed(const mesh::Mesh& mesh, const std::vector<char>& has_copies,
                           const mesh::Mesh::BoundaryFace& face, const base::Expression& g, Real t) {
  using mesh::operator-;
  const int dim = mesh.dim(), n = mesh::n_face_nodes(mesh.shape);
  const auto centre = mesh::face_centre(mesh::face_corners(mesh, face.cell, face.local_face));
  FaceValues interpolant{};
  for (int k = 0; k < n; ++k) {
    std::array<Real, 3> x{};
    const LocalIndex node = node_of(mesh, face, k);
    std::copy_n(&mesh.coordinates[node * dim], dim, x.begin());
    interpolant[k] = one_sided(g, x, has_copies[node] ? centre - x : mesh::Vector{}, t);
  }
  Real sum = 0, total = 0;
  for_each_face_point(mesh, face.cell, face.local_face, [&](const auto& N, Real area, const auto& x) {
    sum += area * g(x, t);
    for (int k = 0; k < n; ++k) sum -= area * N[k] * interpolant[k];
    total += area;
  });
  return {sum, total};
}

/// Adds the integrals and areas of owned faces to the nodes around them. [ghosted unknown, 2]
template <class Sums>
void add_faces(const mesh::Mesh& mesh, int n_components, const DirichletCondition& condition, Real t,
               const Sums& sums) {
  if (condition.within) return;  // conditions on single nodes
  const auto has_copies = nodes_with_copies(mesh);
  for (const auto& face : mesh.boundary_faces) {
    const bool everywhere = condition.region < 0 || condition.region == mesh.cell_region[face.cell];
    if (!face.owned || face.boundary != condition.boundary || !everywhere) continue;
    for (int c = 0; c < n_components; ++c) {
      if (!condition.values[c]) continue;
      const auto of_face = missed(mesh, has_copies, face, *condition.values[c], t);
      for (int k = 0; k < mesh::n_face_nodes(mesh.shape); ++k)
        for (int i = 0; i < 2; ++i) sums(mesh.free_node(node_of(mesh, face, k)) * n_components + c, i) += of_face[i];
    }
  }
}

}  // namespace

fields::Vector prescribed_error(const mesh::Mesh& mesh, const fields::Layout& layout,
                                const std::vector<DirichletCondition>& conditions, Real t) {
  const int n_components = layout.field().n_components;
  fields::MultiVector local(layout.ghosted(), 2), owned(layout.owned(), 2);  // integrals, areas
  base::collectively(*mesh.comm, [&] {
    const auto sums = local.getLocalViewHost(Tpetra::Access::ReadWrite);
    for (const auto& condition : conditions) add_faces(mesh, n_components, condition, t, sums);
  });
  owned.doExport(local, *layout.import(), Tpetra::ADD);
  fields::Vector result(layout.owned());
  const auto sums = owned.getLocalViewHost(Tpetra::Access::ReadOnly);
  const auto mean = result.getLocalViewHost(Tpetra::Access::ReadWrite);
  for (LocalIndex i = 0; i < layout.n_owned(); ++i)
    if (sums(i, 1) > 0) mean(i, 0) = sums(i, 0) / sums(i, 1);
  return result;
}

}  // namespace sprekk::assembly
