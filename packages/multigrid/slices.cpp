#include "multigrid/slices.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>

namespace sprekk::multigrid {
namespace {

constexpr int max_slices = 32;
constexpr Real max_repeated = 0.15;  // of the entries of A P

std::vector<LocalIndex> cut(LocalIndex n_rows, int n_slices) {
  std::vector<LocalIndex> first;
  for (int s = 0; s <= n_slices; ++s)
    first.push_back(static_cast<LocalIndex>(static_cast<std::int64_t>(n_rows) * s / n_slices));
  return first;
}

/// Calls visit(slice, row) for the rows of A P that a slice computes: those it needs that are neither saved nor in the
/// buffer from the previous slice.
template <class Visit>
void for_rows(const NodeGraph& R, const std::vector<LocalIndex>& first, const View<std::size_t*>& start_saved,
              const Visit& visit) {
  std::vector<int> made_by(R.columns->n_all(), -2);
  for (int s = 0; s + 1 < static_cast<int>(first.size()); ++s)
    for (std::size_t e = R.start(first[s]); e < R.start(first[s + 1]); ++e) {
      const LocalIndex row = R.column(e);
      if (start_saved(row + 1) > start_saved(row) || made_by[row] >= s - 1) continue;
      made_by[row] = s;
      visit(s, row);
    }
}

/// Returns the starts of saved rows: rows needed by other ranks, and ghost rows.
View<std::size_t*> start_of_saved(const Halo& halo, const View<std::size_t*>& start) {
  const View<std::size_t*> result("start of saved rows", halo.n_all() + 1);
  const auto keep = [&](LocalIndex row) { result(row + 1) = start(row + 1) - start(row); };
  for (const LocalIndex row : halo.sent_nodes()) keep(row);
  for (LocalIndex row = halo.n_owned(); row < halo.n_all(); ++row) keep(row);
  for (LocalIndex row = 0; row < halo.n_all(); ++row) result(row + 1) += result(row);
  return result;
}

}  // namespace

std::size_t Slices::bytes() const {
  return sizeof(std::size_t) * (to.extent(0) + start_saved.extent(0) + at.extent(0)) +
         sizeof(LocalIndex) * made.extent(0);
}

Slices make_slices(const NodeGraph& R, const View<std::size_t*>& start) {
  const auto& halo = *R.columns;
  Slices slices;
  slices.start_saved = start_of_saved(halo, start);
  const auto length = [&](LocalIndex row) { return start(row + 1) - start(row); };
  const auto n_entries = [&](int n_slices) {
    std::size_t sum = 0;
    for_rows(R, cut(R.n_rows(), n_slices), slices.start_saved, [&](int, LocalIndex row) { sum += length(row); });
    return sum;
  };
  const auto maximum = static_cast<std::size_t>((1 + max_repeated) * static_cast<Real>(n_entries(1)));
  int n = max_slices;
  while (n > 1 && n_entries(n) > maximum) n -= (n + 3) / 4;
  slices.first = cut(R.n_rows(), n);

  const auto saved = slices.start_saved;
  std::vector<LocalIndex> made;
  std::vector<std::size_t> to, length_of(n, 0);  // of slices
  slices.first_made.assign(n + 2, 0);
  for (LocalIndex row = 0; row < halo.n_owned(); ++row)
    if (saved(row + 1) > saved(row)) {
      made.push_back(row);
      to.push_back(saved(row));
      ++slices.first_made[1];
    }
  for_rows(R, slices.first, saved, [&](int s, LocalIndex row) {
    made.push_back(row);
    to.push_back(length_of[s]);
    length_of[s] += length(row);
    ++slices.first_made[s + 2];
  });
  std::partial_sum(slices.first_made.begin(), slices.first_made.end(), slices.first_made.begin());
  std::size_t length_of_part[2] = {};
  for (int s = 0; s < n; ++s) length_of_part[s % 2] = std::max(length_of_part[s % 2], length_of[s]);
  const std::size_t first_of_part[] = {saved(halo.n_all()), saved(halo.n_all()) + length_of_part[0]};
  slices.size = first_of_part[1] + length_of_part[1];
  for (int s = 0; s < n; ++s)
    for (std::size_t k = slices.first_made[s + 1]; k < slices.first_made[s + 2]; ++k) to[k] += first_of_part[s % 2];

  slices.at = View<std::size_t*>("places of rows", halo.n_all());
  std::copy_n(saved.data(), halo.n_all(), slices.at.data());
  slices.made = View<LocalIndex*>("rows to make", made.size());
  std::copy(made.begin(), made.end(), slices.made.data());
  slices.to = View<std::size_t*>("where to make them", to.size());
  std::copy(to.begin(), to.end(), slices.to.data());
  return slices;
}

}  // namespace sprekk::multigrid
