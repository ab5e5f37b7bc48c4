#include "assembly/system.hpp"

#include "assembly/rows.hpp"
#include "base/check.hpp"
#include "base/over_ranks.hpp"
#include "contact/rigid_motion.hpp"
#include "mesh/extents.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sprekk::assembly {

using fields::BlockMatrix;
using fields::BlockVector;
using fields::Evaluation;
using fields::Measure;

namespace {

/// Returns the blocks of contact. Bodies that modules support in an unknown way have no motion there.
contact::Blocks contact_blocks(const Structure& structure) {
  const bool constrained = std::any_of(structure.modules.begin(), structure.modules.end(), [](const auto& m) {
    return m.constrains_bodies() && !m.supporting->supports();
  });
  contact::Blocks found;
  for (int b = 0; b < structure.n_blocks(); ++b) {
    const auto& unknown = structure.unknowns[b];
    if (!unknown.augmented_by.empty()) found.multiplier = b;
    if (!constrained && unknown.near_null_space == NearNullSpace::rigid_motions) found.motion = b;
  }
  return found;
}

}  // namespace

System::System(RCP<const mesh::Mesh> mesh, std::vector<std::unique_ptr<Module>> modules,
               const std::vector<DirichletCondition>& conditions, RCP<base::Timers> timers, Rates::Scheme scheme)
    : structure_(mesh, std::move(modules), conditions, timers),
      scaling_(structure_),
      rate_history_(structure_, scheme),
      jacobian_(structure_),
      ghosts_(structure_),
      load_(structure_.create_vector()),
      extent_(mesh::largest_extent(*mesh)),
      contact_blocks_(contact_blocks(structure_)) {
  const auto scope = timers->scope("set-up");
  const auto origin = state(ghosts_.zero());
  jacobian_.assemble_linear(origin);
  structure_.stencils->forget_writers();
  jacobian_.assemble_balances(origin);
  row_sizes_ = std::make_unique<RowSizes>(structure_, jacobian_.linear(), jacobian_.matrix());
  watch_contact();
}

/// Returns the owned unknowns of motion that conditions and modules support.
std::vector<contact::Support> System::supports_of(int block) const {
  auto all = structure_.constraints[block].supports();
  const auto n_owned = static_cast<LocalIndex>(base::n_local_elements(*structure_.layouts[block].owned()));
  for (const auto& module : structure_.modules) {
    if (!module.supporting) continue;
    for (const auto& support : module.supporting->supports().value_or(std::vector<contact::Support>()))
      if (support.unknown < n_owned) all.push_back(support);
  }
  return all;
}

void System::watch_contact() {
  const auto mesh = structure_.mesh;
  const int motion = contact_blocks_.motion;
  std::unique_ptr<contact::FloatingPieces> pieces;
  if (motion >= 0)
    pieces = std::make_unique<contact::FloatingPieces>(mesh, structure_.layouts[motion], supports_of(motion),
                                                       cell_volumes(*mesh));
  const bool floating = pieces && pieces->possible();
  if (!floating && contact_blocks_.multiplier < 0) return;
  if (floating) pieces->set_stiffness(row_sizes_->diagonal(motion));
  contact_ = std::make_unique<contact::Contact>(static_cast<contact::Equations&>(*this), mesh, contact_blocks_,
                                                std::move(pieces));
  contact_->remember(initial());
  if (floating && contact_->pieces()->contrast() > 10 && linear_part_is_invariant())
    contact_->remove_rigid_motions(structure_.layouts[motion]);
}

/// Returns whether the linear part is zero for rigid motions of pieces. Collective.
bool System::linear_part_is_invariant() const {
  fields::Vector motion(structure_.layouts[contact_blocks_.motion].ghosted());
  for (int b = 0; b < structure_.n_blocks(); ++b) {
    const auto& A = jacobian_.linear()(b, contact_blocks_.motion);
    if (A.is_null()) continue;
    fields::Vector rows(structure_.blocks[b].map);
    for (int mode : contact::rigid_modes(structure_.mesh->dim())) {
      contact_->pieces()->set_rigid(mode, motion);
      A->localApply(motion, rows, Teuchos::NO_TRANS, 1.0, 0.0);
      if (!(rows.normInf() <= 1e-12 * A->getFrobeniusNorm())) return false;
    }
  }
  return true;
}

