#include "multigrid/multigrid.hpp"

#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>

#include "base/check.hpp"
#include "multigrid/coarse_graphs.hpp"
#include "truss.hpp"

namespace sprekk::test {
namespace {

/// Trilinear elements of the Laplacian in cells 1 x 1 x h, on [n, n, n] nodes, plus a small multiple of the identity.
struct FlatCells {
  explicit FlatCells(int n, Real h = 0.1) : map(rcp(new Map(n * n * n, 0, Tpetra::getDefaultComm()))) {
    matrix = rcp(new CrsMatrix(map, 27));
    places = rcp(new MultiVector(map, 3));
    const Real stiffness[] = {-1, 2, -1}, mass[] = {1 / 6.0, 4 / 6.0, 1 / 6.0};
    for (const GlobalIndex node : base::local_elements(*map)) {
      const int p[] = {int(node % n), int(node / n % n), int(node / n / n)};
      for (int k = 0; k < 3; ++k) places->replaceGlobalValue(node, k, p[k] * (k == 2 ? h : 1));
      for (int k = 0; k < 27; ++k) {
        const int d[] = {k % 3, k / 3 % 3, k / 9}, q[] = {p[0] + d[0] - 1, p[1] + d[1] - 1, p[2] + d[2] - 1};
        if (*std::min_element(q, q + 3) < 0 || *std::max_element(q, q + 3) >= n) continue;
        const Real value = h * (stiffness[d[0]] * mass[d[1]] + mass[d[0]] * stiffness[d[1]]) * mass[d[2]] +
                           mass[d[0]] * mass[d[1]] * stiffness[d[2]] / h + (k == 13 ? 1e-3 : 0);
        const GlobalIndex column = q[0] + n * (q[1] + GlobalIndex(n) * q[2]);
        matrix->insertGlobalValues(node, 1, &value, &column);
      }
    }
    matrix->fillComplete();
  }
  RCP<const Map> map;
  RCP<CrsMatrix> matrix;
  RCP<MultiVector> places;
};

/// The smoother S is symmetric and reduces high-frequency errors: 1 - S A is small on the upper part of the spectrum.
TEST(Chebyshev, IsSymmetricAndSmooths) {
  const Truss truss(8, true);
  const auto A = multigrid::node_matrix(*truss.matrix, 3);
  multigrid::Chebyshev smoother(A);
  smoother.update(A);
  const LocalIndex n_all = A.graph.columns->n_all();
  const auto x = random_vector(n_all, 3, 4), y = random_vector(n_all, 3, 5), Sx = zeros(n_all, 3), Sy = zeros(n_all, 3);
  smoother.apply(x, Sx, false);
  smoother.apply(y, Sy, false);
  const std::size_t n = 3 * A.graph.n_rows();
  EXPECT_NEAR(dot(Sx, y, n), dot(x, Sy, n), 1e-12 * std::sqrt(dot(Sx, Sx, n) * dot(y, y, n)));

  const auto e = zeros(n_all, 3), r = zeros(n_all, 3);  // neighbours with opposite signs
  for (LocalIndex i = 0; i < A.graph.n_rows(); ++i) {
    const auto p = truss.place(A.graph.columns->owned()->getGlobalElement(i));
    for (int k = 0; k < 3 && p[0] > 0; ++k) e(3 * i + k) = (p[0] + p[1] + p[2]) % 2 ? 1 : -1;
  }
  const Real before = dot(e, e, n);
  multigrid::product(A, e, r);
  const auto correction = zeros(n_all, 3);
  smoother.apply(r, correction, false);
  for (std::size_t i = 0; i < n; ++i) e(i) -= correction(i);
  EXPECT_LT(std::sqrt(dot(e, e, n) / before), 0.15);
}

/// Returns the contraction of the error per iteration x += M (b - A x), by the power method.
Real contraction(const CrsMatrix& A, multigrid::Multigrid& M) {
  Vector e(A.getRowMap()), r(A.getRowMap()), correction(A.getRowMap());
  e.randomize(-1, 1);
  Real factor = 0;
  for (int k = 0; k < 30; ++k) {
    const Real before = e.norm2();
    A.apply(e, r);
    M.apply(r, correction, Teuchos::NO_TRANS, 1, 0);
    e.update(-1, correction, 1);
    factor = e.norm2() / before;
    e.scale(1 / e.norm2());
  }
  return factor;
}

TEST(Multigrid, ContractsAlikeOnAllSizesAndRanks) {
  for (const int n : {9, 15}) {
    const Truss truss(n, true);
    multigrid::Multigrid M(wrapped(truss.matrix), *wrapped(truss.matrix), 3, truss.modes);
    M.setup(wrapped(truss.matrix), true);
    EXPECT_LT(contraction(*truss.matrix, M), 0.35) << n;
    EXPECT_GT(M.operator_complexity(), n == 9 ? 1.0 : 1.02);
    EXPECT_LT(M.operator_complexity(), 1.6);
  }
}

/// Aggregates contain more than the neighbours of a node.
TEST(Multigrid, ContractsWhereNodesHaveFewNeighbours) {
  for (const int n : {9, 15, 21}) {
    const Truss truss(n, true, 0, 0, true);
    multigrid::Multigrid M(wrapped(truss.matrix), *wrapped(truss.matrix), 3, truss.modes);
    M.setup(wrapped(truss.matrix), true);
    EXPECT_LT(contraction(*truss.matrix, M), 0.75) << n;
    EXPECT_LT(M.operator_complexity(), 1.25) << n;
  }
}

/// Trilinear elements of the Laplacian in stacked layers of cells 1 x 1 x h with [n, n, 3] nodes each, plus a small
/// multiple of the identity. Closed contact resists the mean jump of each face, with the stiffness of cells.
struct Layers {
  Layers(int n_, Real h) : n(n_), map(rcp(new Map(3 * n * n * n_layers, 0, Tpetra::getDefaultComm()))) {
    bulk = rcp(new CrsMatrix(map, 128));
    matrix = rcp(new CrsMatrix(map, 128));
    places = rcp(new MultiVector(map, 3));
    ones = rcp(new MultiVector(map, 1));
    ones->putScalar(1);
    for (const GlobalIndex node : base::local_elements(*map)) {
      const auto p = place(node);
      for (int k = 0; k < 3; ++k)
        places->replaceGlobalValue(node, k, k < 2 ? Real(p[k]) : h * static_cast<Real>(p[2] - p[2] / 3));
      for (const auto& A : {bulk, matrix}) add(*A, node, node, 1e-3);
    }
    for (int layer = 0; layer < n_layers; ++layer)
      for (int x = 0; x + 1 < n; ++x)
        for (int y = 0; y + 1 < n; ++y) {
          for (int z = 3 * layer; z < 3 * layer + 2; ++z) add_cell({x, y, z}, h);
          if (layer > 0) add_face({x, y, 3 * layer - 1}, h);
        }
    bulk->fillComplete();
    matrix->fillComplete();
  }

