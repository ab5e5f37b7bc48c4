// Equivalent radius of a well: the distance at which the exact pressure equals the pressure of the cell.
#pragma once

#include "base/check.hpp"
#include "laws/darcy.hpp"

#include <array>
#include <cmath>
#include <map>
#include <vector>

namespace sprekk::transport {

/// Radial flow around a straight line in a homogeneous, anisotropic body. The pressure is -ln(rho) with
/// rho^2 = x . N x. The flow per length is 2 pi times `conductance`. In 2D the line is perpendicular to the plane.
struct LineFlow {
  std::array<Real, 3> point, along;  ///< point on the line; unit vector along the line
  Real N[3][3];                      ///< m^-1 - m^-1 t t^T m^-1/(t . m^-1 t) for the mobility m and the direction t
  Real conductance;                  ///< sqrt(det(m) t . m^-1 t), m^2/(Pa s); equals m in isotropic rock
  Real stretch;                      ///< mean half axis of the ellipse onto which rho maps a circle around the line

  LineFlow(int dim, laws::Mobility mobility, const std::array<Real, 3>& point, const std::array<Real, 3>& along)
      : point(point), along(along) {
    auto& m = mobility.value;
    if (dim == 2) m[2][2] = 1;
    Real inverse[3][3], det = 0, mt[3] = {}, tmt = 0, trace = 0, square = 0;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const int a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
        inverse[i][j] = m[a][c] * m[b][d] - m[a][d] * m[b][c];
        if (i == 0) det += m[0][j] * inverse[0][j];
      }
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) mt[i] += (inverse[i][j] /= det) * along[j];
    for (int i = 0; i < 3; ++i) tmt += along[i] * mt[i];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        N[i][j] = inverse[i][j] - mt[i] * mt[j] / tmt;
        trace += i == j ? N[i][j] : 0;
        square += N[i][j] * N[i][j];
      }
    conductance = std::sqrt(det * tmt);
    stretch = std::sqrt(trace + std::sqrt(2 * std::max<Real>(trace * trace - square, 0))) / 2;
  }

  Real log_distance(const std::array<Real, 3>& x) const {
    Real square = 0;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) square += (x[i] - point[i]) * N[i][j] * (x[j] - point[j]);
    return std::log(square) / 2;
  }
};

/// Entity of a patch around a well: flow matrix, inflow from the well, and ends.
struct WellPatchEntity {
  std::vector<Real> T;  ///< [end * n + end]
  Real source;
  std::vector<LocalIndex> ends;  ///< numbers of the ends, the same in all entities of the patch
};

/// Equivalent radius of squares with two-point fluxes, exp(-gamma)/4, relative to sqrt(a^2 + b^2) with edges a, b.
constexpr Real two_point_radius = 0.140364870891722;

/// Bias of the logarithm due to exact pressures on the outer ends of the patch, calibrated on uniform meshes. It is
/// 0.07 on squares, 0.06 on half squares and 0.04 on Delaunay triangles.
constexpr Real patch_bias = 0.05;

/// Logarithm of the equivalent radius of the first entity of a patch. Peaceman (1978) solves for the pressures of all
/// cells of a uniform mesh. Here the unknowns are the pressures of the patch, and its outer ends have exact pressures.
/// `outside(end)`: mean of ln(rho) on an outer end, or NaN for an impermeable end.
template <class Outside>
Real log_equivalent_radius(const std::vector<WellPatchEntity>& patch, const Outside& outside) {
  std::map<LocalIndex, int> number;  // ends between two entities
  for (const auto& entity : patch)
    for (const LocalIndex end : entity.ends) ++number[end];
  std::map<LocalIndex, Real> known;
  int n = 0;
  for (auto& [end, count] : number) {
    const Real log = count < 2 ? outside(end) : std::nan("");
    if (!std::isnan(log)) known[end] = -log;
    count = std::isnan(log) ? n++ : -1;
  }
  std::vector<Real> A(n * n, 0), b(n, 0), p(n);
  for (const auto& entity : patch) {
    const int m = static_cast<int>(entity.ends.size());
    std::vector<Real> row(m, 0);
    Real all = 0;
    for (int i = 0; i < m; ++i)
      for (int j = 0; j < m; ++j) {
        row[i] += entity.T[i * m + j];
        all += entity.T[i * m + j];
      }
    for (int i = 0; i < m; ++i) {
      const int r = number.at(entity.ends[i]);
      if (r < 0) continue;
      b[r] += entity.source * row[i] / all;
      for (int j = 0; j < m; ++j) {
        const Real value = entity.T[i * m + j] - row[i] * row[j] / all;
        const int c = number.at(entity.ends[j]);
        if (c < 0)
          b[r] -= value * known.at(entity.ends[j]);
        else
          A[r * n + c] += value;
      }
    }
  }
  for (int k = 0; k < n; ++k) {  // A = L L^T
    for (int j = 0; j < k; ++j)
      for (int i = k; i < n; ++i) A[i * n + k] -= A[i * n + j] * A[k * n + j];
    const Real root = std::sqrt(A[k * n + k]);
    for (int i = k; i < n; ++i) A[i * n + k] /= root;
  }
  for (int k = 0; k < n; ++k) {
    p[k] = b[k];
    for (int j = 0; j < k; ++j) p[k] -= A[k * n + j] * p[j];
    p[k] /= A[k * n + k];
  }
  for (int k = n - 1; k >= 0; --k) {
    for (int j = k + 1; j < n; ++j) p[k] -= A[j * n + k] * p[j];
    p[k] /= A[k * n + k];
  }
  const auto& first = patch.front();
  const int m = static_cast<int>(first.ends.size());
  Real sum = first.source, all = 0;
  for (int i = 0; i < m; ++i) {
    const int r = number.at(first.ends[i]);
    for (int j = 0; j < m; ++j) {
      sum += first.T[i * m + j] * (r < 0 ? known.at(first.ends[i]) : p[r]);
      all += first.T[i * m + j];
    }
  }
  return -sum / all - patch_bias;
}

}  // namespace sprekk::transport
