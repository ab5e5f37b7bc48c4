#include "solve/flow_factors.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sprekk::solve {
namespace {

constexpr Real min_pivot = 1e-8;  // relative to the diagonal

}  // namespace

FlowFactors::FlowFactors(const fields::CrsMatrix& A) : map_(A.getRowMap()) {
  const auto rows = A.getRowMap()->getLocalMap(), columns = A.getColMap()->getLocalMap();
  const auto local = A.getLocalMatrixHost();
  std::vector<std::pair<LocalIndex, Real>> row;
  rows_ = {.start = {0}, .column = {}, .value = {}};
  for (LocalIndex i = 0; i < local.numRows(); ++i) {
    row.clear();
    for (auto k = local.graph.row_map(i); k < local.graph.row_map(i + 1); ++k)
      if (const LocalIndex j = rows.getLocalElement(columns.getGlobalElement(local.graph.entries(k))); j >= 0)
        row.emplace_back(j, local.values(k));
    if (std::none_of(row.begin(), row.end(), [i](const auto& entry) { return entry.first == i; }))
      row.emplace_back(i, 0);
    std::sort(row.begin(), row.end());
    for (const auto& [j, value] : row) {
      rows_.column.push_back(j);
      rows_.value.push_back(value);
    }
    rows_.start.push_back(rows_.column.size());
  }
  order_ = flow_order(rows_);
}

/// Copies the rows to the factors, with positions as numbers.
void FlowFactors::reorder() {
  const LocalIndex n = rows_.n();
  std::vector<LocalIndex> position(n);
  for (LocalIndex p = 0; p < n; ++p) position[order_.row[p]] = p;
  factors_ = {.start = {0}, .column = {}, .value = {}};
  factors_.column.reserve(rows_.column.size());
  factors_.value.reserve(rows_.column.size());
  std::vector<std::pair<LocalIndex, Real>> row;
  for (LocalIndex p = 0; p < n; ++p) {
    const LocalIndex i = order_.row[p];
    row.clear();
    for (auto k = rows_.start[i]; k < rows_.start[i + 1]; ++k)
      row.emplace_back(position[rows_.column[k]], rows_.value[k]);
    std::sort(row.begin(), row.end());
    for (const auto& [j, value] : row) {
      factors_.column.push_back(j);
      factors_.value.push_back(value);
    }
    factors_.start.push_back(factors_.column.size());
  }
}

void FlowFactors::factor() {
  reorder();
  auto& [start, column, value] = factors_;
  const LocalIndex n = factors_.n();
  diagonal_.resize(n);
  inverse_.resize(n);
  z_.resize(n);
  constexpr auto absent = static_cast<std::size_t>(-1);
  std::vector<std::size_t> place(n, absent);  // [position] in the present row
  for (LocalIndex i = 0; i < n; ++i) {
    for (auto k = start[i]; k < start[i + 1]; ++k) place[column[k]] = k;
    diagonal_[i] = place[i];
    const Real original = value[place[i]];
    for (auto k = start[i]; k < diagonal_[i]; ++k) {
      const LocalIndex j = column[k];
      value[k] *= inverse_[j];
      for (auto m = diagonal_[j] + 1; m < start[j + 1]; ++m)
        if (const auto to = place[column[m]]; to != absent) value[to] -= value[k] * value[m];
    }
    Real& pivot = value[diagonal_[i]];
    if (!(pivot * original > min_pivot * original * original)) pivot = original != 0 ? original : 1;
    inverse_[i] = 1 / pivot;
    for (auto k = start[i]; k < start[i + 1]; ++k) place[column[k]] = absent;
  }
}

double FlowFactors::bytes() const {
  return static_cast<double>(factors_.value.size() * (sizeof(Real) + sizeof(LocalIndex)) +
                             z_.size() * (2 * sizeof(Real) + 2 * sizeof(std::size_t)));
}

void FlowFactors::apply(const fields::MultiVector& b, fields::MultiVector& y, Teuchos::ETransp, Real alpha,
                        Real beta) const {
  const auto& [start, column, value] = factors_;
  const auto from = b.getLocalViewHost(Tpetra::Access::ReadOnly);
  const auto to = y.getLocalViewHost(Tpetra::Access::ReadWrite);
  const LocalIndex n = factors_.n();
  for (std::size_t v = 0; v < from.extent(1); ++v) {
    for (LocalIndex i = 0; i < n; ++i) {
      Real sum = from(order_.row[i], v);
      for (auto k = start[i]; k < diagonal_[i]; ++k) sum -= value[k] * z_[column[k]];
      z_[i] = sum;
    }
    for (LocalIndex i = n - 1; i >= 0; --i) {
      Real sum = z_[i];
      for (auto k = diagonal_[i] + 1; k < start[i + 1]; ++k) sum -= value[k] * z_[column[k]];
      z_[i] = sum * inverse_[i];
      Real& end = to(order_.row[i], v);
      end = alpha * z_[i] + (beta == 0 ? 0 : beta * end);
    }
  }
}

}  // namespace sprekk::solve
