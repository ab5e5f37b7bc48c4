// Gathering of distributed vectors and matrices on every rank, and a dense solver in extended precision for
// comparisons.
#pragma once

#include "fake_problems.hpp"

namespace sprekk::test {

using Dense = std::vector<std::vector<long double>>;

inline std::vector<Real> gather(const Vector& v) {
  std::vector<Real> here(v.getGlobalLength()), all(here.size());
  for (std::size_t i = 0; i < v.getLocalLength(); ++i) here[v.getMap()->getGlobalElement(i)] = v.getData()[i];
  Teuchos::reduceAll(*v.getMap()->getComm(), Teuchos::REDUCE_SUM, int(here.size()), here.data(), all.data());
  return all;
}

inline std::vector<Real> gather(const BlockVector& x) {
  std::vector<Real> all;
  for (const auto& v : x) {
    const auto part = gather(*v);
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}

/// Fills x from values in the order of gather().
inline void scatter(const std::vector<Real>& from, BlockVector& x) {
  std::size_t first = 0;
  for (const auto& v : x) {
    for (std::size_t i = 0; i < v->getLocalLength(); ++i)
      v->replaceLocalValue(i, from[first + v->getMap()->getGlobalElement(i)]);
    first += v->getGlobalLength();
  }
}

/// Returns all blocks as one matrix, with identity in rows of constrained unknowns.
inline Dense gather_matrix(const BlockProblem& problem) {
  std::vector<std::size_t> first{0};
  for (const auto& block : problem.blocks()) first.push_back(first.back() + block.map->getGlobalNumElements());
  const std::size_t n = first.back();
  std::vector<Real> here(n * n), all(n * n);
  for (std::size_t b = 0; b < problem.blocks().size(); ++b) {
    const auto flags = problem.constrained(b);
    const auto& map = *problem.blocks()[b].map;
    for (LocalIndex row = 0; row < LocalIndex(base::n_local_elements(map)); ++row) {
      const std::size_t i = first[b] + map.getGlobalElement(row);
      if (flags.extent(0) > 0 && flags(row)) {
        here[i * n + i] = 1;
        continue;
      }
      for (std::size_t c = 0; c < problem.blocks().size(); ++c) {
        const auto& block = problem.matrix()(b, c);
        if (block.is_null()) continue;
        const auto local = block->getLocalMatrixHost();
        for (auto k = local.graph.row_map(row); k < local.graph.row_map(row + 1); ++k)
          here[i * n + first[c] + block->getColMap()->getGlobalElement(local.graph.entries(k))] += local.values(k);
      }
    }
  }
  Teuchos::reduceAll(*problem.comm(), Teuchos::REDUCE_SUM, int(n * n), here.data(), all.data());
  Dense a(n, std::vector<long double>(n));
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) a[i][j] = all[i * n + j];
  return a;
}

inline std::vector<long double> solve_dense(Dense a, std::vector<long double> b) {
  const int n = b.size();
  for (int k = 0; k < n; ++k) {
    int p = k;
    for (int i = k; i < n; ++i)
      if (std::fabs(a[i][k]) > std::fabs(a[p][k])) p = i;
    std::swap(a[k], a[p]);
    std::swap(b[k], b[p]);
    for (int i = k + 1; i < n; ++i) {
      const long double l = a[i][k] / a[k][k];
      for (int j = k; j < n; ++j) a[i][j] -= l * a[k][j];
      b[i] -= l * b[k];
    }
  }
  for (int i = n - 1; i >= 0; --i) {
    for (int j = i + 1; j < n; ++j) b[i] -= a[i][j] * b[j];
    b[i] /= a[i][i];
  }
  return b;
}

}  // namespace sprekk::test
