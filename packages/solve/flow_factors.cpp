#include "solve/flow_factors.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sprekk::solve {
namespace {

constexpr Real min_pivot = 1e-8;  // relative to the diagonal

using Entries = std::vector<std::pair<LocalIndex, Real>>;  // columns and values of a row

void append(Entries& row, LocalRows& rows) {
  std::sort(row.begin(), row.end());
  for (const auto& [column, value] : row) {
    rows.column.push_back(column);
    rows.value.push_back(value);
  }
  rows.start.push_back(rows.column.size());
}

LocalRows empty_rows() { return {.start = {0}, .column = {}, .value = {}}; }

/// Returns the couplings within this rank, with a diagonal in each row.
LocalRows rows_of(const fields::CrsMatrix& A) {
  const auto rows = A.getRowMap()->getLocalMap(), columns = A.getColMap()->getLocalMap();
  const auto local = A.getLocalMatrixHost();
  auto result = empty_rows();
  Entries row;
  for (LocalIndex i = 0; i < local.numRows(); ++i) {
    row.clear();
    for (auto k = local.graph.row_map(i); k < local.graph.row_map(i + 1); ++k)
      if (const LocalIndex j = rows.getLocalElement(columns.getGlobalElement(local.graph.entries(k))); j >= 0)
        row.emplace_back(j, local.values(k));
    if (std::none_of(row.begin(), row.end(), [i](const auto& entry) { return entry.first == i; }))
      row.emplace_back(i, 0);
    append(row, result);
  }
  return result;
}

/// Returns the rows in this order, with positions as numbers.
LocalRows reordered(const LocalRows& A, const std::vector<LocalIndex>& order) {
  std::vector<LocalIndex> position(order.size());
  for (LocalIndex p = 0; p < A.n(); ++p) position[order[p]] = p;
  auto result = empty_rows();
  Entries row;
  for (const LocalIndex i : order) {
    row.clear();
    for (auto k = A.start[i]; k < A.start[i + 1]; ++k) row.emplace_back(position[A.column[k]], A.value[k]);
    append(row, result);
  }
  return result;
}

/// Returns A with zeros a_im for fill of the first level: a_ij a_jm with j < i and j < m.
LocalRows with_fill(const LocalRows& A) {
  auto result = empty_rows();
  std::vector<LocalIndex> row_of(A.n(), -1);  // [column] last row that contains it
  Entries row;
  for (LocalIndex i = 0; i < A.n(); ++i) {
    row.clear();
    for (auto k = A.start[i]; k < A.start[i + 1]; ++k) {
      row.emplace_back(A.column[k], A.value[k]);
      row_of[A.column[k]] = i;
    }
    for (auto k = A.start[i]; A.column[k] < i; ++k)
      for (auto m = A.find(A.column[k], A.column[k]) + 1; m < A.start[A.column[k] + 1]; ++m)
        if (std::exchange(row_of[A.column[m]], i) != i) row.emplace_back(A.column[m], 0);
    append(row, result);
  }
  return result;
}

}  // namespace

FlowFactors::FlowFactors(const fields::CrsMatrix& A) : map_(A.getRowMap()) {
  const auto rows = rows_of(A);
  order_ = flow_order(rows);
  factors_ = with_fill(reordered(rows, order_));
  factor();
}

void FlowFactors::factor() {
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
    if (!(std::abs(pivot) > min_pivot * std::abs(original))) pivot = original != 0 ? original : 1;
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
      Real sum = from(order_[i], v);
      for (auto k = start[i]; k < diagonal_[i]; ++k) sum -= value[k] * z_[column[k]];
      z_[i] = sum;
    }
    for (LocalIndex i = n - 1; i >= 0; --i) {
      Real sum = z_[i];
      for (auto k = diagonal_[i] + 1; k < start[i + 1]; ++k) sum -= value[k] * z_[column[k]];
      z_[i] = sum * inverse_[i];
      Real& end = to(order_[i], v);
      end = alpha * z_[i] + (beta == 0 ? 0 : beta * end);
    }
  }
}

}  // namespace sprekk::solve
