// Flow code of a host: finite volumes with two-point fluxes on its own grid, independent of Sprekk.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace hosts {

/// Closed box with one fracture in a plane y = constant: n cells with edges h, m. In 2D n[2] = 1, h[2] = 1.
struct Grid {
  std::array<int, 3> n;
  std::array<double, 3> h;
  int plane;                          ///< the fracture is at the lower y face of cells with this y index
  std::array<int, 2> from_x, from_z;  ///< first cell of the fracture, and the one after its last

  int n_cells() const { return n[0] * n[1] * n[2]; }
  int n_faces() const { return (from_x[1] - from_x[0]) * (from_z[1] - from_z[0]); }
  int cell(int i, int j, int k) const { return i + n[0] * (j + n[1] * k); }
  int face(int i, int k) const {
    const bool in = i >= from_x[0] && i < from_x[1] && k >= from_z[0] && k < from_z[1];
    return in ? i - from_x[0] + (from_x[1] - from_x[0]) * (k - from_z[0]) : -1;
  }
  int at(double x, int axis) const { return static_cast<int>(std::floor(x / h[axis])); }
  /// cell_at: number of the cell at x, m. face_at: number of the fracture face above or below x; -1: none.
  int cell_at(const std::array<double, 3>& x) const {
    return cell(at(x[0], 0), at(x[1], 1), n[2] > 1 ? at(x[2], 2) : 0);
  }
  int face_at(const std::array<double, 3>& x) const { return face(at(x[0], 0), n[2] > 1 ? at(x[2], 2) : 0); }
};

struct Fluid {
  double mobility;           ///< rock, k/mu, m^2/(Pa s)
  double storage;            ///< rock at constant strain, 1/M, 1/Pa
  double stabilisation;      ///< alpha^2/(4 (lambda + 2G)), 1/Pa; times h^2: mobility of dp/dt, see docs/model/flow.md
  double viscosity;          ///< Pa s
  double aperture, minimum;  ///< fracture: initial aperture, smallest hydraulic aperture, m
  double injection;          ///< rate of injection into the fracture, proportional to time, m/s^2

  double transmissibility(double widening) const {
    return std::pow(std::max(minimum, aperture + widening), 3) / (12 * viscosity);
  }
};

/// Pressures of cells, then of fracture faces, Pa; or the volume available to the fluid, in the same order: gained pore
/// volume of cells, m^3, and aperture change of faces, m.
using Values = std::vector<double>;

/// Solves A x = b by Gaussian elimination with partial pivoting. b is overwritten by x.
inline void solve(std::vector<Values>& A, Values& b) {
  const int n = static_cast<int>(b.size());
  for (int k = 0; k < n; ++k) {
    int pivot = k;
    for (int i = k + 1; i < n; ++i)
      if (std::abs(A[i][k]) > std::abs(A[pivot][k])) pivot = i;
    std::swap(A[k], A[pivot]);
    std::swap(b[k], b[pivot]);
    for (int i = k + 1; i < n; ++i) {
      const double factor = A[i][k] / A[k][k];
      if (factor == 0) continue;
      for (int j = k; j < n; ++j) A[i][j] -= factor * A[k][j];
      b[i] -= factor * b[k];
    }
  }
  for (int k = n - 1; k >= 0; --k) {
    for (int j = k + 1; j < n; ++j) b[k] -= A[k][j] * b[j];
    b[k] /= A[k][k];
  }
}

/// Implicit time steps, each for a given volume available to the fluid.
class Reservoir {
 public:
  Reservoir(const Grid& grid, const Fluid& fluid) : grid_(grid), fluid_(fluid), old_(size(), 0), old_room_(size(), 0) {}

  int size() const { return grid_.n_cells() + grid_.n_faces(); }

  /// Returns the pressures at the end t of a step dt with the volumes `room`, which were found for the pressures
  /// `last`. The change of the volumes with pressure is approximated by `yields` (rock, 1/Pa; fracture, m/Pa).
  Values pressures(double t, double dt, const Values& room, const Values& last, const std::array<double, 2>& yields) {
    A_.assign(size(), Values(size(), 0));
    b_.assign(size(), 0);
    const auto& h = grid_.h;
    const double volume = h[0] * h[1] * h[2], area = h[0] * h[2];
    for (int row = 0; row < size(); ++row) {
      const bool of_rock = row < grid_.n_cells();
      const double stored = of_rock ? volume * fluid_.storage : 0;
      const double guess = of_rock ? volume * yields[0] : area * yields[1];
      A_[row][row] = stored + guess;
      b_[row] = stored * old_[row] + guess * last[row] - (of_rock ? 1 : area) * (room[row] - old_room_[row]);
      if (!of_rock) b_[row] += dt * area * fluid_.injection * t;
    }
    connect(dt, room);
    solve(A_, b_);
    return b_;
  }

  /// Accepts the step.
  void accept(const Values& pressures, const Values& room) {
    old_ = pressures;
    old_room_ = room;
  }

 private:
  /// Adds the flow from a to b in dt: T dt (p_a - p_b), plus `rate` times the increase of this difference.
  void flow(int a, int b, double T_dt, double rate) {
    for (const auto [from, to] : {std::array{a, b}, std::array{b, a}}) {
      A_[from][from] += T_dt + rate;
      A_[from][to] -= T_dt + rate;
      b_[from] += rate * (old_[from] - old_[to]);
    }
  }

  void connect(double dt, const Values& room) {
    const auto& n = grid_.n;
    const auto& h = grid_.h;
    const int first_face = grid_.n_cells();
    const double volume = h[0] * h[1] * h[2];
    const auto transmissibility = [&](int face) { return fluid_.transmissibility(room[first_face + face]); };
    for (int k = 0; k < n[2]; ++k)
      for (int j = 0; j < n[1]; ++j)
        for (int i = 0; i < n[0]; ++i) {
          const std::array<int, 3> here = {i, j, k};
          const int face = grid_.face(i, k);
          for (int axis = 0; axis < 3; ++axis) {
            if (here[axis] + 1 == n[axis]) continue;
            auto next = here;
            ++next[axis];
            const int a = grid_.cell(i, j, k), b = grid_.cell(next[0], next[1], next[2]);
            const double T = volume / (h[axis] * h[axis]);  // divided by the mobility
            if (axis == 1 && next[1] == grid_.plane && face >= 0) {
              for (const int cell : {a, b}) flow(cell, first_face + face, 2 * T * fluid_.mobility * dt, 0);
            } else {
              flow(a, b, T * fluid_.mobility * dt, T * fluid_.stabilisation * h[axis] * h[axis]);
            }
            const int next_face = axis == 1 ? -1 : grid_.face(next[0], next[2]);
            if (j > 0 || face < 0 || next_face < 0) continue;
            const double Ta = transmissibility(face), Tb = transmissibility(next_face);
            flow(first_face + face, first_face + next_face, 2 * Ta * Tb / (Ta + Tb) * h[2 - axis] / h[axis] * dt, 0);
          }
        }
  }

  Grid grid_;
  Fluid fluid_;
  Values old_, old_room_, b_;
  std::vector<Values> A_;
};

}  // namespace hosts
