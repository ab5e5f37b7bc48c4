// Chebyshev's polynomial with exact solves on sets of rows.
#include "multigrid/patched_smoother.hpp"

#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>

#include <array>

#include "base/check.hpp"

namespace sprekk::test {
namespace {

using multigrid::MultiVector;
using multigrid::RowSets;

/// Chain of n springs of stiffness 1, fixed to the ground with 0.1, plus springs of stiffness `stiff` that resist the
/// sums x_i + x_(i+1) - x_(i+2) - x_(i+3) of rows i = 2, 12, 22, ...
struct Chain {
  static constexpr GlobalIndex n = 40;

  explicit Chain(Real stiff) : map(rcp(new fields::Map(n, 0, Tpetra::getDefaultComm()))) {
    matrix = rcp(new fields::CrsMatrix(map, 5));
    const auto add = [&](GlobalIndex row, GlobalIndex column, Real value) {
      if (map->isNodeGlobalElement(row)) matrix->insertGlobalValues(row, 1, &value, &column);
    };
    for (GlobalIndex i = 0; i < n; ++i) {
      add(i, i, 0.1);
      for (const GlobalIndex j : {i - 1, i + 1})
        if (j >= 0 && j < n) {
          add(i, i, 1);
          add(i, j, -1);
        }
    }
    constexpr std::array<Real, 4> sign{1, 1, -1, -1};
    for (GlobalIndex first = 2; first < n; first += 10)
      for (int a = 0; a < 4; ++a)
        for (int b = 0; b < 4; ++b) add(first + a, first + b, stiff * sign[a] * sign[b]);
    matrix->fillComplete();
  }
  /// Returns the sets of rows that the stiff springs connect, as far as this rank owns them.
  RowSets sets() const {
    RowSets all;
    for (GlobalIndex first = 2; first < n; first += 10) {
      all.emplace_back();
      for (GlobalIndex row = first; row < first + 4; ++row)
        if (const LocalIndex local = map->getLocalElement(row); local >= 0) all.back().push_back(local);
      if (all.back().empty()) all.pop_back();
    }
    return all;
  }
  RCP<const fields::Map> map;
  RCP<fields::CrsMatrix> matrix;
};

Real dot(const MultiVector& a, const MultiVector& b) { return a.getVector(0)->dot(*b.getVector(0)); }

/// Symmetric iteration M = S + S^T - S^T A S of a smoother S.
struct Twice {
  const Chain& chain;
  const multigrid::PatchedSmoother& smoother;
  MultiVector operator()(const MultiVector& b) const {
    MultiVector x(b.getMap(), 1);
    smoother.before(b, x);
    smoother.after(b, x);
    return x;
  }
};

TEST(PatchedSmoother, IsSymmetric) {
  const Chain chain(1e4);
  multigrid::PatchedSmoother smoother(fields::wrapped(chain.matrix), chain.sets());
  smoother.update(fields::wrapped(chain.matrix), 4);
  const Twice M{chain, smoother};
  MultiVector a(chain.map, 1), b(chain.map, 1);
  a.randomize();
  b.randomize();
  const auto Ma = M(a), Mb = M(b);
  EXPECT_NEAR(dot(a, Mb), dot(b, Ma), 1e-10 * std::sqrt(dot(a, a) * dot(Mb, Mb)));
  EXPECT_GT(dot(a, Ma), 0);
}

/// After the exact solves, no residual is left in the rows of the sets. The error that a stiff sum hides from the
/// polynomial disappears.
TEST(PatchedSmoother, SolvesTheSets) {
  const Chain chain(1e6);
  multigrid::PatchedSmoother smoother(fields::wrapped(chain.matrix), chain.sets());
  smoother.update(fields::wrapped(chain.matrix), 4);
  MultiVector b(chain.map, 1), x(chain.map, 1), r(chain.map, 1);
  b.randomize();
  smoother.before(b, x);
  chain.matrix->apply(x, r);
  r.update(1, b, -1);
  const auto left = r.getLocalViewHost(Tpetra::Access::ReadOnly);
  if (chain.map->getComm()->getSize() > 1) return;  // sets may be divided
  for (const auto& set : chain.sets())
    for (const LocalIndex row : set) EXPECT_NEAR(left(row, 0), 0, 1e-8);
}

TEST(PatchedSmoother, ReportsSingularSets) {
  const auto map = rcp(new fields::Map(8, 0, Tpetra::getDefaultComm()));
  const auto matrix = rcp(new fields::CrsMatrix(map, 1));
  for (const GlobalIndex row : base::local_elements(*map))
    matrix->insertGlobalValues(row, 1, std::array<Real, 1>{row == 0 ? 0.0 : 1.0}.data(), &row);
  matrix->fillComplete();
  RowSets sets;
  if (map->getLocalElement(0) >= 0) sets = {{map->getLocalElement(0)}};
  multigrid::PatchedSmoother smoother(fields::wrapped(matrix), sets);
  EXPECT_THROW(smoother.update(fields::wrapped(matrix), 4), Error);
}

}  // namespace
}  // namespace sprekk::test
