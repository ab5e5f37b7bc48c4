// Hybrid form of the flow through the faces of one cell, as a function of its pressure and face pressures.
#pragma once

#include "assembly/cell_nodes.hpp"
#include "assembly/slots.hpp"
#include "laws/darcy.hpp"
#include "laws/fluid.hpp"

#include <cmath>

namespace sprekk::transport {

using mesh::Shape;

/// Scheme of the flows through the faces of a cell, q_i = sum_j T_ij (p - p_j). On cells with plane faces, all schemes
/// except tpfa are exact for constant gradients.
enum class FluxScheme {
  rt0,     ///< lowest-order Raviart-Thomas-Nedelec on simplices
  tpfa,    ///< two-point fluxes, T diagonal; exact where (k/mu) n is parallel to d_i
  mimetic  ///< any cell, with the quasi-RT inner product of Lie et al. (2012)
};

/// | symbol   | shape       | unit        |                                                       |
/// | area     | [face, dim] | m^2 (2D: m) | outward area vectors A_i                              |
/// | centre   | [face, dim] | m           | centres of the faces, seen from that of the cell, d_i |
/// | volume   |             | m^3 (m^2)   | V                                                     |
/// | corners  | [corner, dim] | m         | seen from the centre of the cell                      |
template <Shape shape>
struct CellFaces {
  static constexpr int dim = mesh::dimension(shape), n = mesh::n_faces(shape), n_corners = mesh::n_corners(shape);
  static constexpr int n_face_corners = mesh::n_face_corners(shape);
  Real area[n][dim], centre[n][dim], corners[n_corners][dim], volume = 0;

  /// Computes the geometry from the nodes of the cell.
  template <int n_nodes>
  KOKKOS_INLINE_FUNCTION explicit CellFaces(const Real (&X)[n_nodes][dim]) {
    Real mean[dim] = {};
    for (int k = 0; k < n_corners; ++k)
      for (int i = 0; i < dim; ++i) mean[i] += X[k][i] / n_corners;
    for (int k = 0; k < n_corners; ++k)
      for (int i = 0; i < dim; ++i) corners[k][i] = X[k][i] - mean[i];
    Real moved[dim] = {};  // from the mean of the corners to the centre, summed over the pyramids on the faces
    for (int f = 0; f < n; ++f) {
      measure(f);
      Real height = 0;
      for (int i = 0; i < dim; ++i) height += area[f][i] * centre[f][i] / dim;
      volume += height;
      for (int i = 0; i < dim; ++i) moved[i] += height * centre[f][i] * dim / (dim + 1.0);
    }
    for (int i = 0; i < dim; ++i) {
      moved[i] /= volume;
      for (int f = 0; f < n; ++f) centre[f][i] -= moved[i];
      for (int k = 0; k < n_corners; ++k) corners[k][i] -= moved[i];
    }
  }

 private:
  /// Computes area vector and centre of a face. In 3D the face consists of triangles around its first corner.
  KOKKOS_INLINE_FUNCTION void measure(int f) {
    static constexpr auto nodes_of = mesh::face_nodes(shape);  // copy of the table for the device
    const auto& nodes = nodes_of[f];
    const auto& a = corners[nodes[0]];
    const auto& b = corners[nodes[1]];
    if constexpr (dim == 2) {
      area[f][0] = b[1] - a[1];
      area[f][1] = a[0] - b[0];
      for (int i = 0; i < dim; ++i) centre[f][i] = (a[i] + b[i]) / 2;
    } else {
      Real part[n_face_corners - 2][3], size[n_face_corners - 2], total = 0;
      for (int i = 0; i < 3; ++i) area[f][i] = centre[f][i] = 0;
      for (int k = 0; k < n_face_corners - 2; ++k) {
        cross(a, corners[nodes[k + 1]], corners[nodes[k + 2]], part[k]);
        for (int i = 0; i < 3; ++i) area[f][i] += part[k][i];
      }
      for (int k = 0; k < n_face_corners - 2; ++k) {
        size[k] = 0;
        for (int i = 0; i < 3; ++i) size[k] += part[k][i] * area[f][i];
        total += size[k];
      }
      for (int k = 0; k < n_face_corners - 2; ++k)
        for (int i = 0; i < 3; ++i)
          centre[f][i] += size[k] / total * (a[i] + corners[nodes[k + 1]][i] + corners[nodes[k + 2]][i]) / 3;
    }
  }

  /// Computes (b - a) x (c - a) / 2.
  KOKKOS_INLINE_FUNCTION static void cross(const Real (&a)[dim], const Real (&b)[dim], const Real (&c)[dim],
                                           Real (&result)[3]) {
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      result[i] = ((b[j] - a[j]) * (c[k] - a[k]) - (b[k] - a[k]) * (c[j] - a[j])) / 2;
    }
  }
};

