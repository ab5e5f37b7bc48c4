#include "multigrid/galerkin.hpp"

#include <gtest/gtest.h>

#include <TpetraExt_MatrixMatrix.hpp>
#include <Tpetra_RowMatrixTransposer.hpp>

#include "truss.hpp"

namespace sprekk::test {
namespace {

/// Coarsening from a level to the next.
struct Step {
  explicit Step(const CrsMatrix& matrix, const RCP<MultiVector>& modes, bool symmetric = true)
      : A(multigrid::node_matrix(matrix, 3)),
        nodes(multigrid::nodes_of(A, modes)),
        aggregates(multigrid::aggregate(nodes)) {
    tentative = multigrid::tentative_prolongator(nodes, aggregates, coarse_nodes);
    galerkin = std::make_unique<multigrid::Galerkin>(A, nodes, aggregates, tentative);
    Vector diagonal(matrix.getRowMap());
    matrix.getLocalDiagCopy(diagonal);
    const auto damping = zeros(A.graph.columns->n_all(), 3);
    for (std::size_t i = 0; i < diagonal.getLocalLength(); ++i) damping(i) = 0.4 / diagonal.getData()[i];
    A.graph.columns->exchange(damping, 3);
    galerkin->update(A, damping, symmetric);
  }
  NodeMatrix A;
  multigrid::Nodes nodes, coarse_nodes;
  multigrid::Aggregates aggregates;
  std::vector<Real> tentative;
  std::unique_ptr<multigrid::Galerkin> galerkin;
};

TEST(NodeMatrix, MultipliesLikeTheMatrixThatItIsMadeOf) {
  const Truss truss(6, true, 0.1);
  const auto transposed = Tpetra::RowMatrixTransposer<Real, LocalIndex, GlobalIndex>(truss.matrix).createTranspose();
  const auto square = rcp(new CrsMatrix(truss.map, 0));  // with another order of columns
  Tpetra::MatrixMatrix::Multiply(*truss.matrix, false, *truss.matrix, false, *square);
  const auto cube = rcp(new CrsMatrix(truss.map, 0));  // rows of 216 blocks
  Tpetra::MatrixMatrix::Multiply(*square, false, *truss.matrix, false, *cube);
  cube->resumeFill();
  cube->scale(1.0 / 64);  // magnitudes similar to the other matrices
  cube->fillComplete();
  for (const RCP<const CrsMatrix>& matrix : {RCP<const CrsMatrix>(truss.matrix), RCP<const CrsMatrix>(transposed),
                                             RCP<const CrsMatrix>(square), RCP<const CrsMatrix>(cube)}) {
    const auto A = multigrid::node_matrix(*matrix, 3);
    const auto again = multigrid::crs_matrix(A);
    const auto& halo = *A.graph.columns;
    const auto x = random_vector(halo.n_all(), 3, 1), y = zeros(halo.n_owned(), 3), r = zeros(halo.n_all(), 3);
    Vector from(truss.map), to(truss.map), as_before(truss.map);
    for (std::size_t i = 0; i < from.getLocalLength(); ++i) from.replaceLocalValue(i, x(i));
    matrix->apply(from, to);
    again->apply(from, as_before);
    multigrid::product(A, x, y);
    Kokkos::deep_copy(r, 1);
    multigrid::residual(A, x, y, r);
    for (std::size_t i = 0; i < from.getLocalLength(); ++i) {
      EXPECT_NEAR(y(i), to.getData()[i], 1e-12);
      EXPECT_NEAR(as_before.getData()[i], to.getData()[i], 1e-12);
      EXPECT_NEAR(r(i), 0, 1e-13);  // two kernels may contract operations differently
    }
  }
}

TEST(Aggregates, HoldEveryFreeNodeOnceAndNoOther) {
  const Truss truss(7, true);
  const auto A = multigrid::node_matrix(*truss.matrix, 3);
  const auto nodes = multigrid::nodes_of(A, truss.modes);
  const auto aggregates = multigrid::aggregate(nodes);
  std::vector<int> members(aggregates.n, 0);
  for (std::size_t i = 0; i < nodes.free.size(); ++i) {
    const bool constrained = truss.place(truss.map->getGlobalElement(3 * i) / 3)[0] == 0;
    EXPECT_EQ(nodes.free[i], !constrained);
    EXPECT_EQ(aggregates.of[i] >= 0, !constrained);
    if (!constrained) ++members.at(aggregates.of[i]);
    for (int k = 0; k < 18 && constrained; ++k) EXPECT_EQ(nodes.motion[18 * i + k], 0);
  }
  for (const int n : members) EXPECT_GT(n, 0);
  EXPECT_LT(8 * aggregates.n, static_cast<LocalIndex>(nodes.free.size()) + 64);
}

/// With an aggregate size, there are fewer aggregates, and each is still connected.
TEST(Aggregates, TakeNeighboursOfNeighbours) {
  const Truss truss(12, false, 0, 0, true);
  const auto nodes = multigrid::nodes_of(multigrid::node_matrix(*truss.matrix, 3), truss.modes);
  const auto& [start, neighbour] = nodes.neighbours;
  const auto few = multigrid::aggregate(nodes), many = multigrid::aggregate(nodes, 36);
  EXPECT_LT(5 * many.n, 4 * few.n);
  std::vector<std::vector<LocalIndex>> members(many.n);
  for (std::size_t i = 0; i < many.of.size(); ++i) members.at(many.of[i]).push_back(static_cast<LocalIndex>(i));
  for (const auto& all : members) {
    ASSERT_FALSE(all.empty());
    std::vector<bool> reached(nodes.free.size(), false);  // reached over bars within the aggregate
    std::vector<LocalIndex> next(1, all.front());
    reached[all.front()] = true;
    std::size_t n = 0;
    for (; n < next.size(); ++n)
      for (std::size_t k = start[next[n]]; k < start[next[n] + 1]; ++k)
        if (const LocalIndex j = neighbour[k]; !reached[j] && many.of[j] == many.of[all.front()]) {
          reached[j] = true;
          next.push_back(j);
        }
    EXPECT_EQ(n, all.size());
  }
}

/// The basis of each aggregate is orthonormal; multiplied by the coarse motions it gives the fine ones.
TEST(Aggregates, KeepRigidMotions) {
  const Truss truss(7);
  const Step step(*truss.matrix, truss.modes);
  const int m = 6;
  std::vector<Real> squares(step.aggregates.n * m, 0);
  for (std::size_t row = 0; row < step.tentative.size() / m; ++row) {
    const auto I = static_cast<std::size_t>(step.aggregates.of[row / 3]);
    for (int c = 0; c < m; ++c) {
      squares[I * m + c] += step.tentative[row * m + c] * step.tentative[row * m + c];
      Real motion = 0;
      for (int a = 0; a < m; ++a) motion += step.tentative[row * m + a] * step.coarse_nodes.motion[(I * m + a) * m + c];
      EXPECT_NEAR(motion, step.nodes.motion[row * m + c], 1e-10);
    }
  }
  for (const Real square : squares) EXPECT_TRUE(square == 0 || std::fabs(square - 1) < 1e-12) << square;
}

/// A matrix without stiffness against rigid motions: these are interpolated in single precision, and their energy on
/// the next level is almost zero.
TEST(Galerkin, InterpolatesRigidMotions) {
  const Truss truss(7);
  const Step step(*truss.matrix, truss.modes);
  const auto& P = step.galerkin->prolongation();
  const auto& coarse = step.galerkin->coarse();
  for (int mode = 0; mode < 6; ++mode) {
    const auto c = zeros(P.graph.columns->n_all(), 6), fine = zeros(P.graph.n_rows(), 3);
    for (std::size_t i = 0; i < step.coarse_nodes.motion.size() / 6; ++i) c(i) = step.coarse_nodes.motion[6 * i + mode];
    multigrid::product(P, c, fine);
    for (std::size_t i = 0; i < fine.extent(0); ++i)
      EXPECT_NEAR(fine(i), step.nodes.motion[6 * i + mode], 1e-6) << mode;
    const auto force = zeros(coarse.graph.n_rows(), 6);
    multigrid::product(coarse, c, force);
    EXPECT_LT(dot(c, force, force.extent(0)), 1e-10);
  }
}

/// Checks coarse = R A P and that R is the transpose of P. For unsymmetric matrices, R is compared with P of the
/// transposed matrix, up to single precision.
TEST(Galerkin, MultipliesAndTransposes) {
  for (const auto& [n, skew] : {std::pair{7, 0.0}, {7, 0.2}, {2, 0.0}, {2, 0.2}}) {  // n = 2: some ranks are empty
    const Truss truss(n, n > 2, skew);
    const bool symmetric = skew == 0;
    const Step step(*truss.matrix, truss.modes, symmetric);
    const auto &R = step.galerkin->restriction(), &P = step.galerkin->prolongation();
    const auto& coarse = step.galerkin->coarse();
    const LocalIndex n_fine = step.A.graph.columns->n_all(), n_coarse = coarse.graph.columns->n_all();
    const auto c = random_vector(n_coarse, 6, 2), f = random_vector(n_fine, 3, 3);

    const auto fine = zeros(n_fine, 3), product = zeros(n_fine, 3);
    const auto by_parts = zeros(coarse.graph.n_rows(), 6), at_once = zeros(coarse.graph.n_rows(), 6);
    multigrid::product(P, c, fine);
    multigrid::product(step.A, fine, product);
    multigrid::product(R, product, by_parts);
    multigrid::product(coarse, c, at_once);
    for (LocalIndex I = 0; I < coarse.graph.n_rows(); ++I)
      for (int q = 0; q < 6; ++q) {
        Real alone = 0;  // diagonal entry of modes that the aggregate does not have
        Real mode = 0;
        for (std::size_t i = 0; i < step.aggregates.of.size(); ++i)
          for (int k = 0; k < 3 && step.aggregates.of[i] == I; ++k)
            mode += std::fabs(step.tentative[(3 * i + k) * 6 + q]);
        if (mode == 0) alone = c(6 * I + q);
        EXPECT_NEAR(at_once(6 * I + q), by_parts(6 * I + q) + alone, 1e-10);
      }

    const auto transposed = Tpetra::RowMatrixTransposer<Real, LocalIndex, GlobalIndex>(truss.matrix).createTranspose();
    const Step other(*transposed, truss.modes, symmetric);
    const auto restricted = zeros(coarse.graph.n_rows(), 6), interpolated = zeros(n_fine, 3);
    const auto c_there = zeros(other.galerkin->coarse().graph.columns->n_all(), 6);
    for (std::size_t i = 0; i < restricted.extent(0); ++i) c_there(i) = c(i);
    multigrid::product(R, f, restricted);
    multigrid::product(other.galerkin->prolongation(), c_there, interpolated);
    EXPECT_NEAR(dot(c, restricted, restricted.extent(0)), dot(f, interpolated, 3 * step.A.graph.n_rows()), 1e-6);
  }
}

/// All values of all ranks, row by row.
struct Dense {
  Dense(std::size_t rows_, std::size_t columns_) : rows(rows_), columns(columns_), value(rows_ * columns_, 0) {}
  template <class Matrix>
  Dense(const Matrix& A, const Map& row_map)
      : Dense(A.height * row_map.getGlobalNumElements(), A.width * A.graph.columns->owned()->getGlobalNumElements()) {
    std::vector<Real> here(value.size(), 0);
    const auto& column_map = *A.graph.columns->all();
    for (LocalIndex i = 0; i < A.graph.n_rows(); ++i)
      for (int r = 0; r < A.height; ++r) {
        const std::size_t begin = A.graph.start(i), n = A.graph.start(i + 1) - begin;
        for (std::size_t k = 0; k < n * A.width; ++k)
          here[(A.height * row_map.getGlobalElement(i) + r) * columns +
               A.width * column_map.getGlobalElement(A.graph.column(begin + k / A.width)) + k % A.width] =
              A.value(A.width * (A.height * begin + r * n) + k);
      }
    Teuchos::reduceAll(*row_map.getComm(), Teuchos::REDUCE_SUM, int(here.size()), here.data(), value.data());
  }
  Dense operator*(const Dense& other) const {
    Dense result(rows, other.columns);
    for (std::size_t i = 0; i < rows; ++i)
      for (std::size_t k = 0; k < columns; ++k)
        for (std::size_t j = 0; j < other.columns && value[i * columns + k] != 0; ++j)
          result.value[i * other.columns + j] += value[i * columns + k] * other.value[k * other.columns + j];
    return result;
  }
  std::size_t rows, columns;
  std::vector<Real> value;
};

/// Long bar, with a product in several slices.
TEST(Galerkin, MultipliesInSlices) {
  for (const Real skew : {0.0, 0.2}) {
    const Truss truss(2, false, skew, 120);
    const Step step(*truss.matrix, truss.modes, skew == 0);
    const auto &R = step.galerkin->restriction(), &P = step.galerkin->prolongation();
    const auto& coarse = step.galerkin->coarse();
    const auto &fine_map = *step.A.graph.columns->owned(), &coarse_map = *coarse.graph.columns->owned();
    const auto product = Dense(R, coarse_map) * (Dense(step.A, fine_map) * Dense(P, fine_map));
    const Dense found(coarse, coarse_map);
    ASSERT_EQ(found.value.size(), product.value.size());
    for (std::size_t k = 0; k < found.value.size(); ++k) ASSERT_NEAR(found.value[k], product.value[k], 1e-11) << k;
  }
}

/// Every row that a slice needs is in the buffer when needed, without overlap.
TEST(Slices, HaveRoomForWhatTheyName) {
  const Truss truss(2, false, 0, 120);
  const Step step(*truss.matrix, truss.modes);
  const auto& R = step.galerkin->restriction().graph;
  const auto& halo = *R.columns;
  const View<std::size_t*> start("start", halo.n_all() + 1);
  for (LocalIndex row = 0; row < halo.n_all(); ++row)
    start(row + 1) = start(row) + halo.all()->getGlobalElement(row) % 4;
  const auto slices = multigrid::make_slices(R, start);
  const bool alone = halo.owned()->getComm()->getSize() == 1;
  EXPECT_GE(slices.n(), alone ? 16 : 2);
  EXPECT_LT(slices.size, start(halo.n_all()) / (alone ? 4.0 : 0.99));
  ASSERT_EQ(slices.first.front(), 0);
  ASSERT_EQ(slices.first.back(), R.n_rows());
  std::vector<LocalIndex> constrained(slices.size, -1);  // [position] row stored there
  const auto put = [&](LocalIndex row, std::size_t at) {
    for (std::size_t k = start(row); k < start(row + 1); ++k) constrained.at(at + k - start(row)) = row;
  };
  for (LocalIndex row = halo.n_owned(); row < halo.n_all(); ++row) put(row, slices.at(row));
  const auto make = [&](int part) {
    for (std::size_t k = slices.first_made[part]; k < slices.first_made[part + 1]; ++k) {
      put(slices.made(k), slices.to(k));
      slices.at(slices.made(k)) = slices.to(k);
    }
  };
  make(0);
  for (int s = 0; s < slices.n(); ++s) {
    make(s + 1);
    for (std::size_t e = R.start(slices.first[s]); e < R.start(slices.first[s + 1]); ++e) {
      const LocalIndex row = R.column(e);
      for (std::size_t c = start(row); c < start(row + 1); ++c)
        ASSERT_EQ(constrained.at(slices.at(row) + c - start(row)), row) << s;
    }
  }
}

/// Unsymmetric graphs: R omits entries without a position in its graph, and the coarse matrix is still R A P.
TEST(Galerkin, TakesGraphsThatAreNotSymmetric) {
  const auto comm = Tpetra::getDefaultComm();
  const auto map = rcp(new Map(30, 0, comm));
  CrsMatrix matrix(map, 2);
  for (const GlobalIndex row : base::local_elements(*map)) {
    const Real values[] = {2, -1};
    const GlobalIndex columns[] = {row, (row + 1) % 30};
    matrix.insertGlobalValues(row, row < 29 ? 2 : 1, values, columns);
  }
  matrix.fillComplete();
  const auto A = multigrid::node_matrix(matrix, 1);
  multigrid::Nodes coarse, nodes = multigrid::nodes_of(A, Teuchos::null);
  const auto aggregates = multigrid::aggregate(nodes);
  const auto tentative = multigrid::tentative_prolongator(nodes, aggregates, coarse);
  multigrid::Galerkin galerkin(A, nodes, aggregates, tentative);
  const auto damping = zeros(A.graph.columns->n_all(), 1);
  Kokkos::deep_copy(damping, 0.3);
  galerkin.update(A, damping, false);
  const auto& P = galerkin.prolongation();
  const auto c = random_vector(P.graph.columns->n_all(), 1, 6), fine = zeros(A.graph.columns->n_all(), 1),
             Ac = zeros(A.graph.columns->n_all(), 1), by_parts = zeros(aggregates.n, 1),
             at_once = zeros(aggregates.n, 1);
  multigrid::product(P, c, fine);
  multigrid::product(A, fine, Ac);
  multigrid::product(galerkin.restriction(), Ac, by_parts);
  multigrid::product(galerkin.coarse(), c, at_once);
  for (LocalIndex I = 0; I < aggregates.n; ++I) EXPECT_NEAR(at_once(I), by_parts(I), 1e-12);
}

/// With one unknown per node, rows of P have exact sums. A constant in a stiff part of a chain then has no energy on
/// the next level, except that of the soft springs at its ends.
TEST(Galerkin, InterpolatesConstantsExactly) {
  constexpr GlobalIndex n = 120, first = 40, end = 80;
  const auto spring = [](GlobalIndex k) {  // between nodes k and k + 1; all sums are exact
    return k < 0 || k >= n - 1 ? 0 : static_cast<Real>(1 + k % 5) * (k >= first && k < end ? 0x1p50 : 1);
  };
  const auto map = rcp(new Map(n, 0, Tpetra::getDefaultComm()));
  CrsMatrix matrix(map, 3);
  for (const GlobalIndex row : base::local_elements(*map)) {
    std::vector<GlobalIndex> columns = {row};
    std::vector<Real> values = {spring(row - 1) + spring(row)};
    for (const GlobalIndex column : {row - 1, row + 1})
      if (column >= 0 && column < n) {
        columns.push_back(column);
        values.push_back(-spring(std::min(row, column)));
      }
    matrix.insertGlobalValues(row, Teuchos::arrayViewFromVector(columns), Teuchos::arrayViewFromVector(values));
  }
  matrix.fillComplete();
  const auto A = multigrid::node_matrix(matrix, 1);
  multigrid::Nodes coarse, nodes = multigrid::nodes_of(A, Teuchos::null);
  const auto aggregates = multigrid::aggregate(nodes);
  multigrid::Galerkin galerkin(A, nodes, aggregates, multigrid::tentative_prolongator(nodes, aggregates, coarse));
  const auto damping = zeros(A.graph.columns->n_all(), 1);
  for (LocalIndex i = 0; i < A.graph.n_rows(); ++i) {
    const auto row = map->getGlobalElement(i);
    damping(i) = 0.6 / (spring(row - 1) + spring(row));
  }
  A.graph.columns->exchange(damping, 1);
  galerkin.update(A, damping, true);
  const auto& P = galerkin.prolongation();
  const auto stiff = zeros(P.graph.columns->n_all(), 1), fine = zeros(A.graph.columns->n_all(), 1),
             force = zeros(aggregates.n, 1);
  for (LocalIndex i = 0; i < A.graph.n_rows(); ++i)
    if (const auto row = map->getGlobalElement(i); row >= first && row <= end) stiff(aggregates.of[i]) = 1;
  multigrid::product(P, stiff, fine);
  for (LocalIndex i = 0; i < A.graph.n_rows(); ++i)
    if (const auto row = map->getGlobalElement(i); row >= first && row <= end) EXPECT_EQ(fine(i), 1) << row;
  multigrid::product(galerkin.coarse(), stiff, force);
  EXPECT_LT(dot(stiff, force, aggregates.n), 20);
}

}  // namespace
}  // namespace sprekk::test
