// Evaluation of residuals, Jacobians, measures and outputs at a given x.
#include "assembly/rate_errors.hpp"
#include "assembly/system.hpp"
#include "base/check.hpp"
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
using fields::Measure;

namespace {

View<Real*> owned_view(fields::Vector& v) {
  auto local = v.getLocalViewDevice(Tpetra::Access::ReadWrite);
  return View<Real*>(local.data(), local.extent(0));
}

ConstView<Real*> const_view(const fields::Vector& v) {
  const auto local = v.getLocalViewDevice(Tpetra::Access::ReadOnly);
  return ConstView<Real*>(local.data(), local.extent(0));
}

/// Sets gain = (with - without)/rate; [entity, component] from [unknown].
void set_gains(const View<Real**>& gain, const View<Real*>& with, const View<Real*>& without, Real rate) {
  const int width = static_cast<int>(gain.extent(1));
  Kokkos::parallel_for(
      "gains", Kokkos::RangePolicy<Execution>(0, gain.extent(0)), KOKKOS_LAMBDA(int e) {
        for (int k = 0; k < width; ++k) gain(e, k) = (with(e * width + k) - without(e * width + k)) / rate;
      });
}

}  // namespace

Rows System::rows(BlockVector& r) const {
  Rows views;
  for (const auto& v : r) views.push_back(owned_view(*v));
  return views;
}

void System::refresh_ghosts(const BlockVector& x, bool all) {
  const auto scope = timers_->scope("ghost exchange");
  for (std::size_t b = 0; b < x.size(); ++b) {
    if (all || needs_ghosts_[b]) {
      ghosted_[b]->doImport(*x[b], *layouts_[b].import(), Tpetra::REPLACE);
    } else {
      const auto from = const_view(*x[b]);
      const auto to = owned_view(*ghosted_[b]);
      Kokkos::deep_copy(Kokkos::subview(to, Kokkos::make_pair(std::size_t(0), from.extent(0))), from);
    }
  }
}

/// Returns views of the values of the last refresh_ghosts().
State System::state(const BoundModule& module) const {
  State s{.t = t_,
          .rate = rates_.now,
          .before = rates_.before,
          .contact = contact_ ? contact_->regularisation() : contact::Regularisation(),
          .coefficients = coefficients_,
          .x = {},
          .history = module.history};
  for (const auto& v : ghosted_) s.x.push_back(const_view(*v));
  return s;
}

/// Evaluates the loads at time t and increases the scales accordingly, then by their relations. A chain of relations is
/// no longer than the number of scales. Cyclic relations reproduce a scale up to round-off, which must not increase it.
void System::update_scales(Real t) {
  constexpr Real rounding = 1e-14;
  Scales loads = scales_;
  base::collectively(*comm(), [&] {
    for (std::size_t b = 0; b < constraints_.size(); ++b) {
      constraints_[b].evaluate(t);
      Real& largest = loads.at(unknowns_[b].scale);
      largest = std::max(largest, constraints_[b].largest());
    }
    for (const auto& module : modules_) {
      if (!module.loads) continue;
      for (const auto& [name, size] : module.loads->loads(t)) {
        SPREKK_CHECK(loads.count(name), "{}: no module declares the scale \"{}\"", module->name(), name);
        loads.at(name) = std::max(loads.at(name), size);
      }
    }
  });
  for (auto& [name, scale] : scales_) scale = base::max_over_ranks(*comm(), loads.at(name));
  for (std::size_t pass = 0; pass < scales_.size(); ++pass)
    for (const auto& [larger, factor, than] : relations_)
      if (const Real least = factor * scales_.at(than); least > (1 + rounding) * scales_.at(larger))
        scales_.at(larger) = least;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    blocks_[b].kinematic_scale = scales_.at(unknowns_[b].scale);
    Real& size = blocks_[b].residual_scale = 0;
    for (const auto& term : unknowns_[b].row)
      if (!term.per_step || dt_ > 0) size += term.factor * scales_.at(term.scale) / (term.per_step ? dt_ : 1);
  }
}