fields::Globalisation& System::globalisation() { return contact_ ? *contact_ : BlockProblem::globalisation(); }

BlockVector System::initial() const {
  auto x = structure_.create_vector();
  const auto views = rows_of(x);
  for (const auto& module : structure_.modules)
    if (module.initial_values) module.initial_values->initial(views);
  return x;
}

/// Returns the present state at x, without histories. It shares the values of x.
State System::state(const BlockVector& with_ghosts) const {
  State state{.t = rate_history_.t(),
              .rate = rate_history_.rates().now,
              .before = rate_history_.rates().before,
              .dt = rate_history_.dt(),
              .contact = contact_ ? contact_->regularisation() : contact::Regularisation(),
              .coefficients = flux_lag_.coefficients(),
              .x = {},
              .history = {}};
  for (const auto& v : with_ghosts)
    state.x.push_back(Kokkos::subview(v->getLocalViewDevice(Tpetra::Access::ReadOnly), Kokkos::ALL, 0));
  return state;
}

const BlockVector& System::with_ghosts(const Evaluation& x, Ghosts::Which which) {
  return x.with_ghosts([&](const BlockVector& owned) { return ghosts_.exchange(owned, which); });
}

State System::at(const Evaluation& x, Ghosts::Which which) { return state(with_ghosts(x, which)); }

void System::set_time(Real t, Real dt) {
  const auto scope = structure_.timers->scope("loads");
  if (contact_) contact_->begin_step();
  rate_history_.begin(t, dt);
  row_sizes_->begin_step(dt);
  scaling_.update(structure_, t, dt);
  bool changes = !loaded_;
  base::collectively(*comm(), [&] {
    for (const auto& module : structure_.modules) {
      if (!module.loads) continue;
      module.loads->set_time(t, scaling_.values());
      changes = changes || (module.declaration.linear && !module.loads->constant_load());
    }
  });
  const auto now = state(ghosts_.zero());
  base::collectively(*comm(), [&] {
    for (const auto& module : structure_.modules)
      if (module.steps) module.steps->start_step(module.at(now));
  });
  if (!changes) return;
  for (const auto& block : load_) block->putScalar(0);
  const auto views = rows_of(load_);
  for (const auto& module : structure_.modules)
    if (module.declaration.linear) module->residual(module.at(now), views);
  loaded_ = true;
}

/// Computes the residual without constraints, with the rates of a state at x.
void System::residual_at(const Evaluation& x, const State& state, BlockVector& r) {
  const auto scope = structure_.timers->scope("residual");
  fields::copy(load_, r);
  const auto& all = with_ghosts(x);
  jacobian_.add_linear(contact_ ? contact_->without_rigid_motions(all) : all, r);
  const auto views = rows_of(r);
  for (const auto& module : structure_.modules) {
    if (module.declaration.linear) continue;
    const auto scope_of_module = structure_.timers->scope(module->name());
    module->residual(module.at(state), views);
  }
  rate_history_.subtract_before(state.before, views);
}

void System::raw_residual(const Evaluation& x, BlockVector& r) { residual_at(x, at(x), r); }

void System::residual(const Evaluation& x, BlockVector& r) {
  raw_residual(x, r);
  for (std::size_t b = 0; b < r.size(); ++b) {
    if (structure_.constraints[b].conditions().empty()) continue;
    const auto mask = structure_.constraints[b].mask();
    const auto value = structure_.constraints[b].values();
    const auto unknown = const_view_of(*x.x()[b]);
    const auto row = view_of(*r[b]);
    Kokkos::parallel_for(
        "constraints", Kokkos::RangePolicy<Execution>(0, row.extent(0)), KOKKOS_LAMBDA(int i) {
          if (mask(i)) row(i) = unknown(i) - value(i);
        });
  }
}