  std::array<int, 3> place(GlobalIndex node) const { return {int(node % n), int(node / n % n), int(node / n / n)}; }
  GlobalIndex corner(const std::array<int, 3>& first, int k) const {
    return first[0] + k % 2 + n * (first[1] + k / 2 % 2 + GlobalIndex(n) * (first[2] + k / 4));
  }
  void add(CrsMatrix& A, GlobalIndex row, GlobalIndex column, Real value) {
    if (map->isNodeGlobalElement(row)) A.insertGlobalValues(row, 1, &value, &column);
  }
  void add_cell(const std::array<int, 3>& first, Real h) {
    for (int a = 0; a < 8; ++a)
      for (int b = 0; b < 8; ++b) {
        Real mass[3], stiffness[3];
        for (int k = 0; k < 3; ++k) {
          const bool same = (a >> k & 1) == (b >> k & 1);
          mass[k] = (same ? 1 / 3.0 : 1 / 6.0) * (k == 2 ? h : 1);
          stiffness[k] = (same ? 1 : -1) / (k == 2 ? h : 1);
        }
        const Real value =
            stiffness[0] * mass[1] * mass[2] + mass[0] * stiffness[1] * mass[2] + mass[0] * mass[1] * stiffness[2];
        for (const auto& A : {bulk, matrix}) add(*A, corner(first, a), corner(first, b), value);
      }
  }
  void add_face(const std::array<int, 3>& first, Real h) {
    for (int a = 0; a < 8; ++a)
      for (int b = 0; b < 8; ++b)
        add(*matrix, corner(first, a), corner(first, b), ((a < 4) == (b < 4) ? 1 : -1) / (16 * h));
  }

