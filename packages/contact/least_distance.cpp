#include "contact/least_distance.hpp"

#include "base/check.hpp"

#include <Teuchos_LAPACK.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sprekk::contact {

namespace {

using Row = std::vector<Real>;

Real dot(const Row& a, const Row& b) { return std::inner_product(a.begin(), a.end(), b.begin(), Real(0)); }

/// Returns the s that minimises |sum_k s_k columns[k] - f|. Throws an Error if LAPACK fails.
Row least_squares(const std::vector<const Row*>& columns, const Row& f) {
  const int m = static_cast<int>(f.size()), n = static_cast<int>(columns.size()), size = std::max(m, n);
  Row matrix, s(f);
  for (const auto* column : columns) matrix.insert(matrix.end(), column->begin(), column->end());
  s.resize(size, 0);
  std::vector<int> pivots(n, 0);
  Row work(64 * (m + n) + 2 * n + m);
  int info = 0, rank = 0;
  Teuchos::LAPACK<int, Real>().GELSS(m, n, 1, matrix.data(), m, s.data(), size, Row(std::min(m, n)).data(), 1e-11,
                                     &rank, work.data(), static_cast<int>(work.size()), nullptr, &info);
  SPREKK_CHECK(info == 0, "least squares: LAPACK's GELSS failed with {}", info);
  s.resize(n);
  return s;
}

/// Minimises |sum_k s_k columns[k] - f| for s >= 0 and returns sum_k s_k columns[k] - f. No value: round-off prevents
/// convergence.
std::optional<Row> nonnegative_least_squares(const std::vector<Row>& columns, const Row& f) {
  const std::size_t n = columns.size();
  Row s(n, 0), residual(f);
  std::vector<char> passive(n, 0), refused(n, 0);
  const auto update = [&] {
    residual = f;
    for (std::size_t k = 0; k < n; ++k)
      for (std::size_t i = 0; i < f.size() && s[k] > 0; ++i) residual[i] -= s[k] * columns[k][i];
  };
  for (std::size_t iteration = 0;; ++iteration) {
    if (iteration == 10 * (n + f.size())) return {};
    std::size_t best = n;
    Real largest = 1e-13;
    for (std::size_t k = 0; k < n; ++k)
      if (const Real slope = dot(columns[k], residual); !passive[k] && !refused[k] && slope > largest) {
        largest = slope;
        best = k;
      }
    if (best == n) break;
    passive[best] = 1;
    for (bool first = true;; first = false) {  // each pass except the last reduces the passive set
      std::vector<const Row*> chosen;
      std::vector<std::size_t> index;
      for (std::size_t k = 0; k < n; ++k)
        if (passive[k]) {
          chosen.push_back(&columns[k]);
          index.push_back(k);
        }
      const Row z = least_squares(chosen, f);
      const auto at = std::find(index.begin(), index.end(), best) - index.begin();
      if (first && !(z[at] > 0)) {  // due to round-off
        passive[best] = 0;
        refused[best] = 1;
        break;
      }
      Real step = 1;
      std::size_t first_to_vanish = 0;
      for (std::size_t k = 0; k < index.size(); ++k)
        if (const Real here = s[index[k]] / (s[index[k]] - z[k]); z[k] <= 0 && here < step) {
          step = here;
          first_to_vanish = k;
        }
      for (std::size_t k = 0; k < index.size(); ++k) {
        s[index[k]] += step * (z[k] - s[index[k]]);
        if (step < 1 && z[k] <= 0 && (s[index[k]] <= 1e-14 || k == first_to_vanish))
          passive[index[k]] = s[index[k]] = 0;
      }
      if (step == 1) {
        std::fill(refused.begin(), refused.end(), 0);
        break;
      }
    }
    update();
  }
  for (Real& value : residual) value = -value;
  return residual;
}

}  // namespace

std::optional<std::vector<Real>> least_distance(std::vector<std::vector<Real>> G, std::vector<Real> h, int n) {
  for (std::size_t k = 0; k < G.size(); ++k) {
    const Real size = std::sqrt(dot(G[k], G[k]));
    for (Real& value : G[k]) value /= size;
    G[k].push_back(h[k] / size);
  }
  Row f(n + 1, 0);
  f[n] = 1;
  const auto r = nonnegative_least_squares(G, f);
  if (!r || !(-(*r)[n] > 1e-10)) return {};
  Row y(n);
  for (int i = 0; i < n; ++i) y[i] = -(*r)[i] / (*r)[n];
  return y;
}

}  // namespace sprekk::contact
