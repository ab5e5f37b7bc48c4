// Matrices for coarsening, and vectors on their nodes.
#pragma once

#include <Teuchos_CommHelpers.hpp>
#include <Tpetra_Core.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "multigrid/multigrid.hpp"

namespace sprekk::test {

using fields::CrsMatrix;
using fields::Map;
using fields::MultiVector;
using fields::Vector;
using fields::wrapped;
using multigrid::NodeMatrix;

/// Bars between all nodes of a lattice [n, n, height] with a distance of at most sqrt(3). Each bar has its own
/// stiffness, and rigid motions have zero energy.
/// `constrained`: nodes with x = 0 are prescribed. `skew`: the matrix is unsymmetric, with translations still in its
/// kernel.
/// `few`: only the 14 bars per node that are edges when each cube is divided into six tetrahedra.
struct Truss {
  explicit Truss(int n_, bool constrained = false, Real skew = 0, int height_ = 0, bool few_ = false)
      : n(n_), height(height_ > 0 ? height_ : n_), few(few_) {
    const auto comm = Tpetra::getDefaultComm();
    const int n_nodes = n * n * height, rank = comm->getRank(), size = comm->getSize();
    std::vector<GlobalIndex> unknowns;  // partition with unequal parts
    for (GlobalIndex i = 3 * (GlobalIndex(n_nodes) * rank * rank / (size * size)),
                     end = 3 * (GlobalIndex(n_nodes) * (rank + 1) * (rank + 1) / (size * size));
         i < end; ++i)
      unknowns.push_back(i);
    map = rcp(new Map(3 * n_nodes, Teuchos::arrayViewFromVector(unknowns), 0, comm));
    matrix = rcp(new CrsMatrix(map, 81));
    modes = rcp(new MultiVector(map, 6));
    for (LocalIndex i = 0; i < static_cast<LocalIndex>(unknowns.size()); i += 3)
      add(unknowns[i] / 3, i, constrained, skew);
    matrix->fillComplete();
  }

  std::array<int, 3> place(GlobalIndex node) const { return {int(node % n), int(node / n % n), int(node / n / n)}; }

  void add(GlobalIndex node, LocalIndex row, bool constrained, Real skew) {
    const auto p = place(node);
    Real diagonal[3][3] = {};
    for (int k = 0; k < 27; ++k) {
      const std::array<int, 3> d = {k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1}, q = {p[0] + d[0], p[1] + d[1], p[2] + d[2]};
      const int square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
      const auto [minimum, maximum] = std::minmax_element(d.begin(), d.end());
      if (few && *minimum < 0 && *maximum > 0) continue;
      if (square == 0 || *std::min_element(q.begin(), q.end()) < 0 || std::max(q[0], q[1]) >= n || q[2] >= height)
        continue;
      const GlobalIndex other = q[0] + n * (q[1] + GlobalIndex(n) * q[2]);
      const Real stiffness = (1.5 + std::sin(Real(std::min(node, other) * 7 + std::max(node, other)))) / square;
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) {
          const bool prescribed = constrained && (p[0] == 0 || q[0] == 0);
          const Real value = stiffness * d[a] * d[b] + (a == b ? skew * (node < other ? 1 : -1) : 0);
          diagonal[a][b] += value;
          const Real entry = prescribed ? 0 : -value;
          const GlobalIndex column = 3 * other + b;
          matrix->insertGlobalValues(3 * node + a, 1, &entry, &column);
        }
    }
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) {
        const Real entry = constrained && p[0] == 0 ? Real(a == b) : diagonal[a][b];
        const GlobalIndex column = 3 * node + b;
        matrix->insertGlobalValues(3 * node + a, 1, &entry, &column);
      }
    for (int a = 0; a < 3; ++a) {
      const int b = (a + 1) % 3, c = (a + 2) % 3;  // rotation a: x_b -> x_c
      modes->replaceLocalValue(row + a, a, 1.0);
      modes->replaceLocalValue(row + c, 3 + a, Real(p[b]));
      modes->replaceLocalValue(row + b, 3 + a, -Real(p[c]));
    }
  }

  int n, height;
  bool few;
  RCP<Map> map;
  RCP<CrsMatrix> matrix;
  RCP<MultiVector> modes;
};

inline View<Real*> random_vector(LocalIndex n_all, int width, unsigned seed) {
  std::mt19937 generator(seed + 100 * Tpetra::getDefaultComm()->getRank());
  std::uniform_real_distribution<Real> uniform(-1, 1);
  const View<Real*> x("x", static_cast<std::size_t>(n_all) * width);
  for (std::size_t i = 0; i < x.extent(0); ++i) x(i) = uniform(generator);
  return x;
}

inline View<Real*> zeros(LocalIndex n, int width) { return View<Real*>("zeros", static_cast<std::size_t>(n) * width); }

inline Real dot(const View<Real*>& x, const View<Real*>& y, std::size_t n) {
  Real here = 0, all = 0;
  for (std::size_t i = 0; i < n; ++i) here += x(i) * y(i);
  Teuchos::reduceAll(*Tpetra::getDefaultComm(), Teuchos::REDUCE_SUM, 1, &here, &all);
  return all;
}

}  // namespace sprekk::test