void System::jacobian(const Evaluation& x) {
  const auto there = at(x);
  jacobian_.assemble(there);
  row_sizes_->update(there);
  if (contact_ && contact_->pieces()) contact_->find_floating(contact_constraints_at(there));
}

void System::commit(const Evaluation& x) {
  const auto there = at(x);
  if (contact_ && contact_->pieces()) {
    // before the histories change: afterwards, sliding faces are at the limit of sticking
    contact_->find_floating(contact_constraints_at(there));
    contact_->remember(x.x());
  }
  BlockVector end;
  if (structure_.has_rates()) residual_at(x, there, end = structure_.create_vector());
  rate_history_.commit(end, there);
  if (accuracy_) accuracy_->commit(x.x(), rate_history_.dt(), there);
  if (energy_) energy_->commit(x.x(), rate_history_.dt(), there);
  for (const auto& module : structure_.modules) {
    if (!module.steps) continue;
    auto s = module.at(there);
    module.steps->commit(s);
  }
}

std::vector<Measure> System::measures(const Evaluation& x, const BlockVector& r) {
  const auto there = at(x);
  if (contact_blocks_.multiplier >= 0)
    row_sizes_->set_augmentation(contact_blocks_.multiplier, contact_constraints_at(there));
  auto measures = row_sizes_->measures(x.x(), r);
  for (const auto& module : structure_.modules) {
    if (!module.errors) continue;
    const auto scope_of_module = structure_.timers->scope(module->name());
    module.errors->measure(module.at(there), scales(), measures);
  }
  std::vector<Real> here;
  for (const auto& measure : measures)  // the maximum must not hide NaN
    here.push_back(std::isnan(measure.value) ? std::numeric_limits<Real>::infinity() : measure.value);
  const auto all = base::max_over_ranks(*comm(), here);
  for (std::size_t k = 0; k < measures.size(); ++k) measures[k].value = all[k];
  return measures;
}

Real System::merit(const Evaluation& x, const BlockVector& r) { return row_sizes_->merit(x.x(), r); }

Real System::lag(Lag how, const Evaluation& x) {
  if (how != Lag::none) return flux_lag_.update(how, structure_, at(x));
  flux_lag_.stop();
  return 0;
}

std::vector<contact::Constraint> System::contact_constraints_at(const State& state) const {
  std::vector<contact::Constraint> contact_constraints(structure_.mesh->n_owned_fracture_faces);
  for (const auto& module : structure_.modules)
    if (module.contact) module.contact->add_contact_constraints(module.at(state), contact_constraints);
  return contact_constraints;
}

std::vector<contact::Constraint> System::contact_constraints(const Evaluation& x) {
  return contact_constraints_at(at(x));
}

contact::Sizes System::sizes() const {
  const auto& [motion, multiplier] = contact_blocks_;
  contact::Sizes sizes{.extent = extent_};
  if (motion >= 0) {
    sizes.motion = blocks()[motion].kinematic_scale;
    sizes.force = blocks()[motion].residual_scale;
  }
  if (multiplier >= 0) {
    sizes.multiplier = blocks()[multiplier].kinematic_scale;
    sizes.gap = scaling_.of(structure_.unknowns[multiplier].augmented_by);
  }
  return sizes;
}

std::vector<char> System::states(const Evaluation& x) {
  const auto there = at(x);
  std::vector<char> states(structure_.mesh->n_owned_fracture_faces);
  for (const auto& module : structure_.modules) {
    if (!module.contact) continue;
    const auto scope_of_module = structure_.timers->scope(module->name());
    module.contact->states(module.at(there), states);
  }
  return states;
}

