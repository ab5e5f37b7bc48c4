// Functions that enrich a node field in cells at crack tips.
#pragma once

#include "assembly/geometry.hpp"
#include "assembly/tip_rule.hpp"
#include "base/check.hpp"
#include "mesh/facets.hpp"

#include <Teuchos_LAPACK.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

namespace sprekk::assembly {

/// Enriching functions of a cell of order 1 at a crack tip, on the host. For a node c that is not a tip:
///   psi_c = N_c (rho^(-1/2) - 1),    rho = sum of N_c over all nodes that are not tips
/// psi_c is continuous and vanishes at all nodes and where rho = 1. Fields thus grow with the square root of the
/// distance from the tip. On a triangle, N and psi span the functions of a quarter-point triangle on its edges at the
/// tip.
///
/// The integrals of grad psi and grad (x psi) over a cell equal those of psi n and x psi n over its faces, to
/// round-off. On simplices, the rules are exact. On other cells, a function linear in x corrects each gradient. Uniform
/// fluxes, and linear fluxes balanced by sources, are therefore in equilibrium.
template <Shape shape>
class TipCell {
 public:
  using Cell = ReferenceCell<shape>;
  static constexpr int dim = Cell::dim, n = Cell::n_nodes, n_face = Cell::n_face_nodes;
  static_assert(Cell::order == 1);

  struct Values {
    Real N[n], psi[n];
    Real grad_N[n][dim], grad_psi[n][dim];  ///< spatial gradients
  };

  /// Computes the correction of the cell. `rules` may be shared by cells. Throws an Error for a cell without volume.
  TipCell(const mesh::Mesh& mesh, LocalIndex cell, std::shared_ptr<TipRules> rules = std::make_shared<TipRules>())
      : rules_(std::move(rules)), tips_(n) {
    gather_host<shape>(mesh, cell, X_);
    for (int a = 0; a < n; ++a) tips_[a] = mesh.tip[mesh.cells[cell * n + a]];
    for (int a = 0; a < n; ++a)
      for (int i = 0; i < dim; ++i) {
        size_ = std::max(size_, std::abs(X_[a][i] - X_[0][i]));
        centre_[i] += X_[a][i] / n;
      }
    if constexpr (is_simplex(shape))
      affine_ = point({});
    else
      balance();
  }

  /// Sets the values at a reference point that is not a tip, and returns |det(dx/dxi)|.
  Real at(const Real (&xi)[dim], Values& v) const {
    Real dN[n][dim];
    Cell::shape_functions(xi, v.N);
    Cell::gradients(xi, dN);
    const auto point = this->point(xi);
    Real rho = 0, grad_rho[dim] = {};
    for (int a = 0; a < n; ++a) {
      point.gradient(dN[a], v.grad_N[a]);
      if (tips_[a]) continue;
      rho += v.N[a];
      for (int i = 0; i < dim; ++i) grad_rho[i] += v.grad_N[a][i];
    }
    const Real fall = 1 / std::sqrt(rho) - 1, slope = -1 / (2 * rho * std::sqrt(rho));
    for (int a = 0; a < n; ++a) {
      v.psi[a] = tips_[a] ? 0 : v.N[a] * fall;
      for (int i = 0; i < dim; ++i)
        v.grad_psi[a][i] = tips_[a] ? 0 : v.grad_N[a][i] * fall + v.N[a] * slope * grad_rho[i];
    }
    if constexpr (!is_simplex(shape)) correct(v);
    return point.volume;
  }

  /// Computes the spatial gradient, at xi, of a function with the reference gradient g.
  void gradient(const Real (&xi)[dim], const Real (&g)[dim], Real (&out)[dim]) const { point(xi).gradient(g, out); }

  /// Returns the mean of psi over a face, [node of face_nodes(shape)].
  FaceValues face_means(int local_face) const {
    FaceValues means{};
    Real total = 0;
    for_each_face_point(local_face, [&](const auto&, const auto& psi, const auto& area, const auto&) {
      const Real size = mesh::norm(area);
      total += size;
      for (int k = 0; k < n_face; ++k) means[k] += size * psi[k];
    });
    for (auto& mean : means) mean = total > 0 ? mean / total : 0;
    return means;
  }

  /// Calls visit(xi, volume, x, values) at the points of a rule for products of these functions.
  template <class Visit>
  void for_each_point(const Visit& visit) const {
    Values v;
    for_each_reference_point([&](const Real(&xi)[dim], Real weight) {
      const Real volume = weight * at(xi, v);
      visit(xi, volume, place(v.N), v);
    });
  }

  /// Calls visit(xi, weight) at the reference points of this rule.
  template <class Visit>
  void for_each_reference_point(const Visit& visit) const {
    Real xi[dim];
    for (const auto& point : rules_->of(shape, tips_, n_points)) {
      std::copy_n(point.xi.begin(), dim, xi);
      visit(xi, point.weight);
    }
  }

