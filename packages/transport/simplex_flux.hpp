// Flux in a simplex from the flows through its faces, its potential, and the distance of both from another potential.
#pragma once

#include "base/types.hpp"
#include "laws/darcy.hpp"

#include <array>
#include <cmath>

namespace sprekk::transport {

/// Flux in a simplex of d dimensions. Quadratic functions have their values at places: the corners, then the midpoints
/// of edges (0, 1), (0, 2), ..., (1, 2), ...
///
/// | symbol   | shape          | unit       |                                                              |
/// | X        | [corner, d]    | m          | corners, relative to the centre                              |
/// | gradient | [corner, d]    | 1/m        | of barycentric coordinates                                   |
/// | K        | [d, d]         | m^2/(Pa s) | mobility; root: K = root root^T                              |
/// | q        | [corner]       | m^3/s      | outward flow through the face opposite to a corner           |
/// | w        | [d]            | N/m^3      | weight of the fluid; at rest grad p = w                      |
template <int d>
class SimplexFlux {
 public:
  static constexpr int n = d + 1, n_places = n * (d + 2) / 2, n_components = n * d;
  using Flows = std::array<Real, n>;
  using Weight = std::array<Real, d>;
  using Barycentric = std::array<Real, n>;
  using AtPlaces = std::array<Real, n_places>;
  using Components = std::array<Real, n_components>;

  static constexpr int place(int a, int b) {
    if (a > b) return place(b, a);
    if (a == b) return a;
    int edge = n;
    for (int i = 0; i < n; ++i)
      for (int j = i + 1; j < n; ++j, ++edge)
        if (i == a && j == b) return edge;
    return -1;
  }

  SimplexFlux(const Real (&corners)[n][d], const laws::Mobility& mobility) {
    for (int i = 0; i < d; ++i) {
      for (int l = 0; l < n; ++l) centre_[i] += corners[l][i] / n;
      for (int k = 0; k < n; ++k) X_[k][i] = corners[k][i] - centre_[i];
    }
    Real edges[d][d];  // [k][i] edge from corner 0 to corner k + 1
    for (int k = 0; k < d; ++k)
      for (int i = 0; i < d; ++i) edges[k][i] = X_[k + 1][i] - X_[0][i];
    Real inverse[d][d];  // [i][k] gradient of barycentric coordinate k + 1
    volume_ = std::abs(invert(edges, inverse));
    for (int k = 2; k <= d; ++k) volume_ /= k;
    for (int i = 0; i < d; ++i) {
      gradient_[0][i] = 0;
      for (int k = 0; k < d; ++k) {
        gradient_[k + 1][i] = inverse[i][k];
        gradient_[0][i] -= inverse[i][k];
      }
    }
    Real K[d][d];
    for (int i = 0; i < d; ++i)
      for (int j = 0; j < d; ++j) K[i][j] = mobility.value[i][j];
    invert(K, resistance_);
    for (int i = 0; i < d; ++i)
      for (int j = 0; j <= i; ++j) {
        Real sum = K[i][j];
        for (int k = 0; k < j; ++k) sum -= root_[i][k] * root_[j][k];
        root_[i][j] = i == j ? std::sqrt(sum) : sum / root_[j][j];
      }
  }

  Real volume() const { return volume_; }

  /// Potential p with grad p = w - K^-1 q and the given mean. q is the lowest-order Raviart-Thomas flux.
  AtPlaces potential(const Flows& q, Real mean, const Weight& w) const {
    const auto [a, b] = affine(q);
    Real spread = 0;  // mean of x . K^-1 x
    for (int k = 0; k < n; ++k) spread += product(X_[k], X_[k]) / (n * (n + 1));
    AtPlaces p{};
    for (int k = 0; k < n; ++k)
      for (int l = k; l < n; ++l) {
        Real x[d], at = mean + b / 2 * spread;
        for (int i = 0; i < d; ++i) x[i] = (X_[k][i] + X_[l][i]) / 2;
        for (int i = 0; i < d; ++i) at += w[i] * x[i];
        p[place(k, l)] = at - product(a, x) - b / 2 * product(x, x);
      }
    return p;
  }

  /// Quadratic shape functions: 1 at one place and 0 at the others.
  static AtPlaces shapes(const Barycentric& l) {
    AtPlaces N{};
    for (int a = 0; a < n; ++a)
      for (int b = a; b < n; ++b) N[place(a, b)] = a == b ? l[a] * (2 * l[a] - 1) : 4 * l[a] * l[b];
    return N;
  }
  /// Value of a quadratic function at barycentric coordinates.
  static Real quadratic(const AtPlaces& s, const Barycentric& l) {
    Real sum = 0;
    const auto N = shapes(l);
    for (int k = 0; k < n_places; ++k) sum += N[k] * s[k];
    return sum;
  }

