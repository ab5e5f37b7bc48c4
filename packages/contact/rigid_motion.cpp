#include "contact/rigid_motion.hpp"

#include "base/check.hpp"

#include <Teuchos_LAPACK.hpp>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace sprekk::contact {

using mesh::Vector;
using mesh::operator+;
using mesh::operator-;
using mesh::operator*;

RigidRow rigid_row(const RigidFrame& frame, const Vector& x, int i) {
  const Vector arm = (1 / frame.size) * (x - frame.centre);
  RigidRow row{};
  row[i] = 1;
  row[3 + (i + 1) % 3] = arm[(i + 2) % 3];  // (e_k x arm)_i
  row[3 + (i + 2) % 3] = -arm[(i + 1) % 3];
  return row;
}

Vector rigid_displacement(const RigidFrame& frame, const RigidRow& q, const Vector& x) {
  const Vector translation{q[0], q[1], q[2]}, turn{q[3], q[4], q[5]};
  return translation + (1 / frame.size) * mesh::cross(turn, x - frame.centre);
}

void add_product(RigidBlock& block, const RigidRow& a, const RigidRow& b, Real sign) {
  for (int k = 0; k < 6; ++k)
    for (int l = 0; l < 6; ++l) block[k][l] += sign * a[k] * b[l];
}

std::vector<int> rigid_modes(int dim) {
  return dim == 2 ? std::vector<int>{0, 1, 5} : std::vector<int>{0, 1, 2, 3, 4, 5};
}

std::vector<std::vector<Real>> null_space(std::vector<Real> matrix, int n) {
  std::vector<Real> eigenvalues(n), work(8 * n);
  int info = 0;
  Teuchos::LAPACK<int, Real>().SYEV('V', 'U', n, matrix.data(), n, eigenvalues.data(), work.data(), 8 * n, &info);
  SPREKK_CHECK(info == 0, "rigid motions: LAPACK's SYEV failed with {}", info);
  std::vector<std::vector<Real>> vectors;
  for (int k = 0; k < n && eigenvalues[k] <= negligible * negligible * eigenvalues[n - 1]; ++k)
    vectors.emplace_back(matrix.begin() + k * n, matrix.begin() + (k + 1) * n);
  return vectors;
}

void reduce(std::vector<std::vector<Real>>& rows, const std::function<bool(std::size_t)>& first) {
  std::size_t done = 0;
  for (bool wanted : {true, false})
    for (; done < rows.size(); ++done) {
      std::size_t pivot_row = done, pivot = 0;
      Real largest = 0;
      for (std::size_t r = done; r < rows.size(); ++r)
        for (std::size_t c = 0; c < rows[r].size(); ++c)
          if (first(c) == wanted && std::abs(rows[r][c]) > (1 + negligible) * largest) {
            largest = std::abs(rows[r][c]);
            pivot_row = r;
            pivot = c;
          }
      if (largest <= negligible) break;
      std::swap(rows[done], rows[pivot_row]);
      for (Real& value : rows[done]) value /= largest;
      if (rows[done][pivot] < 0)
        for (Real& value : rows[done]) value = -value;
      for (std::size_t r = 0; r < rows.size(); ++r) {
        const Real factor = rows[r][pivot];
        if (r == done) continue;
        for (std::size_t c = 0; c < rows[r].size(); ++c) rows[r][c] -= factor * rows[done][c];
      }
    }
}

FreeMotion free_motion(int body, const RigidFrame& frame, const RigidRow& q) {
  FreeMotion motion{body, {}, {}, frame.centre};
  Real largest = 0;
  for (Real value : q) largest = std::max(largest, std::abs(value));
  for (int c = 0; c < 6; ++c) {
    const Real value = std::abs(q[c]) > negligible * largest ? q[c] : 0;
    (c < 3 ? motion.translation[c] : motion.rotation[c - 3]) = c < 3 ? value : value / frame.size;
  }
  return motion;
}

std::string to_text(const Vector& x, int dim, Real scale) {
  std::vector<std::string> components;
  for (int i = 0; i < dim; ++i)
    components.push_back(fmt::format("{:.6g}", std::abs(x[i]) > negligible * scale ? x[i] : 0));
  return fmt::format("({})", fmt::join(components, ", "));
}

std::string to_text(const FreeMotion& motion, int dim) {
  const Vector &t = motion.translation, &w = motion.rotation;
  const Real speed = mesh::norm(t), turning = mesh::norm(w);
  if (turning == 0) return "can move along " + to_text((1 / speed) * t, dim, 1);
  const Vector axis = (1 / turning) * w, to_axis = (1 / turning) * mesh::cross(axis, t);
  const auto through = to_text(motion.centre + to_axis, dim, mesh::norm(motion.centre) + mesh::norm(to_axis));
  if (dim == 2) return "can rotate about " + through;
  const bool screws = std::abs(mesh::dot(axis, t)) > negligible * speed;
  return fmt::format("can rotate about the axis {} through {}{}", to_text(axis, dim, 1), through,
                     screws ? " while it moves along it" : "");
}

}  // namespace sprekk::contact