/// Adds a resistance R, Pa s/m^3, in series with end e: T <- (T^-1 + R e e^T)^-1. Exact for any R >= 0.
template <int n>
KOKKOS_INLINE_FUNCTION void add_resistance(Real (&T)[n][n], int e, Real R) {
  const Real share = 1 / (1 + R * T[e][e]);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      if (i != e && j != e) T[i][j] -= T[i][e] * T[e][j] * R * share;
  for (int i = 0; i < n; ++i) {
    T[i][e] *= share;
    if (i != e) T[e][i] *= share;
  }
}

/// Matrix T of a cell, m^3/(Pa s), symmetric positive definite. It is the sum of A (k/mu) A^T / V, the flow of a
/// constant gradient, and a part that vanishes for constant gradients.
template <Shape shape>
struct FlowMatrix {
  using Faces = CellFaces<shape>;
  static constexpr int dim = Faces::dim, n = Faces::n;
  Real T[n][n] = {};

  KOKKOS_INLINE_FUNCTION FlowMatrix(const Faces& faces, const laws::Mobility& mobility, FluxScheme scheme) {
    if (scheme == FluxScheme::tpfa) {
      for (int f = 0; f < n; ++f) {
        Real distance = 0;
        for (int i = 0; i < dim; ++i) distance += faces.centre[f][i] * faces.centre[f][i];
        T[f][f] = mobility.product<dim>(faces.area[f], faces.centre[f]) / distance;
      }
      return;
    }
    for (int f = 0; f < n; ++f)
      for (int g = 0; g < n; ++g) T[f][g] = mobility.product<dim>(faces.area[f], faces.area[g]) / faces.volume;
    if (scheme == FluxScheme::rt0)
      add_rt0(faces, mobility);
    else
      add_mimetic(faces, mobility);
  }

  /// Closes face e. This is the limit of add_resistance() for large R.
  KOKKOS_INLINE_FUNCTION void close(int e) {
    const Real own = T[e][e];
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        if (i != e && j != e && own > 0) T[i][j] -= T[i][e] * T[e][j] / own;
    for (int i = 0; i < n; ++i) T[i][e] = T[e][i] = 0;
  }

 private:
  /// Adds the second part of rt0. On simplices M_ij = integral phi_i . (k/mu)^-1 phi_j with phi_i = (x - x_i)/(d V),
  /// and T = M^-1. Since the face centres sum to zero, T = A (k/mu) A^T / V + a 1 1^T with 1/a = 1^T M 1.
  KOKKOS_INLINE_FUNCTION void add_rt0(const Faces& faces, const laws::Mobility& mobility) {
    Real S[dim][dim] = {};  // mean of x x^T around the centre
    for (int k = 0; k < dim + 1; ++k)
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j) S[i][j] += faces.corners[k][i] * faces.corners[k][j] / ((dim + 1) * (dim + 2));
    const Real a = dim * dim * faces.volume / ((dim + 1) * (dim + 1) * mobility.resistance<dim>(S));
    for (int f = 0; f < n; ++f)
      for (int g = 0; g < n; ++g) T[f][g] += a;
  }

  /// Adds 6 tr(k/mu)/(d V) |A| (I - Q Q^T) |A|, where Q is an orthonormal basis of the columns of |A| d.
  KOKKOS_INLINE_FUNCTION void add_mimetic(const Faces& faces, const laws::Mobility& mobility) {
    Real size[n], Q[dim][n];
    for (int f = 0; f < n; ++f) {
      size[f] = 0;
      for (int i = 0; i < dim; ++i) size[f] += faces.area[f][i] * faces.area[f][i];
      size[f] = std::sqrt(size[f]);
      for (int i = 0; i < dim; ++i) Q[i][f] = size[f] * faces.centre[f][i];
    }
    for (int i = 0; i < dim; ++i) {
      for (int twice = 0; twice < 2; ++twice)
        for (int k = 0; k < i; ++k) {
          Real dot = 0;
          for (int f = 0; f < n; ++f) dot += Q[i][f] * Q[k][f];
          for (int f = 0; f < n; ++f) Q[i][f] -= dot * Q[k][f];
        }
      Real norm = 0;
      for (int f = 0; f < n; ++f) norm += Q[i][f] * Q[i][f];
      norm = std::sqrt(norm);
      for (int f = 0; f < n; ++f) Q[i][f] /= norm;
    }
    const Real a = 6 * mobility.trace<dim>() / (dim * faces.volume);
    for (int f = 0; f < n; ++f)
      for (int g = 0; g < n; ++g) {
        Real rest = f == g ? 1 : 0;
        for (int i = 0; i < dim; ++i) rest -= Q[i][f] * Q[i][g];
        T[f][g] += a * size[f] * rest * size[g];
      }
  }
};

