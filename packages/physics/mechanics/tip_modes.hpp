// Stress around crack tips: singular crack modes.
#pragma once

#include "base/symmetric.hpp"
#include "fields/properties.hpp"
#include "laws/elasticity.hpp"
#include "mesh/facets.hpp"

#include <algorithm>
#include <array>
#include <complex>
#include <optional>
#include <unordered_map>
#include <vector>

namespace sprekk::physics {

/// Frames of the local crack tips (mesh::Mesh::tip) and stresses of a crack in plane strain (Williams 1957), in terms
/// of Westergaard's functions Z = z^(-1/2), at order 2 also z^(1/2), with z = x1 + i x2. x1 points ahead of the crack,
/// x2 along its normal, x3 along its front.
///   opening: s11 = Re Z - x2 Im Z', s22 = Re Z + x2 Im Z', s12 = -x2 Re Z'
///   sliding: s11 = 2 Im Z + x2 Re Z', s22 = -x2 Re Z', s12 = Re Z - x2 Im Z'     s33 = nu (s11 + s22)
///   tearing, in 3D: s13 = Im Z, s23 = Re Z
template <int dim, int order>
class TipModes {
 public:
  static constexpr int n = order * dim;
  using Tensor = base::Symmetric<dim>;
  using Values = typename Tensor::Values;

  TipModes(const mesh::Mesh& mesh, const fields::Properties<laws::Elasticity>& elasticity)
      : mesh_(mesh), elasticity_(elasticity) {
    if (mesh.tip.empty()) return;
    for (const auto& face : mesh.fracture_faces)
      for (std::size_t k = 0; k < face.nodes[0].size(); ++k)
        if (const LocalIndex node = face.nodes[0][k]; node >= 0 && node == face.nodes[1][k] && mesh.tip[node])
          add(face, static_cast<int>(k));
  }

  /// Modes around a tip at a point of a local cell with this tip as a corner, Pa m^0.5. The direction of the front is
  /// that of the front edge of the cell at this tip. Without such an edge, it is the mean direction of the front edges
  /// around the tip. Other fronts do not count. None if no fracture is known to end there, e.g. at a node tied to a
  /// tip.
  std::optional<std::array<Values, n>> at(LocalIndex cell, LocalIndex tip, const std::array<Real, dim>& x) const {
    using namespace mesh;
    const auto found = frames_.find(tip);
    if (found == frames_.end()) return {};
    Vector along{}, normal = found->second.normal, ahead = Real(-1) * found->second.behind;
    if constexpr (dim == 3) {
      const Vector other = front(cell, tip, found->second.next);
      along = found->second.along;
      if (!(dot(along, along) > 0)) along = cross(ahead, normal);
      if (dot(other, other) > 0) along = (dot(other, along) < 0 ? Real(-1) : Real(1)) * other;
      along = (1 / norm(along)) * along;
      normal = normal - dot(normal, along) * along;
      ahead = ahead - dot(ahead, along) * along;
    }
    normal = (1 / norm(normal)) * normal;
    ahead = ahead - dot(ahead, normal) * normal;
    ahead = (1 / norm(ahead)) * ahead;
    Vector from{};
    for (int i = 0; i < dim; ++i) from[i] = x[i] - mesh_.coordinates[tip * dim + i];
    const auto& rock = elasticity_.of_cell(mesh_, cell);
    return turned({ahead, normal, along}, dot(from, ahead), dot(from, normal),
                  rock.lambda / (2 * (rock.lambda + rock.G)));
  }

 private:
  struct Frame {
    mesh::Vector normal{}, behind{}, along{};  // not of unit length; along = ahead x normal
    std::vector<LocalIndex> next;              // other end nodes of the front edges
  };

  mesh::Vector from_to(LocalIndex a, LocalIndex b) const {
    mesh::Vector d{};
    for (int i = 0; i < dim; ++i) d[i] = mesh_.coordinates[b * dim + i] - mesh_.coordinates[a * dim + i];
    return d;
  }

  /// Adds the frame of the tip at the k-th node of a face. Sums the edges whose end nodes both sides share, oriented by
  /// the normal. Interior edges cancel because two faces add them in opposite directions.
  void add(const mesh::Mesh::FractureFace& face, int k) {
    using namespace mesh;
    const LocalIndex node = face.nodes[0][k];
    auto& frame = frames_[node];
    Vector from{};
    for (int i = 0; i < dim; ++i) from[i] = face.centre[i] - mesh_.coordinates[node * dim + i];
    frame.normal = frame.normal + face.area * face.frame[0];
    frame.behind = frame.behind + from;
    const int n = n_face_corners(mesh_.shape);
    if (dim == 2 || k >= n) return;
    const int next = (k + 1) % n, last = (k + n - 1) % n;
    const auto to = [&](int other) { return from_to(node, face.nodes[0][other]); };
    const Real sign = dot(cross(to(next), to(last)), face.frame[0]) > 0 ? 1 : -1;
    for (const auto& [other, way] : {std::pair(next, -sign), std::pair(last, sign)})
      if (const LocalIndex end = face.nodes[0][other]; end == face.nodes[1][other]) {
        frame.along = frame.along + way * to(other);
        const auto found = std::find(frame.next.begin(), frame.next.end(), end);
        if (found == frame.next.end())
          frame.next.push_back(end);
        else
          frame.next.erase(found);
      }
  }

  /// Vector from a tip to the next tip of its front in the same cell; zero if there is none.
  mesh::Vector front(LocalIndex cell, LocalIndex tip, const std::vector<LocalIndex>& next) const {
    const int n_nodes = mesh_.nodes_per_cell();
    for (int k = 0; k < n_nodes; ++k)
      if (const LocalIndex other = mesh_.cells[cell * n_nodes + k];
          std::find(next.begin(), next.end(), other) != next.end())
        return from_to(tip, other);
    return {};
  }

  /// Modes at (x1, x2) in global components; the rows of `axes` are the local axes.
  static std::array<Values, n> turned(const std::array<mesh::Vector, 3>& axes, Real x1, Real x2, Real poisson) {
    const std::complex<Real> z(x1, x2), root = std::sqrt(z);
    std::array<std::array<std::array<Real, 3>, 3>, 3 * order> local{};
    for (int k = 0; k < order; ++k) {
      const std::complex<Real> Z = k == 0 ? Real(1) / root : root, slope = (k - Real(0.5)) * Z / z;
      const auto plane = [&](int mode, Real s11, Real s22, Real s12) {
        local[dim * k + mode] = {{{s11, s12, 0}, {s12, s22, 0}, {0, 0, poisson * (s11 + s22)}}};
      };
      plane(0, Z.real() - x2 * slope.imag(), Z.real() + x2 * slope.imag(), -x2 * slope.real());
      plane(1, 2 * Z.imag() + x2 * slope.real(), -x2 * slope.real(), Z.real() - x2 * slope.imag());
      if (dim == 3) local[dim * k + 2] = {{{0, 0, Z.imag()}, {0, 0, Z.real()}, {Z.imag(), Z.real(), 0}}};
    }
    std::array<Values, n> modes{};
    for (int m = 0; m < n; ++m)
      for (int c = 0; c < Tensor::n; ++c)
        for (int k = 0; k < dim; ++k)
          for (int l = 0; l < dim; ++l)
            modes[m][c] += axes[k][Tensor::row(c)] * local[m][k][l] * axes[l][Tensor::column(c)];
    return modes;
  }

  const mesh::Mesh& mesh_;
  const fields::Properties<laws::Elasticity>& elasticity_;
  std::unordered_map<LocalIndex, Frame> frames_;
};

}  // namespace sprekk::physics
