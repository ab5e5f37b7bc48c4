// Linear elasticity in one cell, as a local operator.
#pragma once

#include "assembly/cell_nodes.hpp"
#include "assembly/slots.hpp"
#include "base/host_table.hpp"
#include "laws/elasticity.hpp"

namespace sprekk::physics {

using mesh::Shape;

/// Elastic forces r = integral sigma(u) : grad N over one cell.
///
/// | symbol   | shape            | unit |                                   |
/// | x        | [node, dim]      | m    | displacement of the cell's nodes  |
/// | r        | [node, dim]      | N    | forces                            |
/// | geometry | see Geometry     | m    |                                   |
/// | law      | [cell]           | -    | number of the cell's material     |
/// | material | [number]         | Pa   | Lame's constants                  |
/// | reference | [node, node, dim, dim] | - | see reference_products()        |
template <Shape shape>
struct ElasticCell {
  using Cell = assembly::ReferenceCell<shape>;
  static constexpr int dim = Cell::dim, n = Cell::n_nodes;
  using Columns = assembly::Slots<assembly::Slot<n, dim>>;
  using Rows = Columns;

  assembly::Geometry geometry;
  ConstView<laws::Elasticity*> material;
  ConstView<int*> law;
  ConstView<Real[n][n][dim][dim]> reference = reference_products();

  /// Calls add(volume, g) at the quadrature points of a cell, with the volume of the point and the spatial gradients of
  /// the shape functions.
  template <class Add>
  KOKKOS_INLINE_FUNCTION void for_each_point(int cell, const Add& add) const {
    Real X[n][dim];
    geometry.gather(cell, X);
    assembly::with_rule<shape, assembly::StiffnessQuadrature<shape>>(X, [&](const auto& rule) {
      Real xi[dim], dN[n][dim], g[n][dim];
      for (int q = 0; q < rule.n; ++q) {
        const Real weight = rule.at(q, xi);
        Cell::gradients(xi, dN);
        const assembly::CellPoint<shape> point(X, dN);
        for (int a = 0; a < n; ++a) point.gradient(dN[a], g[a]);
        add(weight * point.volume, g);
      }
    });
  }

  KOKKOS_INLINE_FUNCTION void stress(const Real (&g)[n][dim], const Real (&x)[n * dim], int number,
                                     Real (&sigma)[dim][dim]) const {
    Real H[dim][dim] = {};
    for (int a = 0; a < n; ++a)
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j) H[i][j] += x[a * dim + i] * g[a][j];
    material(number).stress(H, sigma);
  }

  KOKKOS_INLINE_FUNCTION void residual(int cell, const Real (&x)[n * dim], Real (&r)[n * dim]) const {
    for (Real& value : r) value = 0;
    for_each_point(cell, [&](Real volume, const Real(&g)[n][dim]) {
      Real sigma[dim][dim];
      stress(g, x, law(cell), sigma);
      for (int a = 0; a < n; ++a)
        for (int i = 0; i < dim; ++i)
          for (int j = 0; j < dim; ++j) r[a * dim + i] += volume * sigma[i][j] * g[a][j];
    });
  }

  KOKKOS_INLINE_FUNCTION void jacobian(int cell, const Real (&)[n * dim], Real (&K)[n * dim][n * dim]) const {
    const laws::Elasticity elasticity = material(law(cell));
    for_each_product(cell, K, [&](int a, int b, const Real(&M)[dim][dim]) {
      Real block[dim][dim];
      elasticity.stiffness(M, block);
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j) K[a * dim + i][b * dim + j] = K[b * dim + j][a * dim + i] = block[i][j];
    });
  }

  /// Calls use(a, b, M) for b >= a with M_ij = integral d_i N_a d_j N_b. Block (a, b) of `work` may be overwritten by
  /// `use`.
  template <class Use>
  KOKKOS_INLINE_FUNCTION void for_each_product(int cell, Real (&work)[n * dim][n * dim], const Use& use) const {
    Real X[n][dim], M[dim][dim];
    geometry.gather(cell, X);
    if constexpr (assembly::StiffnessQuadrature<shape>::n == 1) {
      for_each_point(cell, [&](Real volume, const Real(&g)[n][dim]) {
        for (int a = 0; a < n; ++a)
          for (int b = a; b < n; ++b) {
            for (int i = 0; i < dim; ++i)
              for (int j = 0; j < dim; ++j) M[i][j] = volume * g[a][i] * g[b][j];
            use(a, b, M);
          }
      });
    } else if (Cell::is_affine(X)) {
      for_each_affine_product(X, use);
    } else {
      for (auto& row : work)
        for (Real& value : row) value = 0;
      for_each_point(cell, [&](Real volume, const Real(&g)[n][dim]) {
        for (int a = 0; a < n; ++a)
          for (int i = 0; i < dim; ++i) {
            const Real factor = volume * g[a][i];
            for (int b = a; b < n; ++b)
              for (int j = 0; j < dim; ++j) work[a * dim + i][b * dim + j] += factor * g[b][j];
          }
      });
      for (int a = 0; a < n; ++a)
        for (int b = a; b < n; ++b) {
          for (int i = 0; i < dim; ++i)
            for (int j = 0; j < dim; ++j) M[i][j] = work[a * dim + i][b * dim + j];
          use(a, b, M);
        }
    }
  }

  /// Does the same for an affine map of the reference cell.
  template <class Use>
  KOKKOS_INLINE_FUNCTION void for_each_affine_product(const Real (&X)[n][dim], const Use& use) const {
    Real xi[dim], dN[n][dim], half[dim][dim], M[dim][dim];
    Cell::centre(xi);
    Cell::gradients(xi, dN);
    const assembly::CellPoint<shape> point(X, dN);
    for (int a = 0; a < n; ++a)
      for (int b = a; b < n; ++b) {
        for (int k = 0; k < dim; ++k)
          for (int j = 0; j < dim; ++j) {
            half[k][j] = 0;
            for (int l = 0; l < dim; ++l) half[k][j] += point.volume * reference(a, b, k, l) * point.inverse[l][j];
          }
        for (int i = 0; i < dim; ++i)
          for (int j = 0; j < dim; ++j) {
            M[i][j] = 0;
            for (int k = 0; k < dim; ++k) M[i][j] += point.inverse[k][i] * half[k][j];
          }
        use(a, b, M);
      }
  }

  /// Integrals of dN_a/dxi_k dN_b/dxi_l over the reference cell, [node, node, component, component].
  static View<Real[n][n][dim][dim]> reference_products() {
    const base::HostTable<Real[n][n][dim][dim]> products("reference products");
    using Rule = assembly::StiffnessQuadrature<shape>;
    Real xi[dim], dN[n][dim];
    for (int q = 0; q < Rule::n; ++q) {
      const Real weight = Rule::at(q, xi);
      Cell::gradients(xi, dN);
      for (int a = 0; a < n; ++a)
        for (int b = 0; b < n; ++b)
          for (int k = 0; k < dim; ++k)
            for (int l = 0; l < dim; ++l) products(a, b, k, l) += weight * dN[a][k] * dN[b][l];
    }
    return products.on_device();
  }
};

}  // namespace sprekk::physics
