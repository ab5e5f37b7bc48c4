// Gathering of distributed vectors and matrices on every rank, and dense algebra for comparisons.
#pragma once

#include <Teuchos_CommHelpers.hpp>
#include <Teuchos_LAPACK.hpp>
#include <algorithm>
#include <cmath>
#include <vector>

#include "base/check.hpp"
#include "fields/types.hpp"

namespace sprekk::test {

/// Dense n_rows x n_columns matrix, stored by rows.
struct Dense {
  int n_rows = 0, n_columns = 0;
  std::vector<Real> values;

  Dense(int rows, int columns) : n_rows(rows), n_columns(columns), values(std::size_t(rows) * columns, 0) {}
  Real& operator()(int i, int j) { return values[std::size_t(i) * n_columns + j]; }
  Real operator()(int i, int j) const { return values[std::size_t(i) * n_columns + j]; }
};

inline Dense transpose(const Dense& a) {
  Dense t(a.n_columns, a.n_rows);
  for (int i = 0; i < a.n_rows; ++i)
    for (int j = 0; j < a.n_columns; ++j) t(j, i) = a(i, j);
  return t;
}

inline Dense operator*(const Dense& a, const Dense& b) {
  Dense c(a.n_rows, b.n_columns);
  for (int i = 0; i < a.n_rows; ++i)
    for (int k = 0; k < a.n_columns; ++k)
      for (int j = 0; j < b.n_columns; ++j) c(i, j) += a(i, k) * b(k, j);
  return c;
}

inline Dense operator-(Dense a, const Dense& b) {
  for (std::size_t k = 0; k < a.values.size(); ++k) a.values[k] -= b.values[k];
  return a;
}

inline Real largest(const Dense& a) {
  Real size = 0;
  for (Real value : a.values) size = std::max(size, std::abs(value));
  return size;
}

/// Returns A^-1 B.
inline Dense solve(const Dense& A, const Dense& B) {
  Dense a = transpose(A), b = transpose(B);  // LAPACK stores by columns
  std::vector<int> pivots(A.n_rows);
  int info = 0;
  Teuchos::LAPACK<int, Real>().GESV(A.n_rows, B.n_columns, a.values.data(), std::max(1, A.n_rows), pivots.data(),
                                    b.values.data(), std::max(1, A.n_rows), &info);
  SPREKK_CHECK(info == 0, "singular at row {}", info);
  return transpose(b);
}

/// Returns the eigenvalues of a symmetric matrix, ascending.
inline std::vector<Real> eigenvalues(Dense a) {
  const int n = a.n_rows;
  std::vector<Real> values(n), work(8 * n + 1);
  int info = 0;
  Teuchos::LAPACK<int, Real>().SYEV('N', 'U', n, a.values.data(), n, values.data(), work.data(), int(work.size()),
                                    &info);
  SPREKK_CHECK(info == 0, "no eigenvalues");
  return values;
}

inline Dense gather(const fields::Vector& v) {
  Dense here(int(v.getGlobalLength()), 1), all = here;
  const auto data = v.getData();
  for (std::size_t i = 0; i < v.getLocalLength(); ++i)
    here(int(v.getMap()->getGlobalElement(LocalIndex(i))), 0) = data[i];
  Teuchos::reduceAll(*v.getMap()->getComm(), Teuchos::REDUCE_SUM, int(here.values.size()), here.values.data(),
                     all.values.data());
  return all;
}

inline Dense gather(const fields::CrsMatrix& matrix) {
  const auto &rows = *matrix.getRowMap(), &columns = *matrix.getColMap();
  Dense here(int(rows.getGlobalNumElements()), int(matrix.getDomainMap()->getGlobalNumElements())), all = here;
  const auto local = matrix.getLocalMatrixHost();
  for (LocalIndex i = 0; i < local.numRows(); ++i)
    for (auto k = local.graph.row_map(i); k < local.graph.row_map(i + 1); ++k)
      here(int(rows.getGlobalElement(i)), int(columns.getGlobalElement(local.graph.entries(k)))) += local.values(k);
  Teuchos::reduceAll(*rows.getComm(), Teuchos::REDUCE_SUM, int(here.values.size()), here.values.data(),
                     all.values.data());
  return all;
}

/// Returns a number in [-1, 1] that depends on k and seed only, hence not on the partition.
inline Real pseudo_random(GlobalIndex k, int seed) {
  std::size_t h = std::size_t(k) * 2654435761u + std::size_t(seed) * 40503u + 12345;
  for (int round = 0; round < 2; ++round) {
    h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9ULL;
    h = (h ^ (h >> 27)) * 0x94d049bb133111ebULL;
  }
  return 2 * Real((h ^ (h >> 31)) >> 11) / 9007199254740992.0 - 1;
}

/// Fills every vector of x with pseudo-random numbers of the given size.
inline void randomize(fields::BlockVector& x, Real size, int seed) {
  for (std::size_t b = 0; b < x.size(); ++b)
    for (LocalIndex i = 0; i < LocalIndex(x[b]->getLocalLength()); ++i)
      x[b]->replaceLocalValue(i, size * pseudo_random(x[b]->getMap()->getGlobalElement(i), seed + 17 * int(b)));
}

}  // namespace sprekk::test