void System::set_time(Real t, Real dt) {
  const auto scope = timers_->scope("loads");
  t_ = t;
  dt_ = dt;
  if (contact_) contact_->begin_step();
  rates_ = dt > 0 ? Rates::of(scheme_, dt, committed_dt_) : Rates{};  // 0: before the first step
  sized_ = false;
  present_.clear();  // its round-off does not apply to the start of the next attempt
  update_scales(t);
  bool changes = !loaded_;
  base::collectively(*comm(), [&] {
    for (const auto& module : modules_) {
      if (!module.loads) continue;
      module.loads->set_time(t, scales_);
      changes = changes || !module.loads->constant_load();
    }
  });
  base::collectively(*comm(), [&] {
    for (const auto& module : modules_)
      if (module.steps) module.steps->start_step(state(module));
  });
  if (!changes) return;
  for (std::size_t b = 0; b < load_.size(); ++b) {
    load_[b]->putScalar(0);
    ghosted_[b]->putScalar(0);
  }
  const auto views = rows(load_);
  for (const auto& module : modules_)
    if (module.declaration.linear) module->residual(state(module), views);
  loaded_ = true;
}

void System::raw_residual(const BlockVector& x, BlockVector& r) {
  refresh_ghosts(x, false);
  const auto scope = timers_->scope("residual");
  const int n = static_cast<int>(blocks_.size());
  const auto linear_in = contact_ ? contact_->without_rigid_motions(ghosted_) : ghosted_;
  for (int i = 0; i < n; ++i) {
    Tpetra::deep_copy(*r[i], *load_[i]);
    for (int j = 0; j < n; ++j) linear_.add_local_product(i, j, *linear_in[j], *r[i]);
  }
  const auto views = rows(r);
  for (const auto& module : modules_) {
    if (module.declaration.linear) continue;
    const auto scope_of_module = timers_->scope(module->name());
    module->residual(state(module), views);
  }
  for (int b = 0; b < n && rates_.before > 0; ++b) {
    if (gains_[b].extent(0) == 0) continue;
    const auto row = views[b];
    const auto gain = gains_[b];
    const Real before = rates_.before;
    const int width = static_cast<int>(gain.extent(1));
    Kokkos::parallel_for(
        "gains", Kokkos::RangePolicy<Execution>(0, row.extent(0)),
        KOKKOS_LAMBDA(int i) { row(i) -= before * gain(i / width, i % width); });
  }
}

/// Computes the storage increases for the state with ghosts. Call before the histories change.
void System::find_gains() {
  BlockVector gained, rest;
  for (const auto& block : blocks_) {
    gained.push_back(rcp(new fields::Vector(block.map)));
    rest.push_back(rcp(new fields::Vector(block.map)));
  }
  const auto with = rows(gained), without = rows(rest);
  for (const auto& module : modules_) {
    if (!module.declaration.stores) continue;
    auto s = state(module);
    module->residual(s, with);
    s.rate = 0;
    module->residual(s, without);
  }
  const Real rate = rates_.now;
  for (std::size_t b = 0; b < blocks_.size(); ++b) set_gains(gains_[b], with[b], without[b], rate);
}

void System::residual(const BlockVector& x, BlockVector& r) {
  raw_residual(x, r);
  for (std::size_t b = 0; b < r.size(); ++b) {
    if (constraints_[b].conditions().empty()) continue;
    const auto mask = constraints_[b].mask();
    const auto value = constraints_[b].values();
    const auto unknown = const_view(*x[b]);
    const auto row = owned_view(*r[b]);
    Kokkos::parallel_for(
        "constraints", Kokkos::RangePolicy<Execution>(0, row.extent(0)), KOKKOS_LAMBDA(int i) {
          if (mask(i)) row(i) = unknown(i) - value(i);
        });
  }
}

void System::jacobian(const BlockVector& x) {
  refresh_ghosts(x, false);
  const auto scope = timers_->scope("Jacobian");
  bool symmetric = true;
  start_matrix();
  for (const auto& module : modules_) {
    if (module.declaration.linear) continue;
    const auto scope_of_module = timers_->scope(module->name());
    const auto s = state(module);
    module->jacobian(s, matrix_);
    symmetric = module->symmetric(s) && symmetric;
  }
  symmetric_ = base::on_all_ranks(*comm(), symmetric);
  find_schur();
  if (contact_ && contact_->pieces()) contact_->find_loose(present_grips());
}