  /// Components of root^-1 (q - K w) at the points of a quadrature rule that is exact for products of two fluxes.
  Components flux(const Flows& q, const Weight& w) const {
    return components([&](const Barycentric& l, Real(&e)[d]) {
      flux(q, l, e);
      for (int i = 0; i < d; ++i) e[i] -= w[i];
    });
  }
  /// Components of root^-1 K grad N for the shape functions.
  std::array<Components, n_places> gradients() const {
    std::array<Components, n_places> result;
    for (int a = 0; a < n; ++a)
      for (int b = a; b < n; ++b)
        result[place(a, b)] = components([&](const Barycentric& l, Real(&e)[d]) {
          for (int i = 0; i < d; ++i)
            e[i] = a == b ? (4 * l[a] - 1) * gradient_[a][i] : 4 * (l[b] * gradient_[a][i] + l[a] * gradient_[b][i]);
        });
    return result;
  }
  /// Components of root^-1 (q + K (grad s - w)).
  static Components error(const Components& flux, const std::array<Components, n_places>& gradients,
                          const AtPlaces& s) {
    Components e = flux;
    for (int k = 0; k < n_places; ++k)
      for (int i = 0; i < n_components; ++i) e[i] += s[k] * gradients[k][i];
    return e;
  }
  /// Deviations of values(x, l) from their mean, scaled so that sums of products are integrals. x: coordinates, l:
  /// barycentric coordinates. Exact if both functions are linear.
  template <class ValuesAt>
  Flows variation(const ValuesAt& values) const {
    Flows result{};
    Real mean = 0;
    for (int p = 0; p < n; ++p) {
      Barycentric l;
      std::array<Real, 3> x{};
      for (int k = 0; k < n; ++k) l[k] = k == p ? outer : (1 - outer) / d;
      for (int i = 0; i < d; ++i) {
        x[i] = centre_[i];
        for (int k = 0; k < n; ++k) x[i] += l[k] * X_[k][i];
      }
      mean += (result[p] = values(x, l)) / n;
    }
    for (Real& value : result) value = std::sqrt(volume_ / n) * (value - mean);
    return result;
  }

 private:
  /// Coefficients of q = a + b x, the sum of q_k (x - X_k)/(d V).
  std::pair<std::array<Real, d>, Real> affine(const Flows& q) const {
    std::array<Real, d> a{};
    Real b = 0;
    for (int k = 0; k < n; ++k) {
      b += q[k] / (d * volume_);
      for (int i = 0; i < d; ++i) a[i] -= q[k] * X_[k][i] / (d * volume_);
    }
    return {a, b};
  }
  /// Computes e = K^-1 q at barycentric coordinates.
  void flux(const Flows& q, const Barycentric& l, Real (&e)[d]) const {
    const auto [a, b] = affine(q);
    Real v[d];
    for (int i = 0; i < d; ++i) {
      v[i] = a[i];
      for (int k = 0; k < n; ++k) v[i] += b * l[k] * X_[k][i];
    }
    for (int i = 0; i < d; ++i) {
      e[i] = 0;
      for (int j = 0; j < d; ++j) e[i] += resistance_[i][j] * v[j];
    }
  }
  template <class A, class B>
  Real product(const A& a, const B& b) const {
    Real sum = 0;
    for (int i = 0; i < d; ++i)
      for (int j = 0; j < d; ++j) sum += a[i] * resistance_[i][j] * b[j];
    return sum;
  }

  /// Components of vectors e = K^-1 v that at(barycentric coordinates, e) computes. The sum of squares is the integral
  /// of v . K^-1 v.
  template <class At>
  Components components(const At& at) const {
    Components result{};
    for (int p = 0; p < n; ++p) {
      Barycentric l;
      Real e[d] = {};
      for (int k = 0; k < n; ++k) l[k] = k == p ? outer : (1 - outer) / d;
      at(l, e);
      for (int i = 0; i < d; ++i)
        for (int j = i; j < d; ++j) result[p * d + i] += std::sqrt(volume_ / n) * root_[j][i] * e[j];
    }
    return result;
  }

  /// Computes the inverse and returns the determinant.
  static Real invert(const Real (&A)[d][d], Real (&inverse)[d][d]) {
    Real M[d][2 * d], det = 1;
    for (int i = 0; i < d; ++i)
      for (int j = 0; j < 2 * d; ++j) M[i][j] = j < d ? A[i][j] : j - d == i;
    for (int k = 0; k < d; ++k) {
      int pivot = k;
      for (int i = k; i < d; ++i)
        if (std::abs(M[i][k]) > std::abs(M[pivot][k])) pivot = i;
      if (pivot != k) std::swap(M[pivot], M[k]);
      det *= pivot == k ? M[k][k] : -M[k][k];
      for (int j = 2 * d - 1; j >= k; --j) M[k][j] /= M[k][k];
      for (int i = 0; i < d; ++i)
        for (int j = 2 * d - 1; j >= k && i != k; --j) M[i][j] -= M[i][k] * M[k][j];
    }
    for (int i = 0; i < d; ++i)
      for (int j = 0; j < d; ++j) inverse[i][j] = M[i][d + j];
    return det;
  }

  /// Largest barycentric coordinate of the points of a rule that is exact for quadratic functions.
  static constexpr Real outer = d == 1 ? 0.788675134594813 : d == 2 ? 2.0 / 3 : 0.585410196624969;

  Real centre_[d] = {}, X_[n][d], gradient_[n][d], resistance_[d][d], root_[d][d] = {}, volume_;
};

}  // namespace sprekk::transport
