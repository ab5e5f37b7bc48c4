#include "fields/saved_rows.hpp"

namespace sprekk::fields {

namespace {

using Policy = Kokkos::RangePolicy<Execution>;

/// True if no marks have been added.
bool same(const SavedRows::Marks& before, const SavedRows::Marks& now) {
  if (before.bits.extent(0) != now.bits.extent(0)) return false;
  std::size_t n_other = 0;
  Kokkos::parallel_reduce(
      "new marks", Policy(0, now.bits.extent(0)),
      KOKKOS_LAMBDA(std::size_t w, std::size_t & sum) { sum += before.bits(w) != now.bits(w); }, n_other);
  return n_other == 0;
}

}  // namespace

SavedRows::SavedRows(RCP<const Matrix> J) : J_(J) {
  saved_.marks.number = View<LocalIndex*>("number of a row", J->numbers().n_rows());
  Kokkos::deep_copy(saved_.marks.number, -1);
  saved_.marks.first_word = View<std::size_t*>("words", 1);
}

SavedRows::Marks SavedRows::marks(const View<char*>& rows) const {
  const auto before = saved_.marks;
  const auto J = J_->numbers();
  const Policy all(0, rows.extent(0));
  LocalIndex n_saved = 0;
  Kokkos::parallel_reduce(
      "count rows", all,
      KOKKOS_LAMBDA(LocalIndex row, LocalIndex & sum) { sum += before.number(row) >= 0 || rows(row) != 0; }, n_saved);
  Marks now{View<LocalIndex*>("number of a row", rows.extent(0)),
            View<LocalIndex*>("saved rows", n_saved),
            View<std::size_t*>("words", n_saved + 1),
            {}};
  Kokkos::parallel_scan(
      "number rows", all, KOKKOS_LAMBDA(LocalIndex row, LocalIndex & sum, bool last) {
        const bool keeps = before.number(row) >= 0 || rows(row) != 0;
        if (last) now.number(row) = keeps ? sum : -1;
        if (last && keeps) now.row(sum) = row;
        sum += keeps;
      });
  std::size_t n_words = 0;
  Kokkos::parallel_scan(
      "count words", Policy(0, n_saved),
      KOKKOS_LAMBDA(LocalIndex k, std::size_t & sum, bool last) {
        sum += (J.length(now.row(k)) + Marks::word - 1) / Marks::word;
        if (last) now.first_word(k + 1) = sum;
      },
      n_words);
  now.bits = View<std::uint64_t*>("marks", n_words);
  Kokkos::parallel_for(
      "known marks", Policy(0, before.row.extent(0)), KOKKOS_LAMBDA(LocalIndex k) {
        const std::size_t to = now.first_word(now.number(before.row(k))), from = before.first_word(k);
        for (std::size_t w = 0; w < before.first_word(k + 1) - from; ++w) now.bits(to + w) = before.bits(from + w);
      });
  return now;
}

void SavedRows::keep(const Marks& marks) {
  const auto before = saved_;
  const auto J = J_->numbers();
  const Policy rows(0, marks.row.extent(0));
  if (same(before.marks, marks)) return;
  // Calls visit(word, bit, value of A) for the marks of a row. They include all its earlier marks.
  const auto for_values = KOKKOS_LAMBDA(LocalIndex k, const auto& visit) {
    const LocalIndex k_before = before.marks.number(marks.row(k));
    std::size_t i = k_before < 0 ? 0 : before.first_value(k_before), place = J.row(marks.row(k)).begin;
    for (std::size_t w = marks.first_word(k); w < marks.first_word(k + 1); ++w, place += Marks::word) {
      const std::size_t w_before = k_before < 0 ? 0 : before.marks.first_word(k_before) + w - marks.first_word(k);
      const std::uint64_t known = k_before < 0 ? 0 : before.marks.bits(w_before);
      for (std::uint64_t left = marks.bits(w); left != 0; left &= left - 1) {
        const std::size_t bit = lowest_bit(left);
        if (!(known >> bit & 1))
          visit(w, bit, J.value(place + bit));
        else
          visit(w, bit, before.present(w_before) >> bit & 1 ? before.value(i++) : 0);
      }
    }
  };
  Saved now{marks,
            View<std::uint64_t*>("present", marks.bits.extent(0)),
            View<std::size_t*>("first values", marks.row.extent(0) + 1),
            {}};
  std::size_t n_values = 0;
  Kokkos::parallel_scan(
      "count values", rows,
      KOKKOS_LAMBDA(LocalIndex k, std::size_t & sum, bool last) {
        for_values(k, [&](std::size_t, std::size_t, Real a) { sum += a != 0; });
        if (last) now.first_value(k + 1) = sum;
      },
      n_values);
  now.value = View<Real*>("saved values", n_values);
  Kokkos::parallel_for(
      "keep values", rows, KOKKOS_LAMBDA(LocalIndex k) {
        std::size_t to = now.first_value(k);
        for_values(k, [&](std::size_t w, std::size_t bit, Real a) {
          if (a == 0) return;
          now.present(w) |= std::uint64_t(1) << bit;
          now.value(to++) = a;
        });
      });
  saved_ = now;
}

void SavedRows::restore(const Matrix& matrix) const {
  const auto to = matrix.numbers();
  const auto saved = saved_;
  Kokkos::parallel_for(
      "restore", Policy(0, saved.marks.row.extent(0)), KOKKOS_LAMBDA(LocalIndex k) {
        const std::size_t begin = to.row(saved.marks.row(k)).begin;
        saved.for_values(k, [&](std::size_t place, Real a) { to.value(begin + place) = a; });
      });
}

/// The order of summation is that of unmarked rows, so the results are bitwise identical.
void SavedRows::add_local_product(const Vector& x, Vector& y) const {
  const auto J = J_->numbers();
  const auto saved = saved_;
  const auto from = x.getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto to = y.getLocalViewDevice(Tpetra::Access::ReadWrite);
  with_width(J.width, [&](auto width) {
    constexpr int w = width(), n_sums = NodeRows::n_sums<w>;
    const Real* const first = Kokkos::subview(from, Kokkos::ALL(), 0).data();
    Kokkos::parallel_for(
        "product", Policy(0, J.n_rows()), KOKKOS_LAMBDA(LocalIndex i) {
          const LocalIndex k = saved.marks.number(i);
          if (k < 0) {
            to(i, 0) += J.product<w>(i, first);
            return;
          }
          const auto row = J.row(i);
          const std::size_t length = w * row.n_nodes;
          Real sums[n_sums] = {};
          std::size_t place = 0;
          const auto add = [&](Real a) {  // the value at the next place
            if (a != 0) sums[place % n_sums] += a * from(J.column(row.first_node + place / w) * w + place % w, 0);
            ++place;
          };
          saved.for_values(k, [&](std::size_t marked, Real a) {
            while (place < marked) add(J.value(row.begin + place));
            add(a);
          });
          while (place < length) add(J.value(row.begin + place));
          to(i, 0) += NodeRows::total(sums);
        });
  });
}

void SavedRows::add_product(const Vector& x, Vector& y) const {
  if (J_->import().is_null()) return add_local_product(x, y);
  Vector all(J_->column_map());
  J_->spread(x, all);
  add_local_product(all, y);
}

}  // namespace sprekk::fields