void System::find_schur() {
  Rows sums;
  for (const auto& schur : schur_) {
    if (!schur.is_null()) schur->putScalar(0);
    sums.push_back(schur.is_null() ? View<Real*>() : owned_view(*schur));
  }
  for (const auto& module : modules_)
    if (module.weights && !module.declaration.schur.empty()) module.weights->add_schur(state(module), sums);
  if (present_.empty()) present_ = diagonals_;
  for (std::size_t b = 0; b < blocks_.size() && changing_; ++b)  // excludes the linear part without rates
    if (unknowns_[b].balance) {
      if (present_[b] == diagonals_[b]) present_[b] = rcp(new fields::Vector(blocks_[b].map));
      matrix_(b, b)->getLocalDiagCopy(*present_[b]);
      if (!schur_[b].is_null()) present_[b]->update(1, *schur_[b], 1);
      if (!sized_) Tpetra::deep_copy(*diagonals_[b], *present_[b]);
    }
  sized_ = true;
}

void System::commit(const BlockVector& x) {
  refresh_ghosts(x, false);
  if (contact_ &&
      contact_->pieces()) {  // before the histories change: afterwards, sliding faces are at the limit of sticking
    contact_->find_loose(present_grips());
    contact_->remember(x);
  }
  if (has_rates()) find_unbalanced(x);
  if (keeps_gains()) find_gains();
  if (rate_errors_) find_errors(x);
  committed_t_ = t_;
  committed_dt_ = dt_;
  for (const auto& module : modules_) {
    if (!module.steps) continue;
    auto s = state(module);
    module.steps->commit(s);
  }
}

/// Computes the residual at the end of the step. Call before histories and storage increases change.
void System::find_unbalanced(const BlockVector& x) {
  if (at_end_.empty()) {
    at_end_ = fields::create_like(x);
    unbalanced_ = fields::create_like(x);
  }
  raw_residual(x, at_end_);
  for (std::size_t b = 0; b < x.size(); ++b) {
    Tpetra::deep_copy(*unbalanced_[b], *at_end_[b]);
    const auto mask = constraints_[b].mask();
    const auto row = owned_view(*unbalanced_[b]);
    Kokkos::parallel_for(
        "prescribed", Kokkos::RangePolicy<Execution>(0, mask.extent(0)), KOKKOS_LAMBDA(int i) {
          if (mask(i)) row(i) = 0;
        });
  }
}

/// Returns the round-off factor of unknowns with this scale. Factor times diagonal is the round-off of a row.
/// Collective.
Real System::rounding(const BlockVector& x, const std::string& scale) const {
  Real farthest = 0;
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    if (unknowns_[b].scale == scale) farthest = std::max<Real>(farthest, x[b]->normInf());
  return 64 * std::numeric_limits<Real>::epsilon() * farthest;
}

