#include "assembly/row_sizes.hpp"

#include "assembly/rows.hpp"
#include "base/over_ranks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

namespace sprekk::assembly {

using fields::BlockMatrix;
using fields::BlockVector;

RowSizes::RowSizes(const Structure& structure, const BlockMatrix& linear, const BlockMatrix& matrix)
    : structure_(structure),
      matrix_(matrix),
      weights_(structure.create_vector()),
      diagonals_(structure.create_vector()),
      schur_(structure.n_blocks()) {
  const auto context = structure.context();
  const auto views = rows_of(weights_);
  for (const auto& module : structure.modules) {
    if (module.weights) module.weights->merit_weights(views);
    for (const auto& name : module.declaration.schur)
      if (auto& schur = schur_[context.field(name)]; schur.is_null())
        schur = rcp(new fields::Vector(structure.layouts[context.field(name)].owned()));
  }
  for (int b = 0; b < structure.n_blocks(); ++b) {
    const bool balance = structure.unknowns[b].balance;
    const auto& A = balance ? matrix(b, b) : linear(b, b);
    if (A.is_null()) continue;
    A->getLocalDiagCopy(*diagonals_[b]);
    if (weights_[b]->normInf() > 0) continue;
    if (!balance) {
      weights_[b] = Teuchos::null;
      continue;
    }
    Tpetra::deep_copy(*weights_[b], *diagonals_[b]);
    auto w = weights_[b]->getLocalViewHost(Tpetra::Access::ReadWrite);
    for (std::size_t i = 0; i < w.extent(0); ++i) w(i, 0) = w(i, 0) != 0 ? 1 / std::abs(w(i, 0)) : 0;
  }
}

void RowSizes::begin_step(Real dt) {
  dt_ = dt;
  sized_ = false;
  present_.clear();  // its round-off does not apply to the start of the next attempt
}

void RowSizes::update(const State& state) {
  Rows sums;
  for (const auto& schur : schur_) {
    if (!schur.is_null()) schur->putScalar(0);
    sums.push_back(schur.is_null() ? View<Real*>() : view_of(*schur));
  }
  for (const auto& module : structure_.modules)
    if (module.weights && !module.declaration.schur.empty()) module.weights->add_schur(module.at(state), sums);
  if (present_.empty()) present_ = diagonals_;
  for (int b = 0; b < structure_.n_blocks(); ++b) {  // excludes the linear part without rates
    if (!structure_.unknowns[b].balance) continue;
    if (present_[b] == diagonals_[b]) present_[b] = rcp(new fields::Vector(structure_.blocks[b].map));
    matrix_(b, b)->getLocalDiagCopy(*present_[b]);
    if (!schur_[b].is_null()) present_[b]->update(1, *schur_[b], 1);
    if (!sized_) Tpetra::deep_copy(*diagonals_[b], *present_[b]);
  }
  sized_ = true;
}

void RowSizes::set_augmentation(int block, const std::vector<contact::Constraint>& contact_constraints) {
  const auto constant = diagonals_[block]->getLocalViewHost(Tpetra::Access::OverwriteAll);
  for (std::size_t i = 0; i < constant.extent(0); ++i)
    constant(i, 0) = contact_constraints[i / structure_.blocks[block].n_components].augmentation;
}

RowSizes::Type RowSizes::type(int block) const {
  const auto& unknown = structure_.unknowns[block];
  return unknown.balance ? Type::balance : !unknown.augmented_by.empty() ? Type::augmented : Type::bulk;
}

/// Returns the round-off factor of unknowns with this scale. Factor times diagonal is the round-off of a row.
/// Collective.
Real RowSizes::rounding(const BlockVector& x, const std::string& scale) const {
  Real farthest = 0;
  for (std::size_t b = 0; b < x.size(); ++b)
    if (structure_.unknowns[b].scale == scale) farthest = std::max<Real>(farthest, x[b]->normInf());
  return 64 * std::numeric_limits<Real>::epsilon() * farthest;
}

namespace {

/// Returns the round-off of other blocks' unknowns in the rows of block b: sum over c of |J_bc| times rounding(c). The
/// result is empty if all rounding(c) are zero. Collective.
View<Real*> rounding_by_others(const BlockMatrix& J, int b, LocalIndex n, const std::function<Real(int)>& rounding) {
  View<Real*> sum;
  for (int c = 0; c < J.n_blocks(); ++c) {
    if (c == b || J(b, c).is_null()) continue;
    const Real each = rounding(c);
    if (each == 0) continue;
    if (sum.extent(0) == 0) sum = View<Real*>("rounding", n);
    const auto block = J(b, c)->getLocalMatrixDevice();
    Kokkos::parallel_for(
        "rounding", Kokkos::RangePolicy<Execution>(0, n), KOKKOS_LAMBDA(int i) {
          for (auto k = block.graph.row_map(i); k < block.graph.row_map(i + 1); ++k)
            sum(i) += each * (block.values(k) < 0 ? -block.values(k) : block.values(k));
        });
  }
  return sum;
}

}  // namespace

/// Returns this round-off for unknowns with values far above their changes (balances) or possibly far above their
/// scale. Before the first Jacobian of an attempt, the matrix may belong to a distant state. Then balances count only
/// in the rows of advected balances.
View<Real*> RowSizes::rounding_of_others(int b, const BlockVector& x) const {
  const auto& block = structure_.blocks[b];
  return rounding_by_others(matrix_, b, base::n_local_elements(*block.map), [&](int c) {
    const auto& unknown = structure_.unknowns[c];
    const bool counts = unknown.balance && (block.advected || !present_.empty());
    return counts || unknown.unbounded ? rounding(x, unknown.scale) : 0;
  });
}

namespace {

/// Difference between the largest and the smallest value of the balanced unknowns with the same scale, by the name of
/// the scale. Collective.
Scales ranges_of_balances(const Comm& comm, const std::vector<Unknown>& unknowns, const BlockVector& x) {
  constexpr Real infinity = std::numeric_limits<Real>::infinity();
  std::map<std::string, std::array<Real, 2>> ends;  // largest value and largest negative value
  for (std::size_t b = 0; b < unknowns.size(); ++b) {
    if (!unknowns[b].balance) continue;
    auto& [largest, largest_negative] =
        ends.try_emplace(unknowns[b].scale, std::array{-infinity, -infinity}).first->second;
    const auto values = x[b]->getLocalViewHost(Tpetra::Access::ReadOnly);
    for (std::size_t i = 0; i < values.extent(0); ++i) {
      largest = std::max<Real>(largest, values(i, 0));
      largest_negative = std::max<Real>(largest_negative, -values(i, 0));
    }
  }
  std::vector<Real> here;
  for (const auto& [scale, end] : ends) here.insert(here.end(), end.begin(), end.end());
  const auto all = base::max_over_ranks(comm, here);
  Scales ranges;
  for (auto value = all.begin(); const auto& [scale, end] : ends) {
    ranges[scale] = value[0] + value[1];
    value += 2;
  }
  return ranges;
}

KOKKOS_INLINE_FUNCTION Real magnitude(Real value) { return value < 0 ? -value : value; }

}  // namespace

/// Rows of a block and their round-off, which measures and merit subtract.
struct RowSizes::Row {
  ConstView<char*> prescribed;
  ConstView<Real*> r;
  ConstView<Real*> diagonal;  ///< see RowSizes::diagonals_
  ConstView<Real*> present;   ///< diagonal of the last Jacobian
  View<Real*> others;         ///< round-off of other blocks; empty: zero
  Real rounding;              ///< round-off of the unknown
  Real stored;                ///< round-off of the storage
  Real max_noise;             ///< limit of the round-off

