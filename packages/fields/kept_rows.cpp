#include "fields/kept_rows.hpp"

namespace sprekk::fields {

namespace {

using Policy = Kokkos::RangePolicy<Execution>;

/// Sums of a row: that of place p takes part in number p % n_sums, so that an addition need not wait for the one
/// before, and rows have the same bits whether they are kept, without zeros, or not.
constexpr int n_sums = 4;

KOKKOS_INLINE_FUNCTION Real total(const Real (&sums)[n_sums]) { return (sums[0] + sums[1]) + (sums[2] + sums[3]); }

}  // namespace

KeptRows::KeptRows(RCP<const CrsMatrix> J) : J_(J) {
  kept_.number = View<LocalIndex*>("number of a row", J->getNodeNumRows());
  Kokkos::deep_copy(kept_.number, -1);
}

void KeptRows::keep(const View<char*>& rows) {
  const auto before = kept_;
  const auto J = J_->getLocalMatrixDevice();
  const Policy all(0, before.number.extent(0));
  const auto number = before.number;
  LocalIndex n_kept = 0;
  Kokkos::parallel_reduce(
      "kept rows", all, KOKKOS_LAMBDA(LocalIndex row, LocalIndex & sum) { sum += number(row) >= 0 || rows(row) != 0; },
      n_kept);
  if (n_kept == static_cast<LocalIndex>(before.row.extent(0))) return;
  Rows now{View<LocalIndex*>("number of a row", number.extent(0)), View<LocalIndex*>("kept rows", n_kept),
           View<std::size_t*>("kept values", n_kept + 1), View<std::size_t*>("words", n_kept + 1)};
  Kokkos::parallel_scan(
      "number rows", all, KOKKOS_LAMBDA(LocalIndex row, LocalIndex & sum, bool last) {
        const bool keeps = number(row) >= 0 || rows(row) != 0;
        if (last) now.number(row) = keeps ? sum : -1;
        if (last && keeps) now.row(sum) = row;
        sum += keeps;
      });
  // visit(place, value) for values of A in a row that are not 0
  const auto for_values = KOKKOS_LAMBDA(LocalIndex row, const auto& visit) {
    if (const LocalIndex k = number(row); k >= 0) return before.for_values(k, visit);
    const auto begin = J.graph.row_map(row);
    for (auto i = begin; i < J.graph.row_map(row + 1); ++i)
      if (J.values(i) != 0) visit(i - begin, J.values(i));
  };
  std::size_t n_values = 0;
  Kokkos::parallel_scan(
      "count values", Policy(0, n_kept),
      KOKKOS_LAMBDA(LocalIndex k, std::size_t & sum, bool last) {
        for_values(now.row(k), [&](std::size_t, Real) { ++sum; });
        if (last) now.first_value(k + 1) = sum;
      },
      n_values);
  std::size_t n_words = 0;
  Kokkos::parallel_scan(
      "count words", Policy(0, n_kept),
      KOKKOS_LAMBDA(LocalIndex k, std::size_t & sum, bool last) {
        const std::size_t length = J.graph.row_map(now.row(k) + 1) - J.graph.row_map(now.row(k));
        sum += (length + Rows::word - 1) / Rows::word;
        if (last) now.first_word(k + 1) = sum;
      },
      n_words);
  now.present = View<std::uint64_t*>("present", n_words);
  now.value = View<Real*>("kept values", n_values);
  Kokkos::parallel_for(
      "keep values", Policy(0, n_kept), KOKKOS_LAMBDA(LocalIndex k) {
        auto to = now.first_value(k);
        for_values(now.row(k), [&](std::size_t at, Real a) {
          now.present(now.first_word(k) + at / Rows::word) |= std::uint64_t(1) << at % Rows::word;
          now.value(to++) = a;
        });
      });
  kept_ = now;
}

void KeptRows::restore(const CrsMatrix& matrix) const {
  const auto to = matrix.getLocalMatrixDevice();
  const auto kept = kept_;
  Kokkos::parallel_for(
      "restore", Policy(0, kept.row.extent(0)), KOKKOS_LAMBDA(LocalIndex k) {
        const auto begin = to.graph.row_map(kept.row(k)), end = to.graph.row_map(kept.row(k) + 1);
        for (auto i = begin; i < end; ++i) to.values(i) = 0;
        kept.for_values(k, [&](std::size_t at, Real a) { to.values(begin + at) = a; });
      });
}

void KeptRows::add_local_product(const Vector& x, Vector& y) const {
  const auto J = J_->getLocalMatrixDevice();
  const auto kept = kept_;
  const auto from = x.getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto to = y.getLocalViewDevice(Tpetra::Access::ReadWrite);
  Kokkos::parallel_for(
      "product", Policy(0, J.numRows()), KOKKOS_LAMBDA(LocalIndex row) {
        const auto begin = J.graph.row_map(row), end = J.graph.row_map(row + 1);
        Real sums[n_sums] = {};
        if (const LocalIndex k = kept.number(row); k >= 0) {
          kept.for_values(
              k, [&](std::size_t at, Real a) { sums[at % n_sums] += a * from(J.graph.entries(begin + at), 0); });
        } else {
          auto i = begin;
          for (; i + n_sums <= end; i += n_sums)
            for (int s = 0; s < n_sums; ++s) sums[s] += J.values(i + s) * from(J.graph.entries(i + s), 0);
          for (int s = 0; i + s < end; ++s) sums[s] += J.values(i + s) * from(J.graph.entries(i + s), 0);
        }
        to(row, 0) += total(sums);
      });
}

void KeptRows::add_product(const Vector& x, Vector& y) const {
  const auto import = J_->getGraph()->getImporter();
  if (import.is_null()) return add_local_product(x, y);
  Vector all(J_->getColMap());
  all.doImport(x, *import, Tpetra::INSERT);
  add_local_product(all, y);
}

}  // namespace sprekk::fields
