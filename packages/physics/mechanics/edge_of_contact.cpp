#include "physics/mechanics/edge_of_contact.hpp"

#include "assembly/geometry.hpp"
#include "assembly/loop.hpp"
#include "base/over_ranks.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sprekk::physics {

namespace {

using HostValues = typename fields::Vector::dual_view_type::t_host::const_type;

/// Owned face whose cells have no tip.
class Face {
 public:
  Face(const mesh::Mesh& mesh, LocalIndex f, const HostValues& u, const HostValues& beta, const base::Expression* gap)
      : mesh_(mesh), face_(mesh.fracture_faces[f]), gap_(gap) {
    const int dim = mesh.dim();
    for (int i = 0; i < dim; ++i) {
      const Real n = face_.frame[0][i];
      bubble_ += n * (beta((2 * f + mesh::plus) * dim + i, 0) - beta((2 * f + mesh::minus) * dim + i, 0));
      for (int k = 0; k < mesh::n_face_nodes(mesh.shape); ++k)
        for (const int side : {mesh::minus, mesh::plus})
          nodal_[k] += (side == mesh::plus ? n : -n) * u(mesh.free_node(face_.nodes[side][k]) * dim + i, 0);
    }
    mean_ = mean([](Real o) { return o; });
  }

  /// Shifts the distances o(x) to the given mean.
  void set_mean(Real distance) { shift_ = distance - mean_; }
  /// Returns the mean of value(o).
  template <class Value>
  Real mean(const Value& value) const {
    return assembly::face_mean(mesh_, face_.cell[mesh::minus], face_.local_face[mesh::minus],
                               [&](const auto& N, const auto& x) {
                                 Real o = shift_ + assembly::face_bubble(mesh_.shape, N) * bubble_;
                                 for (int k = 0; k < mesh::n_face_nodes(mesh_.shape); ++k) o += N[k] * nodal_[k];
                                 return value(gap_ ? o - (*gap_)(x, 0) : o);
                               });
  }

 private:
  const mesh::Mesh& mesh_;
  const mesh::Mesh::FractureFace& face_;
  const base::Expression* gap_;
  assembly::FaceValues nodal_{};  // jumps along the normal
  Real bubble_ = 0, mean_ = 0, shift_ = 0;
};

/// Compliance C, m/Pa.
Real compliance(const mesh::Mesh& mesh, const mesh::Mesh::FractureFace& face,
                const fields::Properties<laws::Elasticity>& elasticity) {
  Real sum = 0;
  for (const LocalIndex cell : face.cell) {
    const auto& rock = elasticity.of_cell(mesh, cell);
    sum += (1 - rock.lambda / (2 * (rock.lambda + rock.G))) / rock.G;
  }
  return sum * std::pow(face.area, 1.0 / (mesh.dim() - 1)) / (2 * std::numbers::pi);
}

fields::Vector with_ghosts(const fields::Layout& layout, const fields::Vector& owned) {
  fields::Vector all(layout.ghosted());
  all.doImport(owned, *layout.import(), Tpetra::REPLACE);
  return all;
}

}  // namespace

bool add_edges_of_contact(const mesh::Mesh& mesh, const ByField<const fields::Layout*>& layouts,
                          const ByField<RCP<const fields::Vector>>& displacement, const ContactAlongFaces& along,
                          const std::vector<contact::Constraint>& constraints, fields::Vector& bubbles,
                          fields::Vector& tractions) {
  const auto nodes = with_ghosts(*layouts[nodal], *displacement[nodal]),
             of_sides = with_ghosts(*layouts[bubble], *displacement[bubble]);
  const auto u = nodes.getLocalViewHost(Tpetra::Access::ReadOnly),
             beta = of_sides.getLocalViewHost(Tpetra::Access::ReadOnly);
  const auto opens = bubbles.getLocalViewHost(Tpetra::Access::ReadWrite),
             presses = tractions.getLocalViewHost(Tpetra::Access::ReadWrite);
  bool any = false;
  const int dim = mesh.dim();
  for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) {
    const auto& face = mesh.fracture_faces[f];
    if (assembly::has_tip(mesh, face.cell[0]) || assembly::has_tip(mesh, face.cell[1])) continue;
    const Real C = compliance(mesh, face, along.elasticity);
    Real lambda = 0;
    for (int i = 0; i < dim; ++i) lambda += face.frame[0][i] * constraints[f].traction[i];
    Face distances(mesh, f, u, beta, along.gap[f]);
    distances.set_mean(constraints[f].gap);
    const Real excess = distances.mean([&](Real o) { return std::max(lambda < 0 ? o + C * lambda : -o, 0.0); });
    any = any || excess > 0;
    if (lambda >= 0) {
      presses(f * dim, 0) -= 2 * excess / (3 * C);
      continue;
    }
    const Real of_side =
        2 * excess / 3 / assembly::bubble_mean(mesh, face.cell[mesh::minus], face.local_face[mesh::minus]);
    for (int i = 0; i < dim; ++i) {
      opens((2 * f + mesh::plus) * dim + i, 0) += of_side * face.frame[0][i];
      opens((2 * f + mesh::minus) * dim + i, 0) -= of_side * face.frame[0][i];
    }
  }
  return base::on_any_rank(*mesh.comm, any);
}

}  // namespace sprekk::physics