  /// Returns |r| minus the round-off. The row of a prescribed unknown is its deviation, without round-off.
  KOKKOS_INLINE_FUNCTION Real size(int i) const {
    if (prescribed(i)) return magnitude(r(i));
    const Real noise = rounding * magnitude(present(i)) + stored + (others.extent(0) > 0 ? others(i) : 0);
    const Real size = magnitude(r(i)) - (noise > max_noise ? max_noise : noise);
    return size <= 0 ? 0 : size;
  }
};

RowSizes::Row RowSizes::row(int b, const BlockVector& x, const BlockVector& r) const {
  constexpr Real largest = 1e-5;  // a solution that diverges until round-off hides the loads has not converged
  const auto& unknown = structure_.unknowns[b];
  const Type type = this->type(b);
  Row row{.prescribed = structure_.constraints[b].mask(),
          .r = const_view_of(*r[b]),
          .diagonal = const_view_of(*diagonals_[b]),
          .present = const_view_of(*present()[b]),
          .others = rounding_of_others(b, x),
          .rounding = rounding(x, type == Type::augmented ? unknown.augmented_by : unknown.scale),
          .stored = 0,
          .max_noise = type == Type::bulk ? largest * structure_.blocks[b].residual_scale
                                          : std::numeric_limits<Real>::infinity()};
  for (const auto& term : unknown.row)
    if (term.per_step && dt_ > 0) row.stored += term.factor * rounding(x, term.scale) / dt_;
  return row;
}

namespace {

/// Relative residual of a row. Diagonals may be negative, as in symmetric saddle-point systems.
template <class Row>
struct RowMeasure {
  Row row;
  Real unknown_scale, row_scale;
  Real driving;  ///< balances: typical difference of the unknown
  bool balance, advected;