/// The residual of a row of the linear part has a round-off of its diagonal times the round-off of the displacements.
/// measures() subtracts it. It is relevant for slivers, which are stiff, and for nearly incompressible rock. Traction
/// rows contain jumps times the augmentation constant. Where soft rock carries stiff rock over a long distance, the
/// round-off of the jumps exceeds the deformation of the stiff rock. The subtraction is limited: a solution that
/// diverges until round-off hides the loads has not converged.
namespace {

/// Returns the round-off of other blocks' unknowns in the rows of block b: sum over c of |J_bc| times rounding(c). The
/// result is empty if all rounding(c) are zero. Collective.
View<Real*> rounding_by_others(const fields::BlockMatrix& J, int b, LocalIndex n,
                               const std::function<Real(int)>& rounding) {
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
View<Real*> System::rounding_of_others(int b, const BlockVector& x) const {
  return rounding_by_others(matrix_, b, base::n_local_elements(*blocks_[b].map), [&](int c) {
    const bool counts = unknowns_[c].balance && (carried_[b] || !present_.empty());
    return counts || unknowns_[c].unbounded ? rounding(x, unknowns_[c].scale) : 0;
  });
}

namespace {

/// Difference between the largest and the smallest value of the balanced unknowns with the same scale, by the name of
/// the scale. Collective.
Scales ranges_of_balances(const Teuchos::Comm<int>& comm, const std::vector<Unknown>& unknowns, const BlockVector& x) {
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

}  // namespace

std::vector<Measure> System::measures(const BlockVector& x, const BlockVector& r) {
  constexpr Real most_noise = 1e-5;   // relative to the loads
  constexpr Real least_range = 1e-4;  // relative to the level of a balanced quantity
  refresh_ghosts(x, false);
  const auto ranges = ranges_of_balances(*comm(), unknowns_, x);
  std::vector<Measure> measures;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const auto& unknown = unknowns_[b];
    const bool traction = static_cast<int>(b) == contact_blocks_.traction;
    if (traction) {
      const auto constant = diagonals_[b]->getLocalViewHost(Tpetra::Access::OverwriteAll);
      const auto faces = present_grips();
      for (std::size_t i = 0; i < constant.extent(0); ++i)
        constant(i, 0) = faces[i / blocks_[b].n_components].augmentation;
    }
    const auto mask = constraints_[b].mask();
    const auto row = const_view(*r[b]);
    const Real free_scale = blocks_[b].residual_scale, held_scale = blocks_[b].kinematic_scale;
    const auto diagonal = const_view(*diagonals_[b]), now = const_view(*(present_.empty() ? diagonals_ : present_)[b]);
    const Real rounding_of_block = rounding(x, unknown.augmented_by.empty() ? unknown.scale : unknown.augmented_by);
    const bool balance = unknown.balance;  // conductances of rows differ
    const bool bounded = !balance && !traction, carried = carried_[b];
    // Differences of the unknown drive its fluxes: errors are relative to these, not to the level.
    const Real driving =
        balance ? std::min(held_scale, std::max(ranges.at(unknown.scale), least_range * held_scale)) : 0;
    Real stored = 0;  // round-off of the storage terms
    for (const auto& term : unknown.row)
      if (term.per_step) stored += term.factor * rounding(x, term.scale) / dt_;
    const auto others = rounding_of_others(static_cast<int>(b), x);
    const Real infinite = std::numeric_limits<Real>::infinity();
    Real largest = 0;
    Kokkos::parallel_reduce(
        "largest", Kokkos::RangePolicy<Execution>(0, row.extent(0)),
        KOKKOS_LAMBDA(int i, Real& maximum) {
          const Real size_of_row = row(i) < 0 ? -row(i) : row(i),
                     weight = carried && now(i) > diagonal(i) ? now(i) : diagonal(i),
                     weak = balance ? weight * driving : free_scale;
          const Real scale = mask(i) ? held_scale : weak < free_scale ? weak : free_scale;
          const Real of_row = rounding_of_block * now(i) + stored + (others.extent(0) > 0 ? others(i) : 0),
                     noise = mask(i)                                  ? 0
                             : bounded && of_row > most_noise * scale ? most_noise * scale
                                                                      : of_row;
          const Real size = size_of_row <= noise ? 0 : (size_of_row - noise) / scale;
          if (!(size <= maximum)) maximum = size == size ? size : infinite;  // also if size is NaN
        },
        Kokkos::Max<Real>(largest));
    measures.push_back({blocks_[b].name, largest});
  }
  for (const auto& module : modules_) {
    if (!module.errors) continue;
    const auto scope_of_module = timers_->scope(module->name());
    module.errors->measure(state(module), scales_, measures);
  }
  std::vector<Real> here;
  for (const auto& measure : measures)  // the maximum must not hide NaN
    here.push_back(std::isnan(measure.value) ? std::numeric_limits<Real>::infinity() : measure.value);
  const auto all = base::max_over_ranks(*comm(), here);
  for (std::size_t k = 0; k < measures.size(); ++k) measures[k].value = all[k];
  return measures;
}

Real System::merit(const BlockVector& x, const BlockVector& r) {
  // Weight of rows of transported quantities. These rows grow by orders of magnitude with the flow and are linear for a
  // given flow. Their growth must not reject a step that corrects the flow. With mechanics, the weight is the largest
  // share of the transported energy that becomes mechanical work.
  const Real share_at_work = coupled_ ? 1e-6 : 1e-9;
  Real sum = 0;
  for (std::size_t b = 0; b < r.size(); ++b) {
    const auto mask = constraints_[b].mask();
    const auto row = const_view(*r[b]);
    const bool weighted = !weights_[b].is_null();
    const auto weight = const_view(weighted ? *weights_[b] : *diagonals_[b]);
    const auto diagonal = const_view(*diagonals_[b]), now = const_view(*(present_.empty() ? diagonals_ : present_)[b]);
    const bool balance = unknowns_[b].balance, powers = balance && coupled_;
    const auto others = rounding_of_others(static_cast<int>(b), x);
    const Real rounding_of_block = balance ? rounding(x, unknowns_[b].scale) : 0;
    Real part = 0;
    Kokkos::parallel_reduce(
        "merit", Kokkos::RangePolicy<Execution>(0, row.extent(0)),
        KOKKOS_LAMBDA(int i, Real& s) {
          const Real size =
              (row(i) < 0 ? -row(i) : row(i)) - rounding_of_block * now(i) - (others.extent(0) > 0 ? others(i) : 0);
          if (mask(i) || size <= 0) return;
          const Real of_diagonal = diagonal(i) < 0 ? -diagonal(i) : diagonal(i);
          const Real w = powers ? 1 / diagonal(i) : weighted ? weight(i) : of_diagonal > 0 ? 1 / of_diagonal : 0;
          s += w * size * size;
        },
        part);
    const Real share = carried_[b] ? share_at_work : 1,
               unit = carried_[b] ? blocks_[b].kinematic_scale : 1;  // makes these rows powers
    sum += share * (powers ? dt_ * part / unit : part);              // energy: power times time
  }
  return base::sum_over_ranks(*comm(), sum);
}

/// Returns the contact constraints at the x of the last refresh_ghosts().
std::vector<contact::Grip> System::present_grips() {
  std::vector<contact::Grip> grips(mesh_->n_owned_fracture_faces);
  for (const auto& module : modules_)
    if (module.contact) module.contact->grip(state(module), grips);
  return grips;
}

std::vector<contact::Grip> System::grips(const BlockVector& x) {
  refresh_ghosts(x, false);
  return present_grips();
}

std::vector<contact::Grip> System::evaluate(const BlockVector& x, BlockVector& r) {
  residual(x, r);
  return present_grips();
}

contact::Sizes System::sizes() const {
  const auto& [displacement, traction] = contact_blocks_;
  contact::Sizes sizes{.extent = extent_};
  if (displacement >= 0) {
    sizes.displacement = blocks_[displacement].kinematic_scale;
    sizes.force = blocks_[displacement].residual_scale;
  }
  if (traction >= 0) {
    sizes.traction = blocks_[traction].kinematic_scale;
    sizes.jump = scales_.at(unknowns_[traction].augmented_by);
  }
  return sizes;
}

std::vector<char> System::states(const BlockVector& x) {
  refresh_ghosts(x, false);
  std::vector<char> states(mesh_->n_owned_fracture_faces);
  for (const auto& module : modules_) {
    if (!module.contact) continue;
    const auto scope_of_module = timers_->scope(module->name());
    module.contact->states(state(module), states);
  }
  return states;
}

std::vector<OutputField> System::outputs(const BlockVector& x) {
  refresh_ghosts(x, true);
  std::vector<OutputField> outputs;
  for (const auto& module : modules_) {
    const auto at = state(module);
    base::collectively(*comm(), [&] {
      for (const auto& [field, values] : module.declaration.outputs) {
        outputs.push_back(field);
        outputs.back().values = values(at);
      }
    });
  }
  return outputs;
}

std::vector<Total> System::totals(const BlockVector& x) {
  refresh_ghosts(x, false);
  std::vector<Total> totals;
  base::collectively(*comm(), [&] {
    for (const auto& module : modules_) {
      if (!module.totals) continue;
      auto s = state(module);
      for (const auto& v : unbalanced_) s.unbalanced.push_back(const_view(*v));
      module.totals->totals(s, totals);
    }
  });
  std::vector<Real> here;
  for (const auto& total : totals) here.push_back(total.value);
  const auto all = base::sum_over_ranks(*comm(), here);
  for (std::size_t k = 0; k < all.size(); ++k) totals[k].value = all[k];
  return totals;
}

std::vector<Reaction> System::reactions(const BlockVector& x) {
  auto r = fields::create_like(x);
  const Rates rates = rates_;
  rates_ = {};  // the histories have been updated: no storage
  raw_residual(x, r);
  rates_ = rates;
  return sums_of_held(r);
}

std::vector<Reaction> System::reactions_of_step(const BlockVector& x) {
  return at_end_.empty() ? reactions(x) : sums_of_held(at_end_);
}

std::vector<Reaction> System::sums_of_held(const BlockVector& r) const {
  std::vector<Reaction> result;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    if (!unknowns_[b].enriches.empty()) continue;  // the enriched field has the whole force: its functions sum to 1
    const auto view = r[b]->getLocalViewHost(Tpetra::Access::ReadOnly);
    const int n_components = blocks_[b].n_components, width = n_components + 3;  // force, then moment
    const auto& conditions = constraints_[b].conditions();
    std::vector<Real> here(conditions.size() * width, 0);
    for (const auto& entry : constraints_[b].entries()) {
      Real* sums = &here[entry.condition * width];
      const int i = entry.component, j = (i + 1) % 3, k = (i + 2) % 3;
      const Real force = view(entry.unknown, 0);
      sums[i] += force;
      sums[n_components + j] += entry.x[k] * force;
      sums[n_components + k] -= entry.x[j] * force;
    }
    const auto all = base::sum_over_ranks(*comm(), here);
    for (std::size_t c = 0; c < conditions.size(); ++c) {
      const auto sums = all.begin() + static_cast<std::ptrdiff_t>(c) * width;
      result.push_back({conditions[c].name, conditions[c].field, {sums, sums + n_components}});
      result.back().called = unknowns_[b].reactions;
      if (conditions[c].boundary < 0) result.back().region = conditions[c].region;
      std::copy_n(sums + n_components, 3, result.back().moment.begin());
    }
  }
  return result;
}

void System::module_residual(int module, const BlockVector& x, BlockVector& r) {
  refresh_ghosts(x, true);
  for (const auto& v : r) v->putScalar(0);
  modules_[module]->residual(state(modules_[module]), rows(r));
}

void System::module_jacobian(int module, const BlockVector& x, BlockMatrix& J) {
  refresh_ghosts(x, true);
  for (int i = 0; i < J.n_blocks(); ++i)
    for (int j = 0; j < J.n_blocks(); ++j)
      if (!J(i, j).is_null()) Kokkos::deep_copy(J(i, j)->getLocalMatrixDevice().values, 0.0);
  modules_[module]->jacobian(state(modules_[module]), J);
}

BlockVector System::artificially_stored(const BlockVector& x) {
  auto sum = fields::create_like(x);
  refresh_ghosts(x, true);
  const auto views = rows(sum);
  for (const auto& module : modules_)
    if (module.artificial_storage) module.artificial_storage->artificial(state(module), views);
  return sum;
}

/// Computes the derivative of the quantity that the rates multiply.
BlockVector System::stored(const BlockVector& x, const BlockVector& dx) {
  auto sum = artificially_stored(x), product = fields::create_like(x);
  for (const auto& block : sum) block->scale(-1);
  auto J = create_matrix();
  const Rates rates = rates_;
  for (std::size_t m = 0; m < modules_.size(); ++m) {
    if (!modules_[m].declaration.stores) continue;
    for (const Real rate : {rates.now, Real(0)}) {
      rates_.now = rate;
      module_jacobian(static_cast<int>(m), x, J);
      J.apply(dx, product);
      for (std::size_t b = 0; b < sum.size(); ++b) sum[b]->update((rate > 0 ? 1 : -1) / rates.now, *product[b], 1);
    }
    rates_ = rates;
  }
  return sum;
}

}  // namespace sprekk::assembly
