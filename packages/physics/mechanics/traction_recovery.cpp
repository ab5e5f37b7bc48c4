#include "physics/mechanics/traction_recovery.hpp"

#include "assembly/loop.hpp"
#include "assembly/tip_cell.hpp"

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
      for (const int side : {mesh::minus, mesh::plus}) {
        Vector& own = traction_.emplace_back(t);
        if (initial.empty() || face.cell[side] < 0) continue;
        const auto mean = mean_initial_traction(initial, mesh, face, side);
        for (int i = 0; i < dim; ++i) own[i] -= mean[i];
      }
      for (const auto& nodes : face.nodes)
        for (const LocalIndex node : nodes)
          if (node >= 0) faces_at_[node].push_back(f);
    }
  }

  /// Adds the forces of t* - lambda on one side of a face. The cell of the side must be owned.
  template <class Forces>
  void add(LocalIndex f, int side, const Forces& to) const {
    const auto& face = mesh_.fracture_faces[f];
    const Matrix G = gradient(f, side);
    const Vector centre = mean_place(face.cell[side], face.local_face[side]);
    distribute(f, side, to, [&](int i, const auto& x) {
      Real sum = 0;
      for (int j = 0; j < dim; ++j) sum -= G[i][j] * (x[j] - centre[j]);
      return sum;
    });
  }

  /// Adds the forces of the traction itself, with opposite sign.
  template <class Forces>
  void add_itself(LocalIndex f, int side, const Forces& to) const {
    distribute(f, side, to, [&](int i, const auto&) { return traction_[2 * f + side][i]; });
  }

 private:
  /// Adds +- integral t_i(x) v on a side; plus on side plus.
  template <class Forces, class Traction>
  void distribute(LocalIndex f, int side, const Forces& to, const Traction& t) const {
    const auto& face = mesh_.fracture_faces[f];
    const LocalIndex cell = face.cell[side];
    const Real sign = side == mesh::plus ? 1 : -1;
    const auto nodes = mesh::face_nodes(shape)[face.local_face[side]];
    const auto node = [&](int k) { return mesh_.cells[cell * n_nodes + nodes[k]]; };
    const auto force = [&](int i, Real area, const auto& x) { return sign * area * t(i, x); };
    assembly::for_each_face_point(mesh_, cell, face.local_face[side], [&](const auto& N, Real area, const auto& x) {
      for (int i = 0; i < dim; ++i) {
        to[bubble]((f * 2 + side) * dim + i, 0) += assembly::face_bubble(shape, N) * force(i, area, x);
        for (int k = 0; k < mesh::n_face_nodes(shape); ++k)
          to[nodal](mesh_.free_node(node(k)) * dim + i, 0) += N[k] * force(i, area, x);
      }
    });
    if constexpr (mesh::order(shape) == 1)
      if (assembly::has_tip(mesh_, cell))
        assembly::TipCell<shape>(mesh_, cell)
            .for_each_face_point(
                face.local_face[side], [&](const auto&, const auto& psi, const auto& area, const auto& x) {
                  for (int k = 0; k < mesh::n_face_nodes(shape); ++k)
                    for (int i = 0; i < dim && mesh_.enriched[node(k)] >= 0; ++i)
                      to[tip](mesh_.enriched[node(k)] * dim + i, 0) += psi[k] * force(i, mesh::norm(area), x);
                });
  }

  /// Mean of x over a face. Nodes at quarter points shift it from the face centre.
  Vector mean_place(LocalIndex cell, int local_face) const {
    Vector sum{};
    Real total = 0;
    assembly::for_each_face_point(mesh_, cell, local_face, [&](const auto&, Real area, const auto& x) {
      for (int i = 0; i < dim; ++i) sum[i] += area * x[i];
      total += area;
    });
    for (Real& x : sum) x /= total;
    return sum;
  }

  /// Gradient G_ij = dt_i/dx_j by least squares over the faces of the same single fracture that share a node of this
  /// side. It is a minimum-norm solution in directions without neighbours. Open faces are excluded, because the
  /// traction is not linear across the edge of contact.
  Matrix gradient(LocalIndex f, int side) const {
    const auto& face = mesh_.fracture_faces[f];
    std::vector<LocalIndex> neighbours;
    for (const LocalIndex node : face.nodes[side])
      if (node >= 0)
        for (const LocalIndex other : faces_at_.at(node))
          if (other != f && mesh_.fracture_faces[other].single == face.single) neighbours.push_back(other);
    std::sort(neighbours.begin(), neighbours.end());
    neighbours.erase(std::unique(neighbours.begin(), neighbours.end()), neighbours.end());
    Real largest = size_[f];
    for (const LocalIndex other : neighbours) largest = std::max(largest, size_[other]);
    const auto is_open = [&](LocalIndex g) { return size_[g] <= 1e-10 * largest; };
    neighbours.erase(std::remove_if(neighbours.begin(), neighbours.end(), is_open), neighbours.end());
    if (is_open(f) || neighbours.empty()) return {};
    Matrix normal{}, G{};
    for (const LocalIndex other : neighbours)
      for (int j = 0; j < dim; ++j) {
        const Real along = mesh_.fracture_faces[other].centre[j] - face.centre[j];
        for (int i = 0; i < dim; ++i) {
          normal[j][i] += along * (mesh_.fracture_faces[other].centre[i] - face.centre[i]);
          G[i][j] += along * (traction_[2 * other + side][i] - traction_[2 * f + side][i]);
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
  std::vector<Vector> traction_;  // [local face, side] global components, minus the initial traction
  std::vector<Real> size_;        // [local face] magnitude of the total traction
  std::map<LocalIndex, std::vector<LocalIndex>> faces_at_;
};

/// Calls add(unresolved, face, side, forces) for all sides with owned cells, and adds the forces. Collective.
template <class Add>
void add_forces(const mesh::Mesh& mesh, const ByField<const fields::Layout*>& layouts,
                const fields::Layout& traction_layout, const InitialStress& initial, const fields::Vector& traction,
                const ByField<RCP<fields::Vector>>& forces, const Add& add) {
  fields::Vector lambda(traction_layout.ghosted());
  lambda.doImport(traction, *traction_layout.import(), Tpetra::REPLACE);
  std::vector<fields::Vector> local;
  for (const auto* layout : layouts) local.emplace_back((layout ? layout : layouts[nodal])->ghosted());
  mesh::for_shape(mesh.shape, [&](auto shape) {
    const Unresolved<shape()> unresolved(mesh, initial, lambda.getLocalViewHost(Tpetra::Access::ReadOnly));
    ByField<typename fields::Vector::dual_view_type::t_host> to;
    for (std::size_t k = 0; k < to.size(); ++k) to[k] = local[k].getLocalViewHost(Tpetra::Access::ReadWrite);
    for (LocalIndex f = 0; f < mesh.n_fracture_faces(); ++f)
      for (const int side : {mesh::minus, mesh::plus})
        if (const LocalIndex cell = mesh.fracture_faces[f].cell[side]; cell >= 0 && cell < mesh.n_owned_cells)
          add(unresolved, f, side, to);
  });
  for (std::size_t k = 0; k < layouts.size(); ++k) {
    if (!layouts[k]) continue;
    fields::Vector owned(layouts[k]->owned());  // doExport adds values of other ranks, but replaces own ones
    owned.doExport(local[k], *layouts[k]->import(), Tpetra::ADD);
    forces[k]->update(1, owned, 1);
  }
}

}  // namespace

void add_unresolved_traction(const mesh::Mesh& mesh, const ByField<const fields::Layout*>& layouts,
                             const fields::Layout& traction_layout, const InitialStress& initial,
                             const fields::Vector& traction, const ByField<RCP<fields::Vector>>& forces) {
  add_forces(mesh, layouts, traction_layout, initial, traction, forces,
             [](const auto& unresolved, LocalIndex f, int side, const auto& to) { unresolved.add(f, side, to); });
}

void add_opposite_tractions(const mesh::Mesh& mesh, const ByField<const fields::Layout*>& layouts,
                            const fields::Layout& traction_layout, const fields::Vector& traction,
                            const ByField<RCP<fields::Vector>>& forces) {
  add_forces(mesh, layouts, traction_layout, {}, traction, forces,
             [](const auto& all, LocalIndex f, int side, const auto& to) { all.add_itself(f, side, to); });
}

}  // namespace sprekk::physics