  KOKKOS_INLINE_FUNCTION Real scale(int i) const {
    if (row.prescribed(i)) return unknown_scale;
    if (!balance) return row_scale;
    const Real weight = advected && row.present(i) > row.diagonal(i) ? row.present(i) : row.diagonal(i);
    return weight * driving < row_scale ? weight * driving : row_scale;
  }
  KOKKOS_INLINE_FUNCTION Real value(int i) const {
    const Real size = row.size(i);
    return size == 0 ? 0 : size / scale(i);
  }
};

}  // namespace

std::vector<fields::Measure> RowSizes::measures(const BlockVector& x, const BlockVector& r) const {
  constexpr Real infinity = std::numeric_limits<Real>::infinity();
  constexpr Real min_range = 1e-4;  // relative to the level of a balanced quantity
  const auto ranges = ranges_of_balances(structure_.comm(), structure_.unknowns, x);
  std::vector<fields::Measure> measures;
  for (int b = 0; b < structure_.n_blocks(); ++b) {
    const auto& unknown = structure_.unknowns[b];
    const auto& block = structure_.blocks[b];
    RowMeasure<Row> measure{.row = row(b, x, r),
                            .unknown_scale = block.kinematic_scale,
                            .row_scale = block.residual_scale,
                            .driving = 0,
                            .balance = unknown.balance,
                            .advected = block.advected};
    if (unknown.balance)  // differences of the unknown drive its fluxes: errors are relative to these
      measure.driving =
          std::min(block.kinematic_scale, std::max(ranges.at(unknown.scale), min_range * block.kinematic_scale));
    Real largest = 0;
    Kokkos::parallel_reduce(
        "largest", Kokkos::RangePolicy<Execution>(0, measure.row.r.extent(0)),
        KOKKOS_LAMBDA(int i, Real& maximum) {
          const Real value = measure.value(i);
          if (!(value <= maximum)) maximum = value == value ? value : infinity;  // also if the value is NaN
        },
        Kokkos::Max<Real>(largest));
    measures.push_back({block.name, largest});
  }
  return measures;
}

namespace {

/// Summand of the merit: w (|r| - noise)^2. The weight w is given, or 1/diagonal.
template <class Row>
struct RowMerit {
  Row row;
  ConstView<Real*> weight;  ///< empty: 1/diagonal

  KOKKOS_INLINE_FUNCTION Real value(int i) const {
    const Real size = row.size(i);
    if (row.prescribed(i) || size == 0) return 0;
    if (weight.extent(0) > 0) return weight(i) * size * size;
    const Real w = magnitude(row.diagonal(i));
    return w > 0 ? 1 / w * size * size : 0;
  }
};

}  // namespace

Real RowSizes::merit(const BlockVector& x, const BlockVector& r) const {
  // Weight of rows of transported quantities. These rows grow by orders of magnitude with the flow and are linear for a
  // given flow. Their growth must not reject a step that corrects the flow. With mechanics, the weight is the largest
  // share of the transported energy that becomes mechanical work.
  const Real share_at_work = structure_.coupled ? 1e-6 : 1e-9;
  Real sum = 0;
  for (int b = 0; b < structure_.n_blocks(); ++b) {
    const auto& unknown = structure_.unknowns[b];
    const auto& block = structure_.blocks[b];
    const bool powers = unknown.balance && structure_.coupled, weighted = !powers && !weights_[b].is_null();
    const RowMerit<Row> merit{row(b, x, r), weighted ? const_view_of(*weights_[b]) : ConstView<Real*>()};
    Real part = 0;
    Kokkos::parallel_reduce(
        "merit", Kokkos::RangePolicy<Execution>(0, merit.row.r.extent(0)),
        KOKKOS_LAMBDA(int i, Real& s) { s += merit.value(i); }, part);
    const Real share = block.advected ? share_at_work : 1;
    const Real unit = block.advected ? block.kinematic_scale : 1;  // makes these rows powers
    sum += share * (powers ? dt_ * part / unit : part);            // energy: power times time
  }
  return base::sum_over_ranks(structure_.comm(), sum);
}

}  // namespace sprekk::assembly
