#include "fields/matrix.hpp"

#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <algorithm>
#include <cmath>

namespace sprekk::fields {
namespace {

/// Graph of blocks height x width: seven nodes per rank, each coupled to itself and to nodes of this and the next
/// rank. `scattered`: one entry is missing, hence the graph does not consist of full blocks.
struct Graph {
  Graph(int height_, int width_, bool scattered_) : height(height_), width(width_), scattered(scattered_) {
    const auto comm = Tpetra::getDefaultComm();
    const GlobalIndex n = 7 * comm->getSize();
    rows = rcp(new const Map(height * n, 0, comm));
    domain = rcp(new const Map(width * n, 0, comm));
    const GlobalIndex first = 7 * comm->getRank();
    std::vector<GlobalIndex> nodes;
    for (GlobalIndex i = 0; i < 7; ++i) nodes.push_back(first + i);
    for (GlobalIndex i = 7; i < 9 && comm->getSize() > 1; ++i) nodes.push_back((first + i) % n);
    std::vector<GlobalIndex> unknowns;
    for (const GlobalIndex node : nodes)
      for (int c = 0; c < width; ++c) unknowns.push_back(width * node + c);
    columns = make_map(unknowns, comm);
    std::vector<LocalIndex> named;
    start = View<std::size_t*>("start", 7 * height + 1);
    for (LocalIndex row = 0; row < 7 * height; ++row) {
      const int i = row / height;
      for (const std::size_t k : {i, i + 1, i + 2})
        for (int c = 0; c < width && k < nodes.size(); ++c)
          if (!scattered || row != 5 || c > 0) named.push_back(static_cast<LocalIndex>(width * k) + c);
      start(row + 1) = named.size();
    }
    column = View<LocalIndex*>("column", named.size());
    std::copy(named.begin(), named.end(), column.data());
  }

  Matrix matrix() const {
    Matrix A(rows, columns, domain, start, column, height, width);
    const auto numbers = A.numbers();
    for (LocalIndex row = 0; row < numbers.n_rows(); ++row)
      numbers.for_row(row, [&](LocalIndex c, std::size_t place) { numbers.value(place) = number(row, c); });
    return A;
  }
  Real number(LocalIndex row, LocalIndex c) const {
    return std::sin(Real(3 * rows->getGlobalElement(row) + 7 * columns->getGlobalElement(c) + 1));
  }

  int height, width;
  bool scattered;
  RCP<const Map> rows, columns, domain;
  View<std::size_t*> start;
  View<LocalIndex*> column;
};

template <class Check>
void for_each_graph(const Check& check) {
  for (const int height : {1, 2, 3, 4})
    for (const int width : {1, 2, 3, 4})
      for (const bool scattered : {false, true}) {
        SCOPED_TRACE(::testing::Message() << height << " x " << width << (scattered ? ", scattered" : ""));
        check(Graph(height, width, scattered));
      }
}

TEST(Matrix, NamesNodesOnceWhereItCan) {
  for_each_graph([](const Graph& graph) {
    const auto numbers = graph.matrix().numbers();
    const bool blocks = graph.height < 4 && graph.width < 4 && !graph.scattered;
    EXPECT_EQ(numbers.height, blocks ? graph.height : 1);
    EXPECT_EQ(numbers.width, blocks ? graph.width : 1);
    EXPECT_EQ(numbers.column.extent(0) * numbers.height * numbers.width, graph.column.extent(0));
    ASSERT_EQ(numbers.n_rows(), 7 * graph.height);
    std::size_t at = 0;
    for (LocalIndex row = 0; row < numbers.n_rows(); ++row) {
      EXPECT_EQ(numbers.length(row), graph.start(row + 1) - graph.start(row));
      numbers.for_row(row, [&](LocalIndex c, std::size_t place) {
        ASSERT_LT(at, graph.start(row + 1));
        EXPECT_EQ(c, graph.column(at));
        EXPECT_EQ(place, at++);
      });
      EXPECT_EQ(at, graph.start(row + 1));
    }
  });
}

TEST(Matrix, MultipliesAsItsNumbersSay) {
  for_each_graph([](const Graph& graph) {
    const auto A = graph.matrix();
    const Matrix again(A.crs());
    MultiVector x(graph.domain, 2), y(graph.rows, 2), z(graph.rows, 2), of_tpetra(graph.rows, 2);
    MultiVector all(graph.columns, 2);
    x.randomize(-1, 1);
    all.doImport(x, Import(graph.domain, graph.columns), Tpetra::INSERT);
    for (auto* to : {&y, &z, &of_tpetra}) to->putScalar(3);
    A.apply(x, y, Teuchos::NO_TRANS, 2, -0.5);
    again.apply(x, z, Teuchos::NO_TRANS, 2, -0.5);
    A.crs()->apply(x, of_tpetra, Teuchos::NO_TRANS, 2, -0.5);
    for (std::size_t v = 0; v < 2; ++v)
      for (LocalIndex row = 0; row < 7 * graph.height; ++row) {
        Real sum = -1.5;
        for (std::size_t k = graph.start(row); k < graph.start(row + 1); ++k)
          sum += 2 * graph.number(row, graph.column(k)) * all.getData(v)[graph.column(k)];
        EXPECT_NEAR(y.getData(v)[row], sum, 1e-14);
        EXPECT_NEAR(z.getData(v)[row], sum, 1e-14);
        EXPECT_NEAR(of_tpetra.getData(v)[row], sum, 1e-14);
      }
  });
}

TEST(Matrix, SharesItsNumbersWithThatOfTpetra) {
  for_each_graph([](const Graph& graph) {
    const auto A = graph.matrix();
    EXPECT_EQ(A.crs(), A.crs());
    EXPECT_EQ(A.crs()->getLocalMatrixHost().values.data(), A.numbers().value.data());
    EXPECT_EQ(Matrix(A.crs()).numbers().value.data(), A.numbers().value.data());
    EXPECT_TRUE(A.crs()->getDomainMap()->isSameAs(*graph.domain));
  });
}

TEST(Matrix, HasADiagonal) {
  for_each_graph([](const Graph& graph) {
    if (graph.height != graph.width) return;
    const auto A = graph.matrix();
    Vector d(graph.rows);
    d.putScalar(7);
    A.copy_diagonal(d);
    for (LocalIndex row = 0; row < 7 * graph.height; ++row) {
      bool there = false;
      for (std::size_t k = graph.start(row); k < graph.start(row + 1); ++k) there = there || graph.column(k) == row;
      EXPECT_EQ(d.getData()[row], there ? graph.number(row, row) : 0) << row;
    }
  });
}

}  // namespace
}  // namespace sprekk::fields