std::vector<std::pair<fields::Field, View<Real**>>> System::histories(bool rates) const {
  std::vector<std::pair<fields::Field, View<Real**>>> all;
  for (const auto& module : structure_.modules)
    for (std::size_t h = 0; h < module.history.size(); ++h)
      all.emplace_back(module.history_field(module.declaration.history[h]), module.history[h]);
  for (auto& gain : rate_history_.histories()) all.push_back(std::move(gain));
  if (accuracy_ && rates)
    for (auto& rate : accuracy_->histories()) all.push_back(std::move(rate));
  return all;
}

std::vector<std::pair<fields::Field, View<Real**>>> System::passed_on(const BlockVector& x) {
  const auto there = at(x);
  std::vector<std::pair<fields::Field, View<Real**>>> all;
  for (const auto& module : structure_.modules) {
    std::vector<std::pair<History, View<Real**>>> histories;
    if (module.transfer) module.transfer->pass_on(module.at(there), histories);
    for (const auto& [history, values] : histories) all.emplace_back(module.history_field(history), values);
  }
  return all;
}

void System::convert(const BlockVector& x, void (Transfer::*how)(State&) const) {
  const auto there = at(x);
  for (const auto& module : structure_.modules) {
    if (!module.transfer) continue;
    auto s = module.at(there);
    (module.transfer->*how)(s);
  }
}

void System::pass_unbalanced(const Evaluation& x) {
  auto r = structure_.create_vector();
  residual(x, r);
  const auto views = rows_of(r);
  structure_.zero_prescribed(views);
  const auto there = at(x);
  for (const auto& module : structure_.modules) {
    if (!module.transfer) continue;
    auto s = module.at(there);
    module.transfer->take_unbalanced(s, views);
  }
}

void System::prescribe(Real t, BlockVector& x) {
  for (auto& constraints : structure_.constraints) base::collectively(*comm(), [&] { constraints.evaluate(t); });
  structure_.prescribe(rows_of(x));
}

void System::resume(const BlockVector& x, const Memory& memory) {
  scaling_.restore(memory.scales);
  rate_history_.resume(memory.t, memory.dt);
  set_time(memory.t, memory.dt);
  scaling_.restore(memory.scales);  // excludes loads of a rejected step
  if (contact_) contact_->resume(x, memory.calibration);
  if (accuracy_) accuracy_->resume(x, memory.errors);
  if (energy_) energy_->start(x, memory.energy);
}

System::Memory System::memory() const {
  return {rate_history_.committed_t(),
          rate_history_.committed_dt(),
          scales(),
          contact_ ? contact_->calibration() : std::vector<Real>(),
          accuracy_ ? accuracy_->memory() : std::vector<Real>(),
          energy_ ? energy_->sums() : Energy::Sums()};
}

void System::watch_errors(Real duration) {
  accuracy_ = std::make_unique<StepAccuracy>(structure_, rate_history_.scheme(), initial(), duration);
}

void System::watch_energy() {
  energy_ = std::make_unique<Energy>(structure_, [this](const BlockVector& x, BlockVector& r) { raw_residual(x, r); });
}

/// Returns the loads of modules at time t and state x, [block], followed by the prescribed values, [block].
BlockVector System::loads(const Evaluation& x, Real t, Real dt) {
  set_time(t, dt);
  auto there = at(x);
  there.rate = 0;
  auto all = structure_.create_vector(), prescribed = structure_.create_vector();
  const auto views = rows_of(all);
  for (const auto& module : structure_.modules)
    if (!module.has_constant_load()) module->residual(module.at(there), views);
  structure_.zero_prescribed(views);
  structure_.prescribe(rows_of(prescribed));
  all.insert(all.end(), prescribed.begin(), prescribed.end());
  return all;
}

Real System::bend_of_loads(const Evaluation& x, Real t, Real dt) {
  const auto scales = this->scales();  // the step to t may be rejected
  const Real bend = accuracy_->bend([&](Real s) { return loads(x, s == 1 ? t : t - dt + s * dt, dt); });
  scaling_.restore(scales);
  return bend;
}

