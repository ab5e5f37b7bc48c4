#include "multigrid/fewer_ranks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "base/over_ranks.hpp"
#include "multigrid/coarse_graphs.hpp"
#include "truss.hpp"

namespace sprekk::test {
namespace {

using multigrid::FewerRanks;
using multigrid::Multigrid;

const Comm& world() { return *Tpetra::getDefaultComm(); }

/// Level of a truss before its transfer to fewer ranks.
struct Made {
  Made(const Truss& truss, Real skew)
      : A(multigrid::node_matrix(*truss.matrix, 3)), fine(multigrid::nodes_of(A, truss.modes)) {
    for (std::size_t i = 0; i < fine.free.size(); ++i) {
      const auto p = truss.place(A.graph.columns->owned()->getGlobalElement(static_cast<LocalIndex>(i)));
      fine.place.push_back({Real(p[0]), Real(p[1]), Real(p[2])});
    }
    const auto aggregates = multigrid::aggregate(fine);
    const auto tentative = multigrid::tentative_prolongator(fine, aggregates, nodes);
    galerkin = std::make_unique<multigrid::Galerkin>(A, fine, aggregates, tentative);
    multigrid::coarsen_beyond(A.graph, fine, galerkin->aggregate(), *galerkin->coarse().graph.columns->all(), nodes);
    update(0.4, skew == 0);
  }
  void update(Real damping, bool symmetric) {
    const auto w = zeros(A.graph.columns->n_all(), 3);
    Kokkos::deep_copy(w, damping / 20);
    galerkin->update(A, w, symmetric);
  }
  NodeMatrix A;
  multigrid::Nodes fine, nodes;
  std::unique_ptr<multigrid::Galerkin> galerkin;
};

/// Returns the rows (node, neighbour, motion, place) of all ranks, sorted. Collective.
std::vector<std::vector<Real>> reported(const multigrid::Nodes& nodes) {
  std::vector<Real> here;
  const int m = nodes.n_modes * nodes.n_modes, width = m + 5;
  for (std::size_t i = 0; i < nodes.free.size(); ++i) {
    const auto tell = [&](GlobalIndex neighbour) {
      here.push_back(static_cast<Real>(nodes.number[i]));
      here.push_back(static_cast<Real>(neighbour));
      here.insert(here.end(), &nodes.motion[i * m], &nodes.motion[i * m] + m);
      here.insert(here.end(), nodes.place[i].begin(), nodes.place[i].end());
    };
    for (std::size_t k = nodes.neighbours.start[i]; k < nodes.neighbours.start[i + 1]; ++k)
      tell(nodes.number[nodes.neighbours.node[k]]);
    for (std::size_t k = nodes.beyond.start[i]; k < nodes.beyond.start[i + 1]; ++k) tell(nodes.beyond.node[k]);
  }
  const auto all = base::gather_over_ranks(world(), here);
  std::vector<std::vector<Real>> rows;
  for (std::size_t at = 0; at < all.size(); at += width) rows.emplace_back(&all[at], &all[at] + width);
  std::sort(rows.begin(), rows.end());
  return rows;
}

/// Matrix, interpolation and data of the nodes do not depend on the ranks, also after an update of the values.
TEST(FewerRanks, KeepTheLevelAsItIs) {
  for (const Real skew : {0.0, 0.2})
    for (int n_ranks = 1; n_ranks <= world().getSize(); ++n_ranks) {
      const Truss truss(9, true, skew);
      Made made(truss, skew);
      const auto& coarse = made.galerkin->coarse();
      auto nodes = made.nodes;
      FewerRanks moved(coarse, made.galerkin->prolongation(), nodes, n_ranks);
      const auto& A = moved.matrix();
      EXPECT_LE(multigrid::n_ranks_of(A.graph), n_ranks);
      EXPECT_EQ(reported(nodes), reported(made.nodes));
      if (n_ranks == 1) EXPECT_TRUE(nodes.beyond.node.empty());
      for (const Real damping : {0.4, 0.3}) {
        made.update(damping, skew == 0);
        moved.update(coarse);
        const auto& halo = *moved.gathered().columns;
        const LocalIndex n_before = coarse.graph.n_rows(), n = A.graph.n_rows();
        const auto x = random_vector(coarse.graph.columns->n_all(), 6, 7), y = zeros(halo.n_all(), 6);
        multigrid::product(coarse, x, y);
        halo.exchange(y, 6);
        const auto given = zeros(halo.n_all(), 6);
        std::copy_n(x.data(), n_before * 6, given.data());
        halo.exchange(given, 6);
        const auto there = zeros(std::max(A.graph.columns->n_all(), moved.prolongation().graph.columns->n_all()), 6);
        std::copy_n(given.data(), n * 6, there.data());
        const auto y_there = zeros(n, 6);
        multigrid::product(A, there, y_there);
        for (std::size_t i = 0; i < y_there.extent(0); ++i) EXPECT_NEAR(y_there(i), y(i), 1e-11);

        const auto fine = zeros(made.A.graph.n_rows(), 3), fine_there = zeros(made.A.graph.n_rows(), 3);
        multigrid::product(made.galerkin->prolongation(), x, fine);
        multigrid::product(moved.prolongation(), there, fine_there);
        for (std::size_t i = 0; i < fine.extent(0); ++i) EXPECT_NEAR(fine_there(i), fine(i), 1e-12);
      }
    }
}

/// Returns the iterations to a residual of 1e-8: of conjugate gradients, or of Richardson's iteration if the matrix is
/// unsymmetric.
int iterations(const CrsMatrix& A, const Multigrid& M, bool symmetric) {
  Vector x(A.getRowMap()), r(A.getRowMap()), z(A.getRowMap()), p(A.getRowMap()), Ap(A.getRowMap());
  for (std::size_t i = 0; i < r.getLocalLength(); ++i)
    r.replaceLocalValue(static_cast<LocalIndex>(i), std::cos(static_cast<Real>(A.getRowMap()->getGlobalElement(i))));
  const Real first = r.norm2();
  Real rz = 0;
  for (int k = 0;; ++k) {
    if (r.norm2() < 1e-8 * first || k == 200) return k;
    M.apply(r, z, Teuchos::NO_TRANS, 1, 0);
    const Real before = std::exchange(rz, r.dot(z));
    p.update(1, z, k > 0 && symmetric ? rz / before : 0);
    A.apply(p, Ap);
    const Real step = symmetric ? rz / p.dot(Ap) : 1;
    x.update(step, p, 1);
    r.update(-step, Ap, 1);
  }
}

/// Levels end on one rank for any number of ranks, and aggregates join nodes of several ranks. Iterations exceed those
/// on one rank (7 and 12) by at most one.
TEST(FewerRanks, LevelsEndOnOneRank) {
  multigrid::Options options;
  options.coarse_size = 30;
  options.minimum_per_rank = 27000;
  const int n = world().getSize();
  for (const Real skew : {0.0, 0.02}) {
    const Truss truss(7, true, skew, 70);
    Multigrid M(wrapped(truss.matrix), multigrid::nodes_of(multigrid::node_matrix(*truss.matrix, 3), truss.modes), 3,
                truss.modes, options);
    M.setup(wrapped(truss.matrix), skew == 0);
    EXPECT_EQ(M.n_ranks().front(), n);
    EXPECT_EQ(M.n_ranks().back(), 1);
    EXPECT_LE(M.n_unknowns().back(), 30);
    if (n == 4) EXPECT_EQ(M.n_ranks(), (std::vector<int>{4, 2, 1, 1}));
    EXPECT_LE(M.traffic().messages, 22);
    EXPECT_LE(iterations(*truss.matrix, M, skew == 0), skew == 0 ? 8 : 13);
  }
}

}  // namespace
}  // namespace sprekk::test