/// Computes the rows of an entity with n ends from the outward flows q: its balance, and the inflow of each end.
template <int n>
KOKKOS_INLINE_FUNCTION void balance(const Real (&q)[n], Real (&r)[1 + n]) {
  r[0] = 0;
  for (int i = 0; i < n; ++i) {
    r[0] += q[i];
    r[1 + i] = -q[i];
  }
}
/// Computes the derivatives of the rows from those of q.
template <int n, int m>
KOKKOS_INLINE_FUNCTION void balance(const Real (&dq)[n][m], Real (&J)[1 + n][m]) {
  for (int k = 0; k < m; ++k) {
    J[0][k] = 0;
    for (int i = 0; i < n; ++i) {
      J[0][k] += dq[i][k];
      J[1 + i][k] = -dq[i][k];
    }
  }
}

/// Rows of an entity with n ends: the balance sum_i q_i, and -q_i for each end, with
///   q_i = sum_j T_ij ((e - e_j)/c + e e_j lift_j).
/// Flows are mass divided by the density at reference conditions, see laws::Fluid. For constant density
/// q_i = sum_j T_ij (p - p_j + lift_j).
///
/// | symbol | shape  | unit       |                                                     |
/// | x      | 1 + n  | Pa         | pressure of the entity, pressures on its ends       |
/// | r      | 1 + n  | m^3/s      | (2D: m^2/s)                                         |
/// | T      | [n, n] | m^3/(Pa s) |                                                     |
/// | lift   | [n]    | Pa         | rho_0 g . d, d from the entity's centre to an end's |
template <int n>
struct HybridFlow {
  laws::Fluid fluid;
  Real T[n][n], lift[n];

  /// Returns the flow of a fluid whose weight is multiplied by `factor`.
  KOKKOS_INLINE_FUNCTION HybridFlow heavier(Real factor) const {
    HybridFlow result = *this;
    for (Real& each : result.lift) each *= factor;
    return result;
  }
  /// Returns the flow with the potential difference of each end multiplied by a factor.
  KOKKOS_INLINE_FUNCTION HybridFlow scaled(const Real (&factor)[n]) const {
    HybridFlow result = *this;
    for (auto& row : result.T)
      for (int j = 0; j < n; ++j) row[j] *= factor[j];
    return result;
  }
  /// Computes the outward flow through each end.
  KOKKOS_INLINE_FUNCTION void flow(const Real (&x)[1 + n], Real (&q)[n]) const {
    Real drop[n];
    for (int j = 0; j < n; ++j) drop[j] = fluid.drop(x[0], x[1 + j], lift[j]);
    for (int i = 0; i < n; ++i) {
      q[i] = 0;
      for (int j = 0; j < n; ++j) q[i] += T[i][j] * drop[j];
    }
  }

  KOKKOS_INLINE_FUNCTION void residual(const Real (&x)[1 + n], Real (&r)[1 + n]) const {
    Real q[n];
    flow(x, q);
    balance(q, r);
  }

  KOKKOS_INLINE_FUNCTION void jacobian(const Real (&x)[1 + n], Real (&J)[1 + n][1 + n]) const {
    Real dq[n][1 + n];
    dflow(x, dq);
    balance(dq, J);
  }

  /// Computes the derivatives of flow() in x.
  KOKKOS_INLINE_FUNCTION void dflow(const Real (&x)[1 + n], Real (&dq)[n][1 + n]) const {
    Real of_entity[n], of_end[n];
    for (int j = 0; j < n; ++j) {
      of_entity[j] = fluid.ddrop_da(x[0], x[1 + j], lift[j]);
      of_end[j] = fluid.ddrop_db(x[0], x[1 + j], lift[j]);
    }
    for (int i = 0; i < n; ++i) {
      dq[i][0] = 0;
      for (int j = 0; j < n; ++j) {
        dq[i][0] += T[i][j] * of_entity[j];
        dq[i][1 + j] = T[i][j] * of_end[j];
      }
    }
  }
};

/// HybridFlow of entities with a stored matrix T.
///
/// | symbol | shape           | unit       |                                                                 |
/// | x, r   | 1 + n           | Pa, m^3/s  | as in HybridFlow, in the slots of `Unknowns`                    |
/// | T      | [entity, n * n] | m^3/(Pa s) | with a rate m^3/Pa                                              |
/// | lift   | [entity, n]     | Pa         | empty: zero                                                     |
/// | rate   |                 | -, 1/s     | factor of T                                                     |
template <int n, class Unknowns>
struct StoredFlow {
  static constexpr int n_ends = n;
  using Columns = Unknowns;
  using Rows = Unknowns;
  ConstView<Real**> T, lift;
  laws::Fluid fluid = {};
  Real rate = 1;