std::vector<OutputField> System::outputs(const BlockVector& x) {
  auto there = at(x, Ghosts::Which::all);
  there.dt = 0;  // the histories have been updated
  std::vector<OutputField> outputs;
  for (const auto& module : structure_.modules) {
    const auto s = module.at(there);
    base::collectively(*comm(), [&] {
      for (const auto& [field, values] : module.declaration.outputs) {
        outputs.push_back(field);
        outputs.back().values = values(s);
      }
    });
  }
  return outputs;
}

std::vector<Total> System::totals(const BlockVector& x) {
  auto there = at(x);
  there.dt = 0;
  there.unbalanced = rate_history_.unbalanced();
  std::vector<Total> totals;
  base::collectively(*comm(), [&] {
    for (const auto& module : structure_.modules)
      if (module.totals) module.totals->totals(module.at(there), totals);
  });
  std::vector<Real> here;
  for (const auto& total : totals) here.push_back(total.value);
  const auto all = base::sum_over_ranks(*comm(), here);
  for (std::size_t k = 0; k < all.size(); ++k) totals[k].value = all[k];
  if (energy_)
    for (const auto& [path, sum] : energy_->sums()) totals.push_back({path, sum, mesh().dim() == 2 ? "J/m" : "J"});
  return totals;
}

std::vector<Reaction> System::reactions(const Evaluation& x) {
  auto there = at(x);
  there.rate = there.before = there.dt = 0;  // the histories have been updated: no storage
  auto r = structure_.create_vector();
  residual_at(x, there, r);
  return sums_of_constrained(r);
}

std::vector<Reaction> System::reactions_of_step(const BlockVector& x) {
  const auto& end = rate_history_.at_end();
  return end.empty() ? reactions(x) : sums_of_constrained(end);
}

void System::module_residual(int module, const BlockVector& x, BlockVector& r) {
  const auto& one = modules()[module];
  const auto there = at(x, Ghosts::Which::all);
  for (const auto& v : r) v->putScalar(0);
  one->residual(one.at(there), rows_of(r));
}

/// Computes the Jacobian of one module.
void System::assemble(const BoundModule& module, const State& state, BlockMatrix& J) const {
  for (int i = 0; i < J.n_blocks(); ++i)
    for (int j = 0; j < J.n_blocks(); ++j)
      if (!J(i, j).is_null()) Kokkos::deep_copy(J(i, j)->getLocalMatrixDevice().values, 0.0);
  module->jacobian(module.at(state), J);
}

void System::module_jacobian(int module, const BlockVector& x, BlockMatrix& J) {
  assemble(modules()[module], at(x, Ghosts::Which::all), J);
}

BlockVector System::artificially_stored(const Evaluation& x) {
  auto sum = structure_.create_vector();
  const auto there = at(x, Ghosts::Which::all);
  const auto views = rows_of(sum);
  for (const auto& module : structure_.modules)
    if (module.artificial_storage) module.artificial_storage->artificial(module.at(there), views);
  return sum;
}

/// Computes the derivative of the quantity that the rates multiply.
BlockVector System::stored(const Evaluation& x, const BlockVector& dx) {
  auto sum = artificially_stored(x), product = structure_.create_vector();
  for (const auto& block : sum) block->scale(-1);
  auto J = create_matrix();
  const auto there = at(x, Ghosts::Which::all);
  for (const auto& module : structure_.modules) {
    if (!module.declaration.stores) continue;
    for (const Real rate : {there.rate, Real(0)}) {
      auto s = there;
      s.rate = rate;
      assemble(module, s, J);
      J.apply(dx, product);
      for (std::size_t b = 0; b < sum.size(); ++b) sum[b]->update((rate > 0 ? 1 : -1) / there.rate, *product[b], 1);
    }
  }
  return sum;
}

}  // namespace sprekk::assembly
