#include "solve/group_change.hpp"

#include <algorithm>
#include <cmath>

#include "base/over_ranks.hpp"
#include "solve/small_lu.hpp"

namespace sprekk::solve {
namespace {

constexpr Real same = 1e-13;  // relative change of a row by round-off

std::vector<Real> copy_of(const View<Real*>& values, std::size_t n) {
  const auto host = base::to_host(Kokkos::subview(values, std::pair<std::size_t, std::size_t>(0, n)));
  return {host.data(), host.data() + n};
}

}  // namespace

GroupChange::GroupChange(const BlockProblem& problem, const GroupPlan& group, int a)
    : problem_(problem), group_(group), a_(a), m_(group.size), rank_(problem.comm()->getRank()) {
  const auto& response = group.response.front();
  const auto start = base::to_host(response.column_start);
  const auto column = base::to_host(response.column);
  const LocalIndex n = group.slots->n_owned();
  start_.assign(start.data(), start.data() + n + 1);
  std::vector<GlobalIndex> columns(column.data(), column.data() + start_[n]), all = columns;
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  map_ = fields::make_map(all, problem.comm());
  for (const GlobalIndex c : columns)
    column_.push_back(static_cast<LocalIndex>(std::lower_bound(all.begin(), all.end(), c) - all.begin()));
  marked_.assign(n * m_, 0);
  chosen_ = marked_;
}

void GroupChange::take_coupling(const View<Real*>& coupling) {
  dense_ = base::to_host(group_.dense);
  unit_ = copy_of(group_.column_scale, m_);
  coupling_ = copy_of(coupling, m_ * start_.back());
}

void GroupChange::set_reference() {
  dense0_ = copy_of(group_.dense, group_.dense.extent(0));
  lu0_ = copy_of(group_.lu, group_.lu.extent(0));
  coupling0_ = coupling_;
  const auto pivot = base::to_host(group_.pivot);
  pivot0_.assign(pivot.data(), pivot.data() + pivot.extent(0));
  std::fill(chosen_.begin(), chosen_.end(), 0);
  rows_.clear();
  first_.assign(problem_.comm()->getSize() + 1, 0);
}

/// Calls visit(value now, value of the reference, size of the unknown) for the terms of a row.
template <class Visit>
void GroupChange::for_terms(LocalIndex e, int i, const Visit& visit) const {
  const std::size_t row = (e * m_ + i) * m_;
  for (int j = 0; j < m_; ++j) visit(dense_(row + j), dense0_[row + j], unit_[j]);
  const std::size_t begin = m_ * start_[e] + i * n_columns(e);
  const Real size = problem_.blocks()[a_].kinematic_scale / problem_.blocks()[group_.blocks.front()].kinematic_scale;
  for (std::size_t c = begin; c < begin + n_columns(e); ++c) visit(coupling_[c], coupling0_[c], size);
}

/// Returns the factor that brings a row closest to that of the reference.
Real GroupChange::scale(LocalIndex e, int i) const {
  Real square = 0, product = 0, square0 = 0;
  for_terms(e, i, [&](Real now, Real then, Real size) {
    square += now * now * size * size;
    product += now * then * size * size;
    square0 += then * then * size * size;
  });
  return std::abs(product) > 0.1 * std::sqrt(square * square0) ? product / square : std::sqrt(square0 / square);
}

bool GroupChange::mark_changes() {
  bool unexpected = false;
  for (LocalIndex e = 0; e + 1 < static_cast<LocalIndex>(start_.size()); ++e)
    for (int i = 0; i < m_; ++i) {
      if (chosen_[e * m_ + i] != 0) continue;
      const Real factor = scale(e, i);
      Real change = 0, largest = 0;
      for_terms(e, i, [&](Real now, Real then, Real size) {
        change = std::max(change, std::abs(factor * now - then) * size);
        largest = std::max(largest, std::abs(then) * size);
      });
      if (change <= same * largest) continue;
      marked_[e * m_ + i] = 1;
      unexpected = true;
    }
  return unexpected;
}

int GroupChange::n_marked() const { return static_cast<int>(std::count(marked_.begin(), marked_.end(), 1)); }

void GroupChange::choose() {
  chosen_ = marked_;
  rows_.clear();
  inverse_.clear();
  for (std::size_t k = 0; k < chosen_.size(); ++k) {
    if (chosen_[k] == 0) continue;
    const auto e = static_cast<LocalIndex>(k / m_);
    rows_.push_back({e, static_cast<int>(k % m_)});
    inverse_.resize(inverse_.size() + m_, 0);
    Real* column = &inverse_[inverse_.size() - m_];
    column[k % m_] = 1;
    lu_solve(m_, &lu0_[e * m_ * m_], &pivot0_[e * m_], column);
  }
  const auto counts = base::gather_over_ranks(*problem_.comm(), std::vector<int>{n_here()});
  for (std::size_t r = 0; r < counts.size(); ++r) first_[r + 1] = first_[r] + counts[r];
}

void GroupChange::update() {
  Q_.clear();
  Q_start_.clear();
  for (const auto& [e, i] : rows_) {
    const Real factor = scale(e, i);
    const std::size_t n = n_columns(e), first = m_ * start_[e];
    Q_start_.push_back(Q_.size());
    for (std::size_t c = 0; c < n; ++c)
      Q_.push_back(factor * coupling_[first + i * n + c] - coupling0_[first + i * n + c]);
    for (int j = 0; j < m_; ++j) {
      const std::size_t place = (e * m_ + i) * m_ + j;
      const Real change = factor * dense_(place) - dense0_[place];
      for (std::size_t c = 0; c < n; ++c) Q_[Q_start_.back() + c] -= change * response_(first + j * n + c);
    }
  }
}

std::vector<Real> GroupChange::product(const Real* y) const {
  std::vector<Real> result(rows_.size());
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const LocalIndex* column = &column_[start_[rows_[k].entity]];
    for (std::size_t c = 0; c < n_columns(rows_[k].entity); ++c) result[k] += Q_[Q_start_[k] + c] * y[column[c]];
  }
  return result;
}