  KOKKOS_INLINE_FUNCTION HybridFlow<n> at(int e) const {
    HybridFlow<n> result{fluid, {}, {}};
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) result.T[i][j] = T(e, i * n + j);
      result.lift[i] = lift.extent(0) > 0 ? lift(e, i) : 0;
    }
    return result;
  }
  KOKKOS_INLINE_FUNCTION void flow(int e, const Real (&x)[1 + n], Real (&q)[n]) const { flow_of(at(e), x, q); }
  KOKKOS_INLINE_FUNCTION void dflow(int e, const Real (&x)[1 + n], Real (&dq)[n][1 + n]) const {
    dflow_of(at(e), x, dq);
  }
  /// flow() and its derivatives with another HybridFlow in place of at().
  KOKKOS_INLINE_FUNCTION void flow_of(const HybridFlow<n>& here, const Real (&x)[1 + n], Real (&q)[n]) const {
    here.flow(x, q);
  }
  KOKKOS_INLINE_FUNCTION void dflow_of(const HybridFlow<n>& here, const Real (&x)[1 + n], Real (&dq)[n][1 + n]) const {
    here.dflow(x, dq);
  }
  KOKKOS_INLINE_FUNCTION void residual(int e, const Real (&x)[1 + n], Real (&r)[1 + n]) const {
    at(e).residual(x, r);
    for (Real& row : r) row *= rate;
  }
  KOKKOS_INLINE_FUNCTION void jacobian(int e, const Real (&x)[1 + n], Real (&J)[1 + n][1 + n]) const {
    at(e).jacobian(x, J);
    for (auto& row : J)
      for (Real& value : row) value *= rate;
  }
};

/// HybridFlow of one cell through its faces.
///
/// | symbol   | shape         | unit          |                                            |
/// | x        | 1 + faces     | Pa            | pressure of the cell, pressures on faces   |
/// | r        | 1 + faces     | m^3/s         | (2D: m^2/s)                                |
/// | mobility | [number]      | m^2/(Pa s)    | k/mu                                       |
/// | number   | [cell]        | -             | which mobility                             |
/// | weight   | [dim]         | N/m^3         | rho_0 g                                    |
/// | beside   | [cell]        | -             | row of resistance, -1 for none; empty: all |
/// | resistance | [row, face] | Pa s/m^3      | of sides of fractures, 0 for none          |
template <Shape shape>
struct HybridCell {
  using Faces = CellFaces<shape>;
  static constexpr int dim = Faces::dim, n = Faces::n, n_ends = n;
  using Columns = assembly::Slots<assembly::Slot<1, 1>, assembly::Slot<n, 1>>;
  using Rows = Columns;

  assembly::Geometry geometry;
  ConstView<laws::Mobility*> mobility;
  ConstView<int*> number;
  Kokkos::Array<Real, 3> weight;
  FluxScheme scheme;
  laws::Fluid fluid;
  ConstView<int*> beside = {};
  ConstView<Real**> resistance = {};

  KOKKOS_INLINE_FUNCTION HybridFlow<n> at(int cell, const Faces& faces) const {
    FlowMatrix<shape> matrix(faces, mobility(number(cell)), scheme);
    if (beside.extent(0) > 0 && beside(cell) >= 0)
      for (int f = 0; f < n; ++f)
        if (resistance(beside(cell), f) > 0) add_resistance(matrix.T, f, resistance(beside(cell), f));
    HybridFlow<n> result{fluid, {}, {}};
    for (int f = 0; f < n; ++f) {
      for (int g = 0; g < n; ++g) result.T[f][g] = matrix.T[f][g];
      for (int i = 0; i < dim; ++i) result.lift[f] += weight[i] * faces.centre[f][i];
    }
    return result;
  }

  KOKKOS_INLINE_FUNCTION HybridFlow<n> at(int cell) const {
    Real X[mesh::n_nodes(shape)][dim];
    geometry.gather(cell, X);
    return at(cell, Faces(X));
  }
  KOKKOS_INLINE_FUNCTION void flow(int cell, const Real (&x)[1 + n], Real (&q)[n]) const { at(cell).flow(x, q); }
  KOKKOS_INLINE_FUNCTION void dflow(int cell, const Real (&x)[1 + n], Real (&dq)[n][1 + n]) const {
    at(cell).dflow(x, dq);
  }
  KOKKOS_INLINE_FUNCTION void residual(int cell, const Real (&x)[1 + n], Real (&r)[1 + n]) const {
    at(cell).residual(x, r);
  }
  KOKKOS_INLINE_FUNCTION void jacobian(int cell, const Real (&x)[1 + n], Real (&J)[1 + n][1 + n]) const {
    at(cell).jacobian(x, J);
  }
};

}  // namespace sprekk::transport
