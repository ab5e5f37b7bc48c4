#include "solve/local_elimination.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/over_ranks.hpp"
#include "fields/node_kernels.hpp"
#include "solve/condensed_block.hpp"
#include "solve/small_lu.hpp"

namespace sprekk::solve {
namespace {

using Policy = Kokkos::RangePolicy<Execution>;

/// Stores A_aa in J_aa if the problem permits it. Collective.
void share(BlockProblem& problem, int a, CondensedBlock& condensed) {
  start_from_bulk(condensed);
  condensed.saved = problem.share(a, condensed.matrix);
  if (!condensed.saved) return;
  condensed.bulk = Teuchos::null;
  condensed.bulk_column = {};
}

/// Sets the flags of columns from those of the unknowns. Collective.
void take_flags(const Vector& constrained, const CondensedBlock& condensed) {
  Vector columns(condensed.matrix->column_map());
  condensed.matrix->spread(constrained, columns);
  const auto from = read_values(columns);
  const auto to = condensed.constrained;
  Kokkos::parallel_for(
      "flags", Policy(0, to.extent(0)), KOKKOS_LAMBDA(LocalIndex i) { to(i) = from(i) != 0; });
}

View<LocalIndex*> all_rows(const Matrix& matrix) {
  const View<LocalIndex*> rows("all rows", matrix.numbers().n_rows());
  Kokkos::parallel_for(
      "all rows", Policy(0, rows.extent(0)), KOKKOS_LAMBDA(LocalIndex row) { rows(row) = row; });
  return rows;
}

}  // namespace

LocalElimination::LocalElimination(BlockProblem& problem)
    : comm_(problem.comm()), matrix_(&problem.matrix()), plan_(plan_elimination(problem)) {
  for (int r = 0; r < n_remaining(); ++r) {
    constrained_.push_back(rcp(new Vector(problem.blocks()[plan_.remaining[r]].map)));
    share(problem, plan_.remaining[r], block(r, r));
    keep_condensed(block(r, r), plan_.groups, r, n_remaining());  // J has columns that A does not have
  }
  for (auto& condensed : plan_.condensed)
    if (!condensed.matrix.is_null() && !condensed.saved) condensed.rows = all_rows(*condensed.matrix);
}

LocalElimination::Status LocalElimination::update(BlockProblem& problem) {
  const bool newly_constrained = take_constraints(problem), had_proximal = proximal_;
  for (auto& group : plan_.groups)
    for (auto& response : group.response) response.column = {};  // of watch_change()
  proximal_ = false;
  for (int r = 0; r < n_remaining(); ++r) {
    const auto proximal = problem.globalisation().proximal(plan_.remaining[r]);
    for (int s = 0; s < n_remaining() && (newly_constrained || fresh_); ++s)
      if (!block(r, s).matrix.is_null()) block(r, s).constrained_rows = find_constrained(block(r, s), *constrained_[r]);
    proximal_ = proximal_ || !proximal.is_null();
    if (newly_constrained || fresh_ || !proximal.is_null()) keep_constrained(block(r, r), *constrained_[r], proximal);
    for (int s = 0; s < n_remaining(); ++s)
      if (!block(r, s).matrix.is_null()) start_from_bulk(block(r, s));
    if (!proximal.is_null()) add_diagonal(*proximal, block(r, r));
  }
  std::string failure;
  for (auto& group : plan_.groups) set_scales(problem, group);
  for (auto& group : plan_.groups) {
    if (factor(group, failure))
      for (int r = 0; r < n_remaining(); ++r)
        for (int s = 0; s < n_remaining(); ++s) condense(group, r, s);
    for (auto& response : group.response) response.value = {};
  }

  std::uint64_t sum = 0;
  for (int r = 0; r < n_remaining(); ++r)
    for (int s = 0; s < n_remaining(); ++s) {
      if (block(r, s).matrix.is_null()) continue;
      constrain(block(r, s), *constrained_[r], r == s);
      sum = 3 * sum + checksum(block(r, s));
    }
  const bool changed = base::on_any_rank(*comm_, fresh_ || sum != checksum_);
  checksum_ = sum;
  const bool by_groups = !(newly_constrained || fresh_ || proximal_ || had_proximal);
  fresh_ = !failure.empty();
  return {changed, by_groups, failure};
}

/// Updates the flags of unknowns and columns. Returns true if any has changed on any rank. Collective.
bool LocalElimination::take_constraints(const BlockProblem& problem) {
  int changed = 0, anywhere = 0;
  for (int r = 0; r < n_remaining(); ++r) {
    const auto flags = problem.constrained(plan_.remaining[r]);
    const auto flag = write_values(*constrained_[r]);
    Kokkos::parallel_reduce(
        "flags", Policy(0, flags.extent(0)),
        KOKKOS_LAMBDA(LocalIndex i, int& any) {
          const Real before = flag(i);
          flag(i) = flags(i) ? 1 : 0;
          if (flag(i) != before) any = 1;
        },
        Kokkos::Max<int>(anywhere));
    changed = std::max(changed, anywhere);
  }
  anywhere = base::max_over_ranks(*comm_, changed);
  for (int r = 0; r < n_remaining() && anywhere; ++r)
    for (int s = 0; s < n_remaining(); ++s)
      if (const auto& condensed = block(r, s); !condensed.matrix.is_null()) take_flags(*constrained_[s], condensed);
  return anywhere != 0;
}

/// Sets the sizes of a group's unknowns under the present loads, as powers of two relative to the first block. Scaling
/// therefore causes no round-off, and factors remain bitwise equal under proportional loads.
void LocalElimination::set_scales(const BlockProblem& problem, GroupPlan& group) {
  const base::HostTable<Real*> scale(group.column_scale);
  const Real first = problem.blocks()[group.blocks.front()].kinematic_scale;
  for (std::size_t i = 0; i < group.blocks.size(); ++i) {
    const auto& block = problem.blocks()[group.blocks[i]];
    const Real power = std::exp2(std::round(std::log2(block.kinematic_scale / first)));
    for (int c = 0; c < block.n_components; ++c) scale(group.offset[i] + c) = power;
  }
  scale.on_device();
}

/// Packs and factorises A_zz, and computes A_zz^-1 A_zb. If an entity is singular, returns false on all ranks and sets
/// the reason. Collective.
bool LocalElimination::factor(GroupPlan& group, std::string& failure) const {
  const int m = group.size;
  Kokkos::deep_copy(group.dense, 0.0);
  for (const auto& fill : group.fill) fill(group.dense);
  Kokkos::deep_copy(group.lu, group.dense);
  const auto lu = group.lu;
  const auto pivot = group.pivot;
  const auto scale = group.column_scale;
  const LocalIndex n = pivot.extent(0) / m;
  LocalIndex first = n;
  Kokkos::parallel_reduce(
      "factor entities", Policy(0, n),
      KOKKOS_LAMBDA(LocalIndex e, LocalIndex & singular) {
        if (!lu_factor(m, &lu(e * m * m), &pivot(e * m), &scale(0)) && e < singular) singular = e;
      },
      Kokkos::Min<LocalIndex>(first));
  const auto none = std::numeric_limits<GlobalIndex>::max();
  const auto singular = base::min_over_ranks(*comm_, first < n ? group.slots->owned()->getGlobalElement(first) : none);
  if (singular != none) {
    failure = fmt::format("local group '{}': the matrix of entity {} is singular", group.name, singular);
    return false;
  }
  for (auto& response : group.response) {
    const auto start = response.column_start;
    const View<Real*> z("responses", m * start(start.extent(0) - 1) + Response::strip);
    response.value = z;
    for (const auto& fill : response.fill) fill(z);
    if (change_) change_->take_coupling(z);
    fields::in_widest_instructions([&] {
      Kokkos::parallel_for(
          "responses", Policy(0, n), KOKKOS_LAMBDA(LocalIndex e) {
            lu_solve(m, &lu(e * m * m), &pivot(e * m), &z(m * start(e)), start(e + 1) - start(e));
          });
    });
    if (change_) change_->take_response(z);
    group.slots->exchange_rows(start, z, m);
  }
  return true;
}

/// Computes J_rs -= A_rz (A_zz^-1 A_zs), row by row.
void LocalElimination::condense(GroupPlan& group, int r, int s) const {
  if (block(r, s).matrix.is_null()) return;
  const int m = group.size;
  const auto& response = group.response[s];
  const auto value = response.value;
  const auto column_start = response.column_start;
  const auto coupling = group.coupling[r];
  const auto column = group.column[r * n_remaining() + s];
  const auto numbers = block(r, s).matrix->numbers();
  const auto values_of_component = values_of_components(group, r);
  int n_missing = 0;
  fields::in_widest_instructions([&] {
    Kokkos::parallel_reduce(
        "condense", Policy(0, coupling.row_start.extent(0) - 1),
        KOKKOS_LAMBDA(LocalIndex row, int& missing) {
          constexpr int strip = Response::strip;
          Real factor[max_small_size];
          RowCursor cursor(numbers, row);
          for (LocalIndex pair = coupling.row_start(row); pair < coupling.row_start(row + 1); ++pair) {
            for (int i = 0; i < m; ++i) factor[i] = 0;
            for (LocalIndex run = coupling.first(pair); run < coupling.first(pair + 1); ++run) {
              const int component = coupling.component(run);
              for (int i = 0; i < coupling.length(run); ++i)
                factor[component + i] = values_of_component[component][coupling.source(run) + i];
            }
            const auto first = column_start(coupling.slot(pair)), end = column_start(coupling.slot(pair) + 1);
            const auto n_columns = static_cast<LocalIndex>(end - first);
            for (LocalIndex begin = 0; begin < n_columns; begin += strip) {
              fields::Numbers<strip> sum, z;
              for (int i = 0; i < m; ++i) {
                z.load(&value(m * first + i * n_columns + begin));
                sum.add(factor[i], z);
              }
              Real sums[strip];
              sum.store(sums);
              for (int k = 0; k < strip && begin + k < n_columns; ++k)
                numbers.value(cursor.find(column(first + begin + k))) -= sums[k];
            }
          }
          missing += cursor.n_missing;
        },
        n_missing);
  });
  check_found(n_missing);
}

/// Returns the values of A_rz, [component of an entity]; null if absent.
Kokkos::Array<const Real*, max_small_size> LocalElimination::values_of_components(const GroupPlan& group, int r) const {
  Kokkos::Array<const Real*, max_small_size> values = {};
  for (std::size_t i = 0; i < group.blocks.size(); ++i) {
    const int end = i + 1 < group.offset.size() ? group.offset[i + 1] : group.size;
    if (const auto& A = (*matrix_)(plan_.remaining[r], group.blocks[i]); !A.is_null())
      for (int component = group.offset[i]; component < end; ++component)
        values[component] = A->getLocalMatrixDevice().values.data();
  }
  return values;
}

GroupChange* LocalElimination::watch_change(const BlockProblem& problem) {
  if (plan_.groups.size() != 1 || n_remaining() != 1 || !block(0, 0).saved) return nullptr;
  change_ = std::make_unique<GroupChange>(problem, plan_.groups.front(), plan_.remaining.front());
  return change_.get();
}

RCP<const Matrix> LocalElimination::condensed(int r, int s) const { return block(r, s).matrix; }

void LocalElimination::with_bulk(int r, const std::function<void(const RCP<const Matrix>& A)>& work) const {
  const auto& condensed = block(r, r);
  const RowValues of_J(*condensed.matrix, condensed.rows);
  start_from_bulk(condensed);
  constrain(condensed, *constrained_[r], true);
  work(condensed.matrix);
  of_J.put_back();
}

/// Computes z = A_zz^-1 z for the blocks of one group.
void LocalElimination::apply_inverse(const GroupPlan& group, BlockVector& z) const {
  const int m = group.size;
  const auto work = group.work, dense = group.dense, lu = group.lu;
  const auto pivot = group.pivot;
  const auto each = [&](const auto& move) {
    for (std::size_t i = 0; i < group.blocks.size(); ++i) {
      const auto part = write_values(*z[group.blocks[i]]);
      const int offset = group.offset[i];
      const int n = (i + 1 < group.blocks.size() ? group.offset[i + 1] : m) - offset;
      move(part, offset, n);
    }
  };
  each([&](const auto& part, int offset, int n) {
    Kokkos::parallel_for(
        "pack", Policy(0, part.extent(0)), KOKKOS_LAMBDA(LocalIndex i) { work(i / n * m + offset + i % n) = part(i); });
  });
  Kokkos::parallel_for(
      "solve entities", Policy(0, pivot.extent(0) / m), KOKKOS_LAMBDA(LocalIndex e) {
        lu_solve_refined(m, &dense(e * m * m), &lu(e * m * m), &pivot(e * m), &work(e * m));
      });
  each([&](const auto& part, int offset, int n) {
    Kokkos::parallel_for(
        "unpack", Policy(0, part.extent(0)),
        KOKKOS_LAMBDA(LocalIndex i) { part(i) = work(i / n * m + offset + i % n); });
  });
}

BlockVector LocalElimination::reduce(const BlockVector& b) const {
  auto lift = fields::create_like(b), s = fields::create_like(b);
  Real maximum = 0;
  for (int r = 0; r < n_remaining(); ++r) {
    lift[plan_.remaining[r]]->elementWiseMultiply(1, *constrained_[r], *b[plan_.remaining[r]], 0);
    maximum += lift[plan_.remaining[r]]->normInf();
  }
  const bool lifts = maximum != 0;  // false after Newton's first iteration, which satisfies the conditions
  if (lifts) matrix_->apply(lift, s);
  for (std::size_t i = 0; i < b.size(); ++i) s[i]->update(1, *b[i], -1);
  for (const auto& group : plan_.groups) {
    apply_inverse(group, s);
    if (change_) change_->take_solution(s);
    for (int a : plan_.remaining)
      for (int z : group.blocks)
        if (!(*matrix_)(a, z).is_null()) (*matrix_)(a, z)->apply(*s[z], *s[a], Teuchos::NO_TRANS, -1, 1);
  }
  BlockVector c;
  for (int r = 0; r < n_remaining(); ++r) {
    c.push_back(s[plan_.remaining[r]]);
    const auto value = write_values(*c.back());
    const auto flag = read_values(*constrained_[r]);
    Kokkos::parallel_for(
        "constrain", Policy(0, value.extent(0)), KOKKOS_LAMBDA(LocalIndex i) {
          if (flag(i) != 0) value(i) = 0;
        });
  }
  return c;
}

void LocalElimination::expand(const BlockVector& b, const BlockVector& y, BlockVector& dx) const {
  for (int r = 0; r < n_remaining(); ++r) {
    const int a = plan_.remaining[r];
    const auto value = write_values(*dx[a]);
    const auto flag = read_values(*constrained_[r]), prescribed = read_values(*b[a]), solved = read_values(*y[r]);
    Kokkos::parallel_for(
        "expand", Policy(0, value.extent(0)),
        KOKKOS_LAMBDA(LocalIndex i) { value(i) = flag(i) != 0 ? prescribed(i) : solved(i); });
  }
  for (const auto& group : plan_.groups) {
    for (int z : group.blocks) {
      Tpetra::deep_copy(*dx[z], *b[z]);
      for (int a : plan_.remaining)
        if (!(*matrix_)(z, a).is_null()) (*matrix_)(z, a)->apply(*dx[a], *dx[z], Teuchos::NO_TRANS, -1, 1);
    }
    apply_inverse(group, dx);
  }
}

}  // namespace sprekk::solve
