#include "physics/traction_recovery.hpp"

#include <Teuchos_LAPACK.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace sprekk::physics {

using mesh::Shape;

namespace {

template <Shape shape>
class Unresolved {
 public:
  static constexpr int dim = mesh::dimension(shape), n_nodes = mesh::n_nodes(shape);
  using Vector = std::array<Real, dim>;
  using Matrix = std::array<Vector, dim>;

  /// `lambda` [local unknown].
  template <class View>
  Unresolved(const mesh::Mesh& mesh, const InitialStress& initial, const View& lambda) : mesh_(mesh) {
    for (LocalIndex f = 0; f < mesh.n_fracture_faces(); ++f) {
      const auto& face = mesh.fracture_faces[f];
      Vector t{};
      for (int k = 0; k < dim; ++k)
        for (int i = 0; i < dim; ++i) t[i] += face.frame[k][i] * lambda(f * dim + k, 0);
      size_.push_back(std::sqrt(std::inner_product(t.begin(), t.end(), t.begin(), 0.0)));
      if (!initial.empty()) {
        const int side = face.cell[mesh::minus] >= 0 ? mesh::minus : mesh::plus;
        const auto mean = mean_initial_traction<shape>(initial, mesh, face, side);
        for (int i = 0; i < dim; ++i) t[i] -= mean[i];
      }
      traction_.push_back(t);
      for (const auto& nodes : face.nodes)
        for (const LocalIndex node : nodes)
          if (node >= 0) faces_at_[node].push_back(f);
    }
  }

  /// Adds the forces on the unknowns of one side of a face whose cell is owned.
  template <class Forces>
  void add(LocalIndex f, int side, const Forces& displacement, const Forces& bubble) const {
    const auto& face = mesh_.fracture_faces[f];
    const Matrix G = gradient(f, side);
    const Real sign = side == mesh::plus ? 1 : -1;
    const auto nodes = mesh::face_nodes(shape)[face.local_face[side]];
    assembly::for_each_face_point<shape>(
        mesh_, face.cell[side], face.local_face[side], [&](const auto& N, Real area, const auto& x) {
          for (int i = 0; i < dim; ++i) {
            Real force = 0;
            for (int j = 0; j < dim; ++j) force -= sign * area * G[i][j] * (x[j] - face.centre[j]);
            bubble((f * 2 + side) * dim + i, 0) += assembly::face_bubble<shape>(N) * force;
            for (int k = 0; k < mesh::n_face_nodes(shape); ++k)
              displacement(mesh_.free_node(mesh_.cells[face.cell[side] * n_nodes + nodes[k]]) * dim + i, 0) +=
                  N[k] * force;
          }
        });
  }

 private:
  /// G_ij = dt_i/dx_j by least squares over the faces of the same fracture that share a node of this side; as small as
  /// possible in directions in which there are none.
  Matrix gradient(LocalIndex f, int side) const {
    const auto& face = mesh_.fracture_faces[f];
    std::vector<LocalIndex> neighbours;
    for (const LocalIndex node : face.nodes[side])
      if (node >= 0)
        for (const LocalIndex other : faces_at_.at(node))
          if (other != f && mesh_.fracture_faces[other].fracture == face.fracture) neighbours.push_back(other);
    std::sort(neighbours.begin(), neighbours.end());
    neighbours.erase(std::unique(neighbours.begin(), neighbours.end()), neighbours.end());
    Real largest = 0;
    for (const LocalIndex other : neighbours) largest = std::max(largest, size_[other]);
    if (size_[f] <= 1e-10 * largest || neighbours.empty()) return {};  // open, or alone
    Matrix normal{}, G{};
    for (const LocalIndex other : neighbours)
      for (int j = 0; j < dim; ++j) {
        const Real along = mesh_.fracture_faces[other].centre[j] - face.centre[j];
        for (int i = 0; i < dim; ++i) {
          normal[j][i] += along * (mesh_.fracture_faces[other].centre[i] - face.centre[i]);
          G[i][j] += along * (traction_[other][i] - traction_[f][i]);
        }
      }
    Real trace = 0;
    for (int i = 0; i < dim; ++i) trace += normal[i][i];
    for (int i = 0; i < dim; ++i) normal[i][i] += 1e-3 * trace;
    int info = 0;
    Teuchos::LAPACK<int, Real>().POSV('L', dim, dim, normal[0].data(), dim, G[0].data(), dim, &info);
    return G;
  }

  const mesh::Mesh& mesh_;
  std::vector<Vector> traction_;  // [local face], in global components, without that of the initial stress
  std::vector<Real> size_;        // [local face] of the whole traction
  std::map<LocalIndex, std::vector<LocalIndex>> faces_at_;
};

}  // namespace

void add_unresolved_traction(const mesh::Mesh& mesh, const FractureLayouts& layouts, const InitialStress& initial,
                             const fields::Vector& traction, fields::Vector& displacement, fields::Vector& bubble) {
  fields::Vector lambda(layouts.traction.ghosted()), u(layouts.displacement.ghosted()), beta(layouts.bubble.ghosted());
  lambda.doImport(traction, *layouts.traction.import(), Tpetra::REPLACE);
  mesh::for_shape(mesh.shape, [&](auto shape) {
    const Unresolved<shape()> unresolved(mesh, initial, lambda.getLocalViewHost(Tpetra::Access::ReadOnly));
    const auto u_view = u.getLocalViewHost(Tpetra::Access::ReadWrite);
    const auto beta_view = beta.getLocalViewHost(Tpetra::Access::ReadWrite);
    for (LocalIndex f = 0; f < mesh.n_fracture_faces(); ++f)
      for (const int side : {mesh::minus, mesh::plus})
        if (const LocalIndex cell = mesh.fracture_faces[f].cell[side]; cell >= 0 && cell < mesh.n_owned_cells)
          unresolved.add(f, side, u_view, beta_view);
  });
  const auto add = [](const fields::Vector& local, const fields::Layout& layout, fields::Vector& to) {
    fields::Vector owned(layout.owned());  // an export adds what comes from other ranks, and replaces the rest
    owned.doExport(local, *layout.import(), Tpetra::ADD);
    to.update(1, owned, 1);
  };
  add(u, layouts.displacement, displacement);
  add(beta, layouts.bubble, bubble);
}

}  // namespace sprekk::physics