  static constexpr int n_layers = 4;
  int n;
  RCP<const Map> map;
  RCP<CrsMatrix> bulk, matrix;
  RCP<MultiVector> places, ones;
};

/// Returns the iterations of conjugate gradients to a residual of 1e-8.
int iterations(const CrsMatrix& A, const multigrid::Multigrid& M) {
  Vector x(A.getRowMap()), r(A.getRowMap()), z(A.getRowMap()), p(A.getRowMap()), Ap(A.getRowMap());
  for (std::size_t i = 0; i < r.getLocalLength(); ++i)
    r.replaceLocalValue(i, std::cos(static_cast<Real>(A.getRowMap()->getGlobalElement(i))));
  const Real first = r.norm2();
  Real rz = 0;
  for (int k = 0;; ++k) {
    if (r.norm2() < 1e-8 * first || k == 500) return k;
    M.apply(r, z, Teuchos::NO_TRANS, 1, 0);
    const Real before = std::exchange(rz, r.dot(z));
    p.update(1, z, k > 0 ? rz / before : 0);
    A.apply(p, Ap);
    const Real step = rz / p.dot(Ap);
    x.update(step, p, 1);
    r.update(-step, Ap, 1);
  }
}

/// Contact of flat cells does not resist jumps that alternate along the long edges.
TEST(Multigrid, TakesFewIterationsWhereFlatCellsAreInContact) {
  const int maximum = Tpetra::getDefaultComm()->getSize() == 1 ? 15 : 20;
  for (const Real h : {1.0, 0.1, 0.01}) {
    const Layers layers(14, h);
    multigrid::Multigrid M(wrapped(layers.matrix),
                           multigrid::nodes_of(multigrid::node_matrix(*layers.bulk, 1), layers.ones, layers.places), 1,
                           layers.ones);
    M.setup(wrapped(layers.matrix), true);
    EXPECT_LE(iterations(*layers.matrix, M), maximum) << h;
  }
}

/// Linear elements of -div K grad u on squares divided along alternating diagonals, [n + 1, n + 1] nodes, with u = 0 at
/// the left and right boundary. K is 100 at 30 degrees to the mesh and 1 across.
struct Anisotropic {
  explicit Anisotropic(int n_) : n(n_), map(rcp(new Map((n - 1) * (n + 1), 0, Tpetra::getDefaultComm()))) {
    matrix = rcp(new CrsMatrix(map, 16));
    for (int x = 0; x < n; ++x)
      for (int y = 0; y < n; ++y) {
        const std::array<int, 2> a{x, y}, b{x + 1, y}, c{x, y + 1}, d{x + 1, y + 1};
        const bool odd = (x + y) % 2 == 1;
        add({a, b, odd ? c : d});
        add({odd ? b : a, d, c});
      }
    matrix->fillComplete();
  }
  GlobalIndex number(const std::array<int, 2>& p) const { return p[0] - 1 + GlobalIndex(n - 1) * p[1]; }
  void add(const std::array<std::array<int, 2>, 3>& corners) {
    constexpr Real cosine2 = 0.75, sine2 = 0.25, product = 0.4330127018922193;
    constexpr Real K[2][2] = {{100 * cosine2 + sine2, 99 * product}, {99 * product, 100 * sine2 + cosine2}};
    Real gradient[3][2];  // of a cell of size 1/2
    for (int k = 0; k < 3; ++k) {
      const auto &p = corners[(k + 1) % 3], &q = corners[(k + 2) % 3];
      gradient[k][0] = p[1] - q[1];
      gradient[k][1] = q[0] - p[0];
    }
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < 3; ++l) {
        const auto &p = corners[k], &q = corners[l];
        if (p[0] % n == 0 || q[0] % n == 0 || !map->isNodeGlobalElement(number(p))) continue;
        Real value = 0;
        for (int i = 0; i < 2; ++i)
          for (int j = 0; j < 2; ++j) value += gradient[k][i] * K[i][j] * gradient[l][j] / 2;
        const GlobalIndex column = number(q);
        matrix->insertGlobalValues(number(p), 1, &value, &column);
      }
  }
  int n;
  RCP<const Map> map;
  RCP<CrsMatrix> matrix;
};

/// The bound is that of `./sprekk perf flow`.
TEST(Multigrid, TakesFewIterationsInAnisotropicRock) {
  const Anisotropic rock(128);
  multigrid::Options options;
  options.strong = 0.7;
  multigrid::Multigrid M(
      wrapped(rock.matrix),
      multigrid::nodes_of(multigrid::node_matrix(*rock.matrix, 1), Teuchos::null, Teuchos::null, options.strong), 1,
      Teuchos::null, options);
  M.setup(wrapped(rock.matrix), true);
  EXPECT_LE(iterations(*rock.matrix, M), 30);
}

/// With a relative threshold, positive couplings are weak.
TEST(Aggregates, LeaveOutPositiveCouplings) {
  const Anisotropic rock(8);
  const auto A = multigrid::node_matrix(*rock.matrix, 1);
  const auto all = multigrid::weak_couplings(A, 0), signs = multigrid::weak_couplings(A, 0.01);
  int n_positive = 0;
  for (LocalIndex i = 0; i < A.graph.n_rows(); ++i)
    for (std::size_t k = A.graph.start(i); k < A.graph.start(i + 1); ++k) {
      const bool positive = A.graph.column(k) != i && A.value(k) > 0.1;
      EXPECT_EQ(signs[k], positive);
      EXPECT_FALSE(all[k]);
      n_positive += positive;
    }
  EXPECT_GT(base::sum_over_ranks(*rock.map->getComm(), n_positive), 0);
}

/// Contact is weak only between flat cells that are out of reach. In all other cases the graph is unchanged.
TEST(Aggregates, LeaveOutContactOfFlatCellsOnly) {
  for (const Real h : {1.0, 0.01}) {
    const Layers layers(6, h);
    for (const auto& A : {layers.bulk, layers.matrix}) {
      auto nodes = multigrid::nodes_of(multigrid::node_matrix(*layers.bulk, 1), layers.ones, layers.places);
      EXPECT_EQ(multigrid::leave_out_far_contact(multigrid::node_matrix(*A, 1).graph, nodes), 0);
      const bool some = A == layers.matrix && h < 1;
      for (std::size_t i = 0; i < nodes.free.size(); ++i) {
        const int z = layers.place(layers.map->getGlobalElement(static_cast<LocalIndex>(i)))[2];
        const bool inside = z == 0 || z == 3 * Layers::n_layers - 1 || z % 3 == 1;
        EXPECT_NEAR(nodes.contact_edge[i], some && !inside ? h : 0, 1e-12);
      }
      EXPECT_TRUE(some || std::count(nodes.weak.begin(), nodes.weak.end(), true) == 0);
    }
  }
}

/// Returns the same matrix, stored in blocks of nodes on ranks with `together`, else by unknowns.
RCP<const fields::Matrix> in_nodes(const CrsMatrix& A, bool together) {
  const auto local = A.getLocalMatrixHost();
  const View<std::size_t*> start("start", local.numRows() + 1);
  const View<LocalIndex*> column("column", local.nnz());
  for (LocalIndex row = 0; row < local.numRows(); ++row) start(row + 1) = local.graph.row_map(row + 1);
  for (std::size_t k = 0; k < column.extent(0); ++k) column(k) = local.graph.entries(k);
  const int size = together ? 3 : 1;
  const auto matrix =
      rcp(new const fields::Matrix(A.getRowMap(), A.getColMap(), A.getDomainMap(), start, column, size, size));
  for (std::size_t k = 0; k < column.extent(0); ++k) matrix->numbers().value(k) = local.values(k);
  return matrix;
}

/// The result does not depend on the storage of the matrix, also if only some ranks store blocks of nodes.
TEST(Multigrid, HasOneSolutionForAllWaysToStoreAMatrix) {
  const Truss truss(9, true);
  const int rank = truss.map->getComm()->getRank();
  Vector b(truss.map), expected(truss.map), x(truss.map);
  b.randomize();
  multigrid::Multigrid M(wrapped(truss.matrix), *wrapped(truss.matrix), 3, truss.modes);
  M.setup(wrapped(truss.matrix), true);
  M.apply(b, expected, Teuchos::NO_TRANS, 1, 0);
  for (const bool together : {true, rank % 2 == 1, rank % 2 == 0}) {
    const auto A = in_nodes(*truss.matrix, together);
    ASSERT_EQ(A->numbers().width, together ? 3 : 1);
    multigrid::Multigrid of_nodes(A, *A, 3, truss.modes);
    of_nodes.setup(A, true);
    of_nodes.apply(b, x, Teuchos::NO_TRANS, 1, 0);
    x.update(-1, expected, 1);
    EXPECT_LT(x.normInf(), 1e-12 * expected.normInf());
  }
}

/// Flat cells are coarsened across their short edges first, which are found by the coordinates. On four ranks, each
/// rank has four nodes of a column, which form two aggregates.
TEST(Multigrid, ContractsInFlatCells) {
  const FlatCells cells(16);
  const auto with = [&](const RCP<MultiVector>& places) {
    multigrid::Multigrid M(wrapped(cells.matrix), *wrapped(cells.matrix), 1, Teuchos::null, places);
    M.setup(wrapped(cells.matrix), true);
    EXPECT_LT(M.operator_complexity(), Tpetra::getDefaultComm()->getSize() < 4 ? 1.8 : 2.2);
    return contraction(*cells.matrix, M);
  };
  EXPECT_LT(with(cells.places), 0.5);
  EXPECT_GT(with(Teuchos::null), 0.7);
}

/// On symmetric matrices, the algorithm for unsymmetric ones gives almost the same result; it rounds R more often.
TEST(Multigrid, HasOneSolutionForSymmetricMatrices) {
  const Truss truss(13, true);
  Vector b(truss.map), y(truss.map), z(truss.map);
  b.randomize();
  multigrid::Multigrid M(wrapped(truss.matrix), *wrapped(truss.matrix), 3, truss.modes);
  M.setup(wrapped(truss.matrix), true);
  M.apply(b, y, Teuchos::NO_TRANS, 1, 0);
  M.setup(wrapped(truss.matrix), false);
  M.apply(b, z, Teuchos::NO_TRANS, 1, 0);
  z.update(-1, y, 1);
  EXPECT_LT(z.normInf(), 1e-6 * y.normInf());
}

/// Eigenvalues far from the real axis: the smoother extends its interval so that it does not amplify their components.
TEST(Multigrid, StaysBoundedWhereTheMatrixIsFarFromSymmetric) {
  for (const Real skew : {1.0, 3.0}) {
    const Truss truss(9, true, skew);
    multigrid::Multigrid M(wrapped(truss.matrix), *wrapped(truss.matrix), 3, truss.modes);
    M.setup(wrapped(truss.matrix), false);
    Vector b(truss.map), Mb(truss.map), r(truss.map);
    for (std::size_t i = 0; i < b.getLocalLength(); ++i) {
      const auto row = static_cast<Real>(truss.map->getGlobalElement(static_cast<LocalIndex>(i)));
      b.replaceLocalValue(static_cast<LocalIndex>(i), std::sin(row * row));
    }
    M.apply(b, Mb, Teuchos::NO_TRANS, 1, 0);
    truss.matrix->apply(Mb, r);
    r.update(1, b, -1);
    EXPECT_LT(r.norm2() / b.norm2(), 20) << skew;  // the set-up tests another vector, with the limit 5
  }
}

/// Without couplings between unknowns, multigrid consists of its smoother.
TEST(Multigrid, NeedsNoCoarseNodes) {
  const auto map = rcp(new Map(2000, 0, Tpetra::getDefaultComm()));
  const auto matrix = rcp(new CrsMatrix(map, 1));
  for (const GlobalIndex row : base::local_elements(*map)) {
    const Real value = 2;
    matrix->insertGlobalValues(row, 1, &value, &row);
  }
  matrix->fillComplete();
  multigrid::Multigrid M(wrapped(matrix), *wrapped(matrix), 1, Teuchos::null);
  M.setup(wrapped(matrix), true);
  Vector b(map), x(map), r(map);
  b.randomize();
  M.apply(b, x, Teuchos::NO_TRANS, 1, 0);
  matrix->apply(x, r);
  r.update(1, b, -1);
  EXPECT_LT(r.norm2(), 0.2 * b.norm2());
}

/// A matrix with the same graph replaces the first; a matrix with another graph is refused.
TEST(Multigrid, TakesOtherMatricesOfTheSameGraph) {
  const Truss truss(9, true), other(9, true, 0.01), larger(10, true);
  Vector b(truss.map), x(truss.map), y(truss.map);
  b.randomize();
  multigrid::Multigrid M(wrapped(truss.matrix), *wrapped(truss.matrix), 3, truss.modes),
      of_other(wrapped(other.matrix), *wrapped(truss.matrix), 3, truss.modes);
  M.setup(wrapped(truss.matrix), true);
  M.setup(wrapped(other.matrix), false);
  M.apply(b, x, Teuchos::NO_TRANS, 1, 0);
  of_other.setup(wrapped(other.matrix), false);
  of_other.apply(b, y, Teuchos::NO_TRANS, 1, 0);
  y.update(-1, x, 1);
  EXPECT_LT(y.normInf(), 1e-12 * x.normInf());
  EXPECT_THROW(M.setup(wrapped(larger.matrix), true), Error);
}

/// Applies alpha M b + beta y to two vectors at once; checks linearity up to round-off, and new values on the same
/// graph.
TEST(Multigrid, IsALinearOperatorAndFollowsTheMatrix) {
  const Truss truss(9, true);
  multigrid::Multigrid M(wrapped(truss.matrix), *wrapped(truss.matrix), 3, truss.modes);
  M.setup(wrapped(truss.matrix), true);
  MultiVector b(truss.map, 2), Mb(truss.map, 2), y(truss.map, 2);
  b.randomize();
  y.putScalar(3);
  M.apply(b, Mb, Teuchos::NO_TRANS, 1, 0);
  M.apply(b, y, Teuchos::NO_TRANS, 2, 0.5);
  y.update(-2, Mb, 1);
  Vector sum(truss.map), M_sum(truss.map);
  sum.update(1, *b.getVector(0), 1, *b.getVector(1), 0);
  M.apply(sum, M_sum, Teuchos::NO_TRANS, 1, 0);
  M_sum.update(-1, *Mb.getVector(0), -1, *Mb.getVector(1), 1);
  const Real size = Mb.getVector(0)->normInf();
  EXPECT_LT(M_sum.normInf(), 1e-12 * size);
  for (int v = 0; v < 2; ++v) {
    Vector rest(*y.getVector(v), Teuchos::Copy), ones(truss.map);
    ones.putScalar(1);
    rest.update(-1.5, ones, 1);
    EXPECT_LT(rest.normInf(), 1e-12 * std::max(1.0, size));
  }
  truss.matrix->resumeFill();
  truss.matrix->scale(4);
  truss.matrix->fillComplete();
  M.setup(wrapped(truss.matrix), true);
  MultiVector quarter(truss.map, 2);
  M.apply(b, quarter, Teuchos::NO_TRANS, 4, 0);
  quarter.update(-1, Mb, 1);
  EXPECT_LT(quarter.getVector(0)->normInf(), 1e-10 * size);
}

}  // namespace
}  // namespace sprekk::test
