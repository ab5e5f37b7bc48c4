// Matrices with two bytes per number: rounding errors, independence of the processor, and symmetry.
#include "multigrid/rounded_matrix.hpp"

#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace sprekk::test {
namespace {

using fields::Map;
using multigrid::NodeMatrix;
using multigrid::RoundedMatrix;

constexpr LocalIndex n = 41;  // nodes per rank

Real number(std::size_t i, std::size_t j) { return std::cos(1.0 + 7 * i + 13 * j + i * j); }

/// Matrix without ghosts. Row i couples to (i + 1) % 7 nodes: some rows to none, the last row to six.
template <int b>
NodeMatrix some_matrix() {
  const auto map = rcp(new Map(n * Tpetra::getDefaultComm()->getSize(), n, 0, Tpetra::getDefaultComm()));
  NodeMatrix A{b, b, {std::make_shared<fields::Halo>(map, map), View<std::size_t*>("start", n + 1), {}}, {}};
  std::vector<LocalIndex> columns;
  for (LocalIndex i = 0; i < n; ++i) {
    for (LocalIndex k = 0; k < (i + 1) % 7; ++k) columns.push_back((i + 5 * k) % n);
    A.graph.start(i + 1) = columns.size();
  }
  A.graph.column = View<LocalIndex*>("column", columns.size());
  std::copy(columns.begin(), columns.end(), A.graph.column.data());
  A.value = View<Real*>("value", b * b * columns.size());
  for (std::size_t k = 0; k < A.value.extent(0); ++k) A.value(k) = number(k, 1);
  return A;
}

View<Real*> vector_of(std::size_t size, std::size_t seed) {
  const View<Real*> x("x", size);
  for (std::size_t i = 0; i < size; ++i) x(i) = number(i, seed);
  return x;
}

template <int b>
View<Real*> product(const RoundedMatrix& A, const View<Real*>& x, bool wide) {
  const View<Real*> y("y", x.extent(0));
  A.multiply<b>(
      x, [y](LocalIndex i, const Real* sum) { std::copy_n(sum, b, &y(b * i)); }, wide);
  return y;
}

/// Checks products to half a rounding unit per row times the sum of |x|, with common and with wide instructions of the
/// processor.
template <int b>
void expect_near_products() {
  const auto A = some_matrix<b>();
  const LocalIndex larger = 3;  // this node's rows have values above 1
  for (std::size_t k = A.graph.start(larger); k < A.graph.start(larger + 1); ++k) A.value(b * b * k) *= 50;
  const auto scale = vector_of(b * n, 2), x = vector_of(b * n, 3);
  for (std::size_t i = 0; i < scale.extent(0); ++i) scale(i) = 0.5 + std::fabs(scale(i)) / 2;
  RoundedMatrix rounded(A);
  rounded.update(A, scale);
  for (const bool wide : {false, true}) {
    if (wide && !fields::has_wide_instructions()) continue;
    const auto y = product<b>(rounded, x, wide);
    for (LocalIndex row = 0; row < b * n; ++row) {
      const std::size_t begin = A.graph.start(row / b), length = A.graph.start(row / b + 1) - begin;
      Real sum = 0, sizes = 0, maximum = 1;
      for (std::size_t k = 0; k < length; ++k)
        for (int c = 0; c < b; ++c) {
          const LocalIndex column = b * A.graph.column(begin + k) + c;
          const Real a = A.value(b * b * begin + (row % b * length + k) * b + c) * scale(row) * scale(column);
          sum += a * x(column);
          sizes += std::fabs(x(column));
          maximum = std::fmax(maximum, std::fabs(a));
        }
      EXPECT_NEAR(y(row), sum, 1.01 * maximum / 65280 * sizes) << b << ' ' << row << ' ' << wide;
    }
  }
}

TEST(RoundedMatrix, MultipliesToHalfAUnit) {
  expect_near_products<1>();
  expect_near_products<2>();
  expect_near_products<3>();
  expect_near_products<6>();
}

/// Halves and thirds that differ between the two triangles in the last bit.
TEST(RoundedMatrix, StaysSymmetric) {
  const auto map = rcp(new Map(3 * Tpetra::getDefaultComm()->getSize(), 3, 0, Tpetra::getDefaultComm()));
  NodeMatrix A{
      1,
      1,
      {std::make_shared<fields::Halo>(map, map), View<std::size_t*>("start", 4), View<LocalIndex*>("column", 9)},
      View<Real*>("value", 9)};
  const Real up = 1 + std::numeric_limits<Real>::epsilon(), down = 1 - std::numeric_limits<Real>::epsilon();
  const Real values[] = {1, -0.5 * up, up / 3, -0.5 * down, 1, 0.1234, down / 3, 0.1234, 1};
  for (int k = 0; k < 9; ++k) {
    A.graph.start(k / 3 + 1) = k + 1;
    A.graph.column(k) = k % 3;
    A.value(k) = values[k];
  }
  const View<Real*> one("one", 3);
  Kokkos::deep_copy(one, 1);
  RoundedMatrix rounded(A);
  rounded.update(A, one);
  Real found[3][3];
  for (int c = 0; c < 3; ++c) {
    const View<Real*> unit("unit", 3);
    unit(c) = 1;
    const auto column = product<1>(rounded, unit, false);
    for (int r = 0; r < 3; ++r) found[r][c] = column(r);
  }
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) EXPECT_EQ(found[r][c], found[c][r]);
  EXPECT_NE(found[0][1], 0);
}

/// Values that are not finite stay so.
TEST(RoundedMatrix, WhatIsNoNumberStaysNone) {
  const auto A = some_matrix<3>();
  const View<Real*> one("one", 3 * n);
  Kokkos::deep_copy(one, 1);
  RoundedMatrix rounded(A);
  for (const Real bad : {std::numeric_limits<Real>::quiet_NaN(), std::numeric_limits<Real>::infinity()}) {
    A.value(9 * A.graph.start(5)) = bad;
    rounded.update(A, one);
    const auto y = product<3>(rounded, vector_of(3 * n, 3), fields::has_wide_instructions());
    EXPECT_FALSE(std::isfinite(y(15)));
    EXPECT_TRUE(std::isfinite(y(18)));
  }
}

}  // namespace
}  // namespace sprekk::test
