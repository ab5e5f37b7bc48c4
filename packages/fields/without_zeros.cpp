#include "fields/without_zeros.hpp"

#include "base/over_ranks.hpp"

namespace sprekk::fields {

RCP<CrsMatrix> without_zeros(const RCP<CrsMatrix>& A) {
  using Policy = Kokkos::RangePolicy<Execution>;
  using Local = CrsMatrix::local_matrix_device_type;
  const auto from = A->getLocalMatrixDevice();
  const LocalIndex n_rows = from.numRows();
  const Local::row_map_type::non_const_type start("start", n_rows + 1);
  std::size_t n_left = 0;
  Kokkos::parallel_scan(
      "count numbers", Policy(0, n_rows),
      KOKKOS_LAMBDA(LocalIndex row, std::size_t & sum, bool last) {
        for (auto k = from.graph.row_map(row); k < from.graph.row_map(row + 1); ++k) sum += from.values(k) != 0;
        if (last) start(row + 1) = sum;
      },
      n_left);
  if (!base::on_any_rank(*A->getComm(), n_left < from.nnz())) return A;
  const Local::index_type::non_const_type column("columns", n_left);
  const Local::values_type::non_const_type value("values", n_left);
  Kokkos::parallel_for(
      "copy numbers", Policy(0, n_rows), KOKKOS_LAMBDA(LocalIndex row) {
        auto to = start(row);
        for (auto k = from.graph.row_map(row); k < from.graph.row_map(row + 1); ++k) {
          if (from.values(k) == 0) continue;
          column(to) = from.graph.entries(k);
          value(to++) = from.values(k);
        }
      });
  const auto result = rcp(new CrsMatrix(A->getRowMap(), A->getColMap(), start, column, value));
  result->expertStaticFillComplete(A->getDomainMap(), A->getRangeMap(), A->getGraph()->getImporter());
  return result;
}

}  // namespace sprekk::fields
