#include "fields/matrix.hpp"

#include "base/check.hpp"

namespace sprekk::fields {

namespace {

using Policy = Kokkos::RangePolicy<Execution>;

/// True if the unknowns of every column node are adjacent, and the rows of every node have the same columns.
bool in_blocks(const Map& columns, const View<std::size_t*>& start, const View<LocalIndex*>& column, int height,
               int width) {
  constexpr int maximum = 3;
  const auto n_columns = static_cast<LocalIndex>(base::n_local_elements(columns));
  const auto n_rows = static_cast<LocalIndex>(start.extent(0)) - 1;
  if (height > maximum || width > maximum || n_columns % width != 0 || n_rows % height != 0) return false;
  for (LocalIndex c = 0; c < n_columns; ++c)
    if (columns.getGlobalElement(c) != columns.getGlobalElement(c - c % width) + c % width ||
        columns.getGlobalElement(c) % width != c % width)
      return false;
  for (LocalIndex row = 0; row < n_rows; ++row) {
    const LocalIndex of_node = row - row % height;
    const std::size_t first = start(of_node), begin = start(row), length = start(row + 1) - begin;
    if (length % width != 0 || start(of_node + 1) - first != length) return false;
    for (std::size_t k = 0; k < length; ++k) {
      const auto c = static_cast<LocalIndex>(k % width);
      if (column(begin + k) != column(first + k) || column(begin + k) % width != c ||
          column(begin + k) != column(begin + k - c) + c)
        return false;
    }
  }
  return true;
}

RCP<const Import> import_of(const RCP<const Map>& domain, const RCP<const Map>& columns) {
  if (domain == columns || domain->isSameAs(*columns)) return Teuchos::null;
  return rcp(new Import(domain, columns));
}

}  // namespace

Matrix::Matrix(const RCP<const Map>& rows, const RCP<const Map>& columns, const RCP<const Map>& domain,
               const View<std::size_t*>& start, const View<LocalIndex*>& column, int height, int width)
    : rows_(rows), columns_(columns), domain_(domain), import_(import_of(domain, columns)) {
  numbers_ = {1, 1, start, column, View<Real*>("numbers", column.extent(0))};
  if (height * width == 1 || !in_blocks(*columns, start, column, height, width)) return;
  const auto n = (static_cast<LocalIndex>(start.extent(0)) - 1) / height;
  const View<std::size_t*> start_of_node("start", n + 1);
  const View<LocalIndex*> node("columns", column.extent(0) / (height * width));
  Kokkos::parallel_for(
      "blocks", Policy(0, n), KOKKOS_LAMBDA(LocalIndex i) {
        const std::size_t begin = start(height * i), first = begin / (height * width);
        const std::size_t n_nodes = (start(height * i + 1) - begin) / width;
        start_of_node(i + 1) = first + n_nodes;
        for (std::size_t k = 0; k < n_nodes; ++k) node(first + k) = column(begin + width * k) / width;
      });
  numbers_ = {height, width, start_of_node, node, numbers_.value};
}

Matrix::Matrix(const RCP<const Map>& rows, const RCP<const Map>& columns, const RCP<const Map>& domain,
               NodeRows numbers)
    : rows_(rows),
      columns_(columns),
      domain_(domain),
      import_(import_of(domain, columns)),
      numbers_(std::move(numbers)) {}

Matrix::Matrix(const RCP<const CrsMatrix>& A)
    : rows_(A->getRowMap()),
      columns_(A->getColMap()),
      domain_(A->getDomainMap()),
      import_(A->getGraph()->getImporter()),
      crs_(Teuchos::rcp_const_cast<CrsMatrix>(A)) {
  const auto local = A->getLocalMatrixDevice();
  const View<std::size_t*> start("start", local.numRows() + 1);
  if (local.numRows() > 0) Kokkos::deep_copy(start, local.graph.row_map);
  numbers_ = {1, 1, start, local.graph.entries, local.values};
}

RCP<CrsMatrix> Matrix::crs() const {
  if (!crs_.is_null()) return crs_;
  using Local = CrsMatrix::local_matrix_device_type;
  const auto numbers = numbers_;
  const LocalIndex n_rows = numbers.n_rows();
  Local::row_map_type::non_const_type start = numbers.start;
  Local::index_type::non_const_type column = numbers.column;
  if (numbers.height * numbers.width > 1) {
    start = View<std::size_t*>("start", n_rows + 1);
    column = View<LocalIndex*>("columns", numbers.value.extent(0));
    Kokkos::parallel_for(
        "rows", Policy(0, n_rows), KOKKOS_LAMBDA(LocalIndex i) {
          start(i + 1) = numbers.row(i).begin + numbers.length(i);
          numbers.for_row(i, [&](LocalIndex c, std::size_t place) { column(place) = c; });
        });
  }
  const Local local("matrix", n_rows, static_cast<LocalIndex>(base::n_local_elements(*columns_)), column.extent(0),
                    numbers.value, start, column);
  return crs_ = rcp(new CrsMatrix(local, rows_, columns_, domain_, rows_, import_, Teuchos::null));
}

void Matrix::apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp mode, Real alpha, Real beta) const {
  SPREKK_CHECK(mode == Teuchos::NO_TRANS, "products with the transpose are made with crs()");
  const MultiVector* from = &x;
  if (!import_.is_null()) {
    if (x_.is_null() || x_->getNumVectors() != x.getNumVectors())
      x_ = rcp(new MultiVector(columns_, x.getNumVectors()));
    x_->doImport(x, *import_, Tpetra::INSERT);
    from = x_.get();
  }
  const auto given = from->getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto result = y.getLocalViewDevice(Tpetra::Access::ReadWrite);
  const auto numbers = numbers_;
  with_width(numbers.width, [&](auto width) {
    constexpr int w = width();
    for (std::size_t v = 0; v < x.getNumVectors(); ++v) {
      const Real* const from_v = Kokkos::subview(given, Kokkos::ALL(), v).data();
      Kokkos::parallel_for(
          "product", Policy(0, numbers.n_rows()), KOKKOS_LAMBDA(LocalIndex i) {
            const Real sum = alpha * numbers.product<w>(i, from_v);
            result(i, v) = beta == 0 ? sum : sum + beta * result(i, v);
          });
    }
  });
}

void Matrix::copy_diagonal(Vector& d) const {
  const auto numbers = numbers_;
  const auto rows = rows_->getLocalMap(), columns = columns_->getLocalMap();
  const auto to = d.getLocalViewDevice(Tpetra::Access::OverwriteAll);
  Kokkos::parallel_for(
      "diagonal", Policy(0, numbers.n_rows()), KOKKOS_LAMBDA(LocalIndex i) {
        const LocalIndex own = columns.getLocalElement(rows.getGlobalElement(i));
        const auto row = numbers.row(i);
        to(i, 0) = 0;
        for (std::size_t k = 0; k < row.n_nodes; ++k)
          if (const LocalIndex c = own - numbers.column(row.first_node + k) * numbers.width;
              c >= 0 && c < numbers.width && own >= 0)
            to(i, 0) = numbers.value(row.begin + k * numbers.width + c);
      });
}

void Matrix::spread(const Vector& x, Vector& values) const {
  if (import_.is_null())
    Tpetra::deep_copy(values, x);
  else
    values.doImport(x, *import_, Tpetra::INSERT);
}

}  // namespace sprekk::fields