  /// Calls visit(N, psi, area, x) at the points of a face. N and psi are in the order of face_nodes(shape). `area` is
  /// the outward area vector of the point, m^2 (m in 2D). Faces without a tip are skipped.
  template <class Visit>
  void for_each_face_point(int local_face, const Visit& visit) const {
    const auto& nodes = mesh::face_nodes(shape)[local_face];
    std::vector<char> tips;
    for (int k = 0; k < n_face; ++k) tips.push_back(tips_[nodes[k]]);
    if (std::count(tips.begin(), tips.end(), 0) == n_face) return;
    for (const auto& point : face_rule(tips)) {
      Real N[n_face], dN[n_face][2], psi[n_face], rho = 0;
      face_functions(point.xi, N, dN);
      std::array<Real, 3> x{}, s{}, t{};
      for (int k = 0; k < n_face; ++k) {
        if (!tips[k]) rho += N[k];
        for (int i = 0; i < dim; ++i) {
          const Real X = X_[nodes[k]][i] - X_[nodes[0]][i];
          x[i] += N[k] * X_[nodes[k]][i];
          s[i] += dN[k][0] * X;
          t[i] += dN[k][1] * X;
        }
      }
      const Real fall = 1 / std::sqrt(rho) - 1;
      for (int k = 0; k < n_face; ++k) psi[k] = tips[k] ? 0 : N[k] * fall;
      std::array<Real, 3> area = dim == 2 ? std::array<Real, 3>{s[1], -s[0], 0}
                                          : std::array<Real, 3>{s[1] * t[2] - s[2] * t[1], s[2] * t[0] - s[0] * t[2],
                                                                s[0] * t[1] - s[1] * t[0]};
      Real outward = 0;
      for (int i = 0; i < dim; ++i) outward += area[i] * (x[i] - centre_[i]);
      for (int i = 0; i < dim; ++i) area[i] *= outward < 0 ? -point.weight : point.weight;
      visit(N, psi, area, x);
    }
  }

 private:
  CellPoint<shape> point(const Real (&xi)[dim]) const {
    if (affine_) return *affine_;
    Real dN[n][dim];
    Cell::gradients(xi, dN);
    return {X_, dN};
  }

  static constexpr int n_points = is_simplex(shape) ? 5 : dim == 2 ? 8 : 6;
  static constexpr int n_face_points = 10;  // fewer points than in a cell; their accuracy determines equilibrium

  const TipRules::Rule& face_rule(const std::vector<char>& tips) const {
    if constexpr (dim == 2) return rules_->of_edge(tips, n_face_points);
    return rules_->of(n_face == 3 ? Shape::triangle : Shape::quadrilateral, tips, n_face_points);
  }

  static void face_functions(const std::array<Real, 3>& xi, Real (&N)[n_face], Real (&dN)[n_face][2]) {
    if constexpr (dim == 2) {
      N[0] = 1 - xi[0];
      N[1] = xi[0];
      dN[0][0] = -1;
      dN[1][0] = 1;
      dN[0][1] = dN[1][1] = 0;
    } else {
      using Face = ReferenceCell<n_face == 3 ? Shape::triangle : Shape::quadrilateral>;
      const Real point[2] = {xi[0], xi[1]};
      Face::shape_functions(point, N);
      Face::gradients(point, dN);
    }
  }

  std::array<Real, 3> place(const Real (&N)[n]) const {
    std::array<Real, 3> x{};
    for (int a = 0; a < n; ++a)
      for (int i = 0; i < dim; ++i) x[i] += N[a] * X_[a][i];
    return x;
  }

  /// Sets offset to 1, followed by the distance from the centre relative to the cell size.
  void offsets(const std::array<Real, 3>& x, Real (&offset)[dim + 1]) const {
    offset[0] = 1;
    for (int i = 0; i < dim; ++i) offset[1 + i] = (x[i] - centre_[i]) / size_;
  }

  void correct(Values& v) const {
    Real offset[dim + 1];
    offsets(place(v.N), offset);
    for (int a = 0; a < n; ++a)
      for (int i = 0; i < dim; ++i)
        for (int m = 0; m <= dim; ++m) v.grad_psi[a][i] += correction_[a][i][m] * offset[m];
  }

  void balance() {
    Real missing[n * dim][dim + 1] = {}, moments[(dim + 1) * (dim + 1)] = {}, offset[dim + 1];
    for (int f = 0; f < mesh::n_faces(shape); ++f) {
      const auto& nodes = mesh::face_nodes(shape)[f];
      for_each_face_point(f, [&](const auto&, const auto& psi, const auto& area, const auto& x) {
        offsets(x, offset);
        for (int k = 0; k < n_face; ++k)
          for (int i = 0; i < dim; ++i)
            for (int m = 0; m <= dim; ++m) missing[nodes[k] * dim + i][m] += psi[k] * area[i] * offset[m];
      });
    }
    for_each_point([&](const auto&, Real volume, const auto& x, const Values& v) {
      offsets(x, offset);
      for (int m = 0; m <= dim; ++m)
        for (int l = 0; l <= dim; ++l) moments[m * (dim + 1) + l] += volume * offset[m] * offset[l];
      for (int a = 0; a < n; ++a)
        for (int i = 0; i < dim; ++i)
          for (int m = 0; m <= dim; ++m)
            missing[a * dim + i][m] -= volume * (offset[m] * v.grad_psi[a][i] + (m == 1 + i ? v.psi[a] / size_ : 0));
    });
    int info = 0;
    Teuchos::LAPACK<int, Real>().POSV('L', dim + 1, n * dim, moments, dim + 1, &missing[0][0], dim + 1, &info);
    SPREKK_CHECK(info == 0, "a cell at a crack tip has no volume");
    for (int a = 0; a < n; ++a)
      for (int i = 0; i < dim; ++i) std::copy_n(missing[a * dim + i], dim + 1, correction_[a][i]);
  }

  std::shared_ptr<TipRules> rules_;
  std::vector<char> tips_;  // [node]
  Real X_[n][dim], centre_[dim] = {}, correction_[n][dim][dim + 1] = {}, size_ = 0;
  std::optional<CellPoint<shape>> affine_;  // of a simplex: constant in the cell
};

}  // namespace sprekk::assembly
