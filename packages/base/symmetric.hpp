// Symmetric tensors.
#pragma once

#include "base/types.hpp"

#include <array>

namespace sprekk::base {

/// Symmetric tensors stored by their components XX, YY[, ZZ], XY[, YZ, XZ].
template <int dim>
struct Symmetric {
  static constexpr int n = dim * (dim + 1) / 2;
  using Values = std::array<Real, n>;
  static constexpr int row(int k) { return k < dim ? k : k == 4 ? 1 : 0; }
  static constexpr int column(int k) { return k < dim ? k : k == 3 || dim == 2 ? 1 : 2; }
  /// Returns a : b.
  static Real product(const Values& a, const Values& b) {
    Real sum = 0;
    for (int k = 0; k < n; ++k) sum += (k < dim ? 1 : 2) * a[k] * b[k];
    return sum;
  }
  /// Returns a v + b tr(v) I.
  static Values isotropic(const Values& v, Real a, Real b) {
    Real trace = 0;
    for (int i = 0; i < dim; ++i) trace += v[i];
    Values result;
    for (int k = 0; k < n; ++k) result[k] = a * v[k] + (k < dim ? b * trace : 0);
    return result;
  }
};

}  // namespace sprekk::base
