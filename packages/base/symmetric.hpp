// Symmetric tensors.
#pragma once

#include "base/types.hpp"

#include <algorithm>
#include <array>
#include <cmath>

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

/// Returns the largest eigenvalue of a symmetric tensor XX, YY, ZZ, XY[, YZ, XZ].
template <class Tensor>
Real largest_principal(const Tensor& s) {
  const Real xy = s[3], yz = s.size() > 4 ? s[4] : 0, xz = s.size() > 4 ? s[5] : 0;
  const Real mean = (s[0] + s[1] + s[2]) / 3, a = s[0] - mean, b = s[1] - mean, c = s[2] - mean;
  const Real p = std::sqrt((a * a + b * b + c * c + 2 * (xy * xy + yz * yz + xz * xz)) / 6);
  if (p == 0) return mean;
  const Real det = a * (b * c - yz * yz) - xy * (xy * c - yz * xz) + xz * (xy * yz - b * xz);
  return mean + 2 * p * std::cos(std::acos(std::clamp(det / (2 * p * p * p), Real(-1), Real(1))) / 3);
}

}  // namespace sprekk::base