void GroupChange::add_product(const std::vector<Real>& G, std::vector<Real>& result) const {
  const std::size_t n = n_chosen();
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const LocalIndex* column = &column_[start_[rows_[k].entity]];
    Real* to = &result[k * n];
    for (std::size_t c = 0; c < n_columns(rows_[k].entity); ++c) {
      const Real factor = Q_[Q_start_[k] + c];
      const Real* from = &G[column[c] * n];
      for (std::size_t j = 0; j < n; ++j) to[j] += factor * from[j];
    }
  }
}

void GroupChange::take_solution(const BlockVector& z) {
  coefficients_.assign(rows_.size(), 0);
  for (std::size_t b = 0; b < group_.blocks.size(); ++b) {
    const int offset = group_.offset[b], n = problem_.blocks()[group_.blocks[b]].n_components;
    const auto value = z[group_.blocks[b]]->getLocalViewHost(Tpetra::Access::ReadOnly);
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      const Real* row = &dense0_[(rows_[k].entity * m_ + rows_[k].component) * m_ + offset];
      for (int j = 0; j < n; ++j) coefficients_[k] += row[j] * value(rows_[k].entity * n + j, 0);
    }
  }
}

void GroupChange::expand(const std::vector<Real>& s, Vector& c) const {
  c.putScalar(0);
  for (std::size_t b = 0; b < group_.blocks.size(); ++b) {
    const auto& A = problem_.matrix()(a_, group_.blocks[b]);
    if (A.is_null()) continue;
    const int offset = group_.offset[b], n = problem_.blocks()[group_.blocks[b]].n_components;
    Vector z(problem_.blocks()[group_.blocks[b]].map);
    {
      const auto to = z.getLocalViewHost(Tpetra::Access::ReadWrite);
      for (std::size_t k = 0; k < rows_.size(); ++k)
        for (int i = 0; i < n; ++i) to(rows_[k].entity * n + i, 0) += inverse_[k * m_ + offset + i] * s[k];
    }
    A->apply(z, c, Teuchos::NO_TRANS, 1, 1);
  }
  const auto flags = base::to_host(problem_.constrained(a_));
  const auto value = c.getLocalViewHost(Tpetra::Access::ReadWrite);
  for (std::size_t i = 0; i < value.extent(0); ++i)
    if (flags(i)) value(i, 0) = 0;
}

}  // namespace sprekk::solve
