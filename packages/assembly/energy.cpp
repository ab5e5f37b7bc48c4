#include "assembly/energy.hpp"

#include "assembly/rows.hpp"
#include "base/host_table.hpp"
#include "base/over_ranks.hpp"

#include <algorithm>
#include <set>

namespace sprekk::assembly {

using fields::BlockVector;

namespace {

/// Returns the product of two vectors over the owned unknowns of this rank, or over the prescribed ones among them.
Real product(const fields::Vector& a, const fields::Vector& b, const Constraints* prescribed = nullptr) {
  const auto first = base::to_host(const_view_of(a)), second = base::to_host(const_view_of(b));
  Real sum = 0;
  if (prescribed) {
    const auto mask = base::to_host(prescribed->mask());
    for (std::size_t i = 0; i < first.extent(0); ++i) sum += mask(i) ? first(i) * second(i) : 0;
  } else {
    for (std::size_t i = 0; i < first.extent(0); ++i) sum += first(i) * second(i);
  }
  return sum;
}

BlockVector copy_of(const BlockVector& x) {
  auto copy = fields::create_like(x);
  fields::copy(x, copy);
  return copy;
}

/// Replaces a by factor a + other b.
void combine(BlockVector& a, Real factor, const BlockVector& b, Real other) {
  for (std::size_t k = 0; k < a.size(); ++k) a[k]->update(other, *b[k], factor);
}

}  // namespace

Energy::Energy(const Structure& structure, Residual residual) : structure_(structure), residual_(std::move(residual)) {
  const auto& unknowns = structure.unknowns;
  const auto rigid = std::find_if(unknowns.begin(), unknowns.end(), [](const Unknown& one) {
    return one.near_null_space == NearNullSpace::rigid_motions;
  });
  std::set<std::string> moving;
  for (int b = 0; b < structure.n_blocks(); ++b) {
    const auto& one = unknowns[b];
    if (one.balance && one.field.unit == "Pa") balances_.push_back(b);
    if (rigid == unknowns.end() || one.scale != rigid->scale || one.row.empty() ||
        one.row[0].scale != rigid->row[0].scale)
      continue;
    motion_.push_back(b);
    moving.insert(one.field.name);
  }
  if (motion_.empty()) return;
  parts_ = {{{"energy", "elastic"}, motion_}, {{"energy", "released"}, {}}};
  for (int b = 0; b < structure.n_blocks(); ++b) {
    const auto& name = unknowns[b].field.name;
    const auto acts = [&](const Coupling& coupling) {
      return moving.count(coupling.row) > 0 &&
             std::find(coupling.columns.begin(), coupling.columns.end(), name) != coupling.columns.end();
    };
    const bool any = std::any_of(structure.modules.begin(), structure.modules.end(), [&](const auto& module) {
      const auto& couplings = module.declaration.couplings;
      return std::any_of(couplings.begin(), couplings.end(), acts);
    });
    if (any && moving.count(name) == 0) parts_.push_back({{"energy", "work", name}, {b}});
  }
  parts_.push_back({{"energy", "work", "loads"}, {}});
}

/// Computes the forces of all parts at x. A part is twice the difference between all forces at x and those with half of
/// its fields; the loads are the rest. Nothing holds new faces.
void Energy::set_forces(const BlockVector& x) {
  const auto moving = [&](const BlockVector& all) {
    BlockVector some;
    for (const int b : motion_) some.push_back(all[b]);
    return some;
  };
  auto r = structure_.create_vector();
  residual_(x, r);
  total_ = copy_of(moving(r));
  auto rest = copy_of(total_);
  for (auto& part : parts_) {
    if (part.fields.empty()) continue;
    auto changed = x;
    for (const int b : part.fields) {
      changed[b] = rcp(new fields::Vector(*x[b], Teuchos::Copy));
      changed[b]->scale(0.5);
    }
    residual_(changed, r);
    part.force = copy_of(total_);
    combine(part.force, 2, moving(r), -2);
    combine(rest, 1, part.force, -1);
  }
  parts_[1].force = fields::create_like(total_);
  parts_.back().force = rest;
  x_ = copy_of(moving(x));
}

/// Returns this rank's elastic energy.
Real Energy::elastic() const {
  Real sum = 0;
  for (std::size_t k = 0; k < motion_.size(); ++k) sum += product(*x_[k], *parts_[0].force[k]) / 2;
  return sum;
}

void Energy::start(const BlockVector& x, Sums sums) {
  sums_ = std::move(sums);
  if (motion_.empty()) return;
  set_forces(x);
  auto held = copy_of(total_);  // forces that are not balanced, except by supports
  for (std::size_t k = 0; k < motion_.size(); ++k) {
    const auto forces = view_of(*held[k]);
    const auto mask = structure_.constraints[motion_[k]].mask();
    Kokkos::parallel_for(
        "held forces", Kokkos::RangePolicy<Execution>(0, forces.extent(0)), KOKKOS_LAMBDA(int i) {
          if (mask(i)) forces(i) = 0;
        });
  }
  if (sums_.empty()) {
    combine(parts_.back().force, 1, held, -1);
    return;
  }
  auto& before = sums_[parts_[0].path];
  const Real now = base::sum_over_ranks(structure_.comm(), elastic());
  sums_[parts_[1].path] += before - now;
  before = now;
  parts_[1].force = held;
}

Real Energy::work(const BlockVector& old, const BlockVector& now, const BlockVector& dx, bool prescribed_only) const {
  Real sum = 0;
  for (std::size_t k = 0; k < motion_.size(); ++k) {
    const auto* prescribed = prescribed_only ? &structure_.constraints[motion_[k]] : nullptr;
    sum += (product(*old[k], *dx[k], prescribed) + product(*now[k], *dx[k], prescribed)) / 2;
  }
  return sum;
}

void Energy::commit(const BlockVector& x, Real dt, const State& state) {
  Sums here;
  if (!motion_.empty()) {
    if (x_.empty()) {  // no state before the first step: forces grow from zero
      for (const int b : motion_) x_.push_back(rcp(new fields::Vector(x[b]->getMap())));
      total_ = fields::create_like(x_);
      for (auto& part : parts_) part.force = fields::create_like(x_);
    }
    const auto before = x_, total = total_;
    const auto parts = parts_;
    set_forces(x);
    auto dx = copy_of(x_);
    combine(dx, 1, before, -1);
    for (std::size_t k = 1; k < parts_.size(); ++k)
      here[parts_[k].path] = -work(parts[k].force, parts_[k].force, dx, false);
    here[{"energy", "work", "supports"}] = work(total, total_, dx, true);
    here[parts_[0].path] = elastic();
  }
  add_balances(x, dt, state, here);
  std::vector<Real> values;
  for (const auto& [path, value] : here) values.push_back(value);
  values = base::sum_over_ranks(structure_.comm(), values);
  auto value = values.begin();
  Real given = 0;
  for (auto& [path, sum] : here) {
    sum = *value++;
    if (path[1] == "work") given += sum;
  }
  if (motion_.empty()) {
    for (const auto& [path, sum] : here) sums_[path] += sum;
    return;
  }
  const auto &elastic = parts_[0].path, &released = parts_[1].path;
  sums_[{"energy", "unassigned"}] += here[elastic] - sums_[elastic] - given + here[released];
  for (const auto& [path, sum] : here) sums_[path] = path == elastic ? sum : sums_[path] + sum;
}

/// Adds this rank's work of each module with rows of these balances.
void Energy::add_balances(const BlockVector& x, Real dt, const State& state, Sums& sums) const {
  if (balances_.empty() || !(dt > 0)) return;
  std::set<std::string> names;
  for (const int b : balances_) names.insert(structure_.unknowns[b].field.name);
  auto r = structure_.create_vector();
  const auto rows = rows_of(r);
  Real supports = 0;
  for (const auto& module : structure_.modules) {
    const auto& couplings = module.declaration.couplings;
    if (std::none_of(couplings.begin(), couplings.end(), [&](const auto& one) { return names.count(one.row) > 0; }))
      continue;
    for (const auto& block : r) block->putScalar(0);
    module->residual(module.at(state), rows);
    const auto name = module->name();  // may end with a choice, "flow, tpfa"
    auto& sum = sums[{"energy", "balance", name.substr(0, name.find(','))}];
    for (const int b : balances_) {
      sum -= dt * product(*x[b], *r[b]);
      supports += dt * product(*x[b], *r[b], &structure_.constraints[b]);
    }
  }
  sums[{"energy", "balance", "supports"}] = supports;
}

}  // namespace sprekk::assembly
