#include "model/error_estimate.hpp"

#include "assembly/geometry.hpp"
#include "assembly/prescribed_error.hpp"
#include "base/over_ranks.hpp"
#include "mesh/extents.hpp"
#include "model/json_keys.hpp"
#include "physics/comparison.hpp"
#include "physics/mechanics/edge_of_contact.hpp"
#include "physics/mechanics/traction_recovery.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sprekk::model {

using assembly::OutputField;

namespace {

constexpr Real solve_tolerance = 1e-6;  ///< of iterative solvers; sufficient for estimates

const std::vector<Real>& values_of(const std::vector<OutputField>& outputs, const std::string& name) {
  return std::find_if(outputs.begin(), outputs.end(), [&](const auto& o) { return o.name == name; })->values;
}

std::unique_ptr<physics::StressRecovery> make_recovery(const Model& model,
                                                       const physics::ByField<const fields::Layout*>& layouts) {
  if (!layouts[physics::nodal]) return nullptr;
  return physics::make_stress_recovery(Teuchos::rcpFromRef(model.mesh()), layouts,
                                       physics::elasticity(model.scene(), model.mesh()));
}

/// Returns part / whole, with a small result if the whole is only round-off of quantities of the given scale.
Real ratio_of(Real part, Real whole, Real scale) { return part == 0 ? 0 : part / std::max(whole, 1e-10 * scale); }

}  // namespace

nlohmann::json ErrorEstimate::summary() const {
  nlohmann::json result = nlohmann::json::object();
  for (const auto& flux : fluxes)
    result[with_underscores(flux.name)] = {{"relative", flux.whole > 0 ? flux.error / flux.whole : 0},
                                           {"energy_norm", flux.error}};
  if (energy.empty()) return result;
  result["stress"] = {{"relative", relative_stress}, {"energy_norm", stress}};
  if (!failure.empty())
    result["jump"] = {{"failure", failure}};
  else if (fields.back().name == "jump error")
    result["jump"] = {{"relative", relative_jump}, {"norm", jump}};
  return result;
}

ErrorEstimator::ErrorEstimator(Model& model)
    : model_(model),
      blocks_{block("displacement"), block("side bubble"), block("tip displacement")},
      recovery_(make_recovery(model, layouts())),
      rates_(model.setting().start) {
  section_ = std::pow(mesh::largest_extent(model.mesh()), model.mesh().dim() - 1);
  physics::for_each_physics([&](auto physics) {
    if (auto error = physics.mesh_error(model.setting(), model.system())) flux_errors_.push_back(std::move(error));
  });
}

int ErrorEstimator::block(const std::string& name) const {
  const auto& blocks = model_.system().blocks();
  const auto found = std::find_if(blocks.begin(), blocks.end(), [&](const auto& b) { return b.name == name; });
  return found == blocks.end() ? -1 : static_cast<int>(found - blocks.begin());
}

physics::ByField<const fields::Layout*> ErrorEstimator::layouts() const {
  physics::ByField<const fields::Layout*> result{};
  for (std::size_t k = 0; k < result.size(); ++k)
    if (blocks_[k] >= 0) result[k] = &model_.system().layouts()[blocks_[k]];
  return result;
}

ErrorEstimate ErrorEstimator::operator()(const std::vector<OutputField>& outputs) {
  const auto scope = model_.timers().scope("error estimate");
  ErrorEstimate estimate;
  for (const auto& error : flux_errors_) {
    estimate.fluxes.push_back(flux_error(*error));
    auto density = estimate.fluxes.back().energy;
    for (std::size_t c = 0; c < density.size(); ++c)
      density[c] /= assembly::cell_mean(model_.mesh(), static_cast<LocalIndex>(c), [](const auto&) { return 1; })[0];
    estimate.fields.push_back({.name = error->name() + " error density",
                               .unit = error->unit() + "/m^3",
                               .entity = fields::Entity::cell,
                               .n_components = 1,
                               .values = std::move(density)});
  }
  const bool any_goals = model_.scene().accuracy.has_value();
  auto right_side = fields::create_like(model_.state());
  if (!recovery_) {
    if (any_goals) estimate_answer(std::move(right_side), outputs, estimate);
    return estimate;
  }
  auto error = (*recovery_)(displacement(model_.state()));
  const auto& scales = model_.system().scales();
  const Real energy = scales.at("stress") * scales.at("displacement");
  estimate.stress = error.error;
  estimate.stress_norm = error.stress;
  estimate.energy = error.energy;
  estimate.relative_stress = ratio_of(error.error, error.stress, std::sqrt(section_ * energy));
  estimate.fields.push_back({.name = "error density",
                             .unit = "J/m^3",
                             .entity = fields::Entity::cell,
                             .n_components = 1,
                             .values = std::move(error.density)});
  const bool any_balance = any_goals && !flux_errors_.empty();
  if (!wants_reactions_ && model_.mesh().fracture_names.empty() && !any_balance) return estimate;
  add_stress(error, right_side);
  estimate_answer(std::move(right_side), outputs, estimate);
  return estimate;
}

std::vector<Real> ErrorEstimator::by_cell(const estimate::MeshError& error, const std::vector<Real>& squares) const {
  std::vector<Real> result(model_.mesh().n_owned_cells, 0);
  for (std::size_t k = 0; k < squares.size(); ++k) result[error.cells()[k]] += squares[k];
  return result;
}

ErrorEstimate::Flux ErrorEstimator::flux_error(estimate::MeshError& error) const {
  ErrorEstimate::Flux flux{.name = error.name()};
  auto parts = error.of_state(model_.state(), model_.time());
  std::vector<Real> squares;
  std::array<Real, 2> sums{};
  for (std::size_t k = 0; k < error.n_of_energy(); ++k) {
    squares.push_back(parts.error[k] * parts.error[k]);
    sums[0] += squares[k];
    sums[1] += parts.whole[k] * parts.whole[k];
  }
  sums = base::sum_over_ranks(*model_.mesh().comm, sums);
  flux.parts = std::move(parts.error);
  flux.energy = by_cell(error, squares);
  flux.error = std::sqrt(sums[0]);
  flux.whole = std::sqrt(sums[1]);
  return flux;
}

std::optional<ErrorEstimator::OfFunctional> ErrorEstimator::of_functional(const estimate::Functional& J,
                                                                          const ErrorEstimate& estimate) {
  for (const auto& error : flux_errors_) {
    if (!error->knows(J.what)) continue;
    auto reactions = model_.system().reactions(model_.state());
    const Real now = error->value(J, model_.state(), reactions);
    if (estimate.lacks.empty()) return OfFunctional{now, std::numeric_limits<Real>::infinity()};
    for (std::size_t k = 0; k < reactions.size(); ++k)
      for (std::size_t i = 0; i < reactions[k].force.size(); ++i)
        reactions[k].force[i] += estimate.reactions[k].force[i];
    auto x = fields::create_like(model_.state());
    fields::copy(model_.state(), x);
    for (std::size_t b = 0; b < x.size(); ++b) x[b]->update(1, *estimate.lacks[b], 1);
    return OfFunctional{now, error->value(J, x, reactions) - now};
  }
  return std::nullopt;
}

std::vector<Real> ErrorEstimator::shares(const estimate::Functional& J,
                                         const std::vector<std::vector<ErrorEstimate::Flux>>& steps) {
  const auto scope = model_.timers().scope("error estimate");
  if (!has_shares()) return {};
  auto& error = *flux_errors_[0];
  auto right_side = fields::create_like(model_.state()), z = fields::create_like(model_.state());
  error.add_derivative(J, model_.state(), right_side);
  std::vector<Real> result(model_.mesh().n_owned_cells, 0);
  for (auto step = steps.rbegin(); step != steps.rend(); ++step) {
    if (!model_.newton().answer(model_.state(), right_side, z, solve_tolerance).converged) return {};
    const auto parts = error.of_answer(model_.state(), z).error;
    const auto& of_step = step->front();
    std::vector<Real> squares;
    for (std::size_t k = 0; k < parts.size(); ++k)
      if (k < error.n_of_energy())
        squares.push_back(parts[k] * parts[k]);
      else
        result[error.cells()[k]] += std::abs(of_step.parts[k] * parts[k]);
    const auto weight = by_cell(error, squares);
    for (std::size_t c = 0; c < weight.size(); ++c) result[c] += std::sqrt(weight[c] * of_step.energy[c]);
    if (step + 1 == steps.rend()) break;
    right_side = model_.system().stored(model_.state(), z);
    for (auto& block : right_side) block->scale(model_.system().rates().now);
    hold(right_side);
  }
  return result;
}

void ErrorEstimator::hold(fields::BlockVector& right_side) const {
  for (std::size_t b = 0; b < right_side.size(); ++b) {
    const auto constrained =
        Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), model_.system().constrained(static_cast<int>(b)));
    const auto view = right_side[b]->getLocalViewHost(Tpetra::Access::ReadWrite);
    for (std::size_t i = 0; i < constrained.extent(0); ++i)
      if (constrained(i)) view(i, 0) = 0;
  }
}

void ErrorEstimator::prescribe(fields::BlockVector& right_side) const {
  hold(right_side);
  for (const auto& error : flux_errors_) error->add_prescribed(model_.time(), right_side);
  const int nodes = blocks_[physics::nodal];
  if (nodes < 0) return;
  const auto& mesh = model_.mesh();
  const auto conditions =
      physics::dirichlet_conditions(model_.scene().boundary_conditions, {}, physics::names_of(mesh), "displacement");
  const auto missed = assembly::prescribed_error(mesh, model_.system().layouts()[nodes], conditions, model_.time());
  const auto constrained = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), model_.system().constrained(nodes));
  const auto from = missed.getLocalViewHost(Tpetra::Access::ReadOnly);
  const auto to = right_side[nodes]->getLocalViewHost(Tpetra::Access::ReadWrite);
  for (std::size_t i = 0; i < constrained.extent(0); ++i)
    if (constrained(i)) to(i, 0) = from(i, 0);
}

std::vector<Real> ErrorEstimator::answer_energy(const std::vector<Real>& d) {
  const auto scope = model_.timers().scope("error estimate");
  auto& system = model_.system();
  const auto& traction = system.layouts()[block("traction")];
  fields::Vector direction(traction.owned());
  {
    const auto view = direction.getLocalViewHost(Tpetra::Access::OverwriteAll);
    for (std::size_t i = 0; i < d.size(); ++i) view(i, 0) = d[i];
  }
  auto right_side = fields::create_like(model_.state()), x = fields::create_like(model_.state());
  physics::ByField<RCP<fields::Vector>> forces;
  for (std::size_t k = 0; k < blocks_.size(); ++k)
    if (blocks_[k] >= 0) forces[k] = right_side[blocks_[k]];
  physics::add_opposite_tractions(model_.mesh(), layouts(), traction, direction, forces);
  hold(right_side);
  if (!model_.newton().answer(model_.state(), right_side, x, solve_tolerance).converged) return {};
  return (*recovery_)(displacement(x)).energy;
}

physics::ByField<RCP<const fields::Vector>> ErrorEstimator::displacement(const fields::BlockVector& x) const {
  physics::ByField<RCP<const fields::Vector>> fields;
  for (std::size_t k = 0; k < blocks_.size(); ++k)
    if (blocks_[k] >= 0) fields[k] = x[blocks_[k]];
  return fields;
}

/// Adds the residual forces of the stress error to a right side.
void ErrorEstimator::add_stress(const physics::StressError& stress, fields::BlockVector& right_side) {
  auto& system = model_.system();
  for (std::size_t k = 0; k < blocks_.size(); ++k)
    if (blocks_[k] >= 0) right_side[blocks_[k]] = stress.forces[k];
  if (const int lambda = block("traction"); lambda >= 0)
    physics::add_unresolved_traction(model_.mesh(), layouts(), system.layouts()[lambda],
                                     physics::initial_stress(model_.scene(), model_.mesh()), *model_.state()[lambda],
                                     stress.forces);
}

/// Adds the storage error of previous steps. With storage M, the rows contain now (M - M_old) - before (M_old -
/// M_older), see assembly::Rates, and M_old has an error too. The exact solution has no artificial storage.
void ErrorEstimator::add_before(fields::BlockVector& right_side) {
  auto& system = model_.system();
  if (!system.has_rates()) return;
  const auto [now, before] = rates_.to(model_.time(), system.rates());
  const auto artificial = system.artificially_stored(model_.state());
  for (std::size_t b = 0; b < right_side.size(); ++b) {
    right_side[b]->update(now, *artificial[b], 1);
    if (!stored_[0].empty()) right_side[b]->update(now + before, *stored_[0][b], 1);
    if (!stored_[1].empty()) right_side[b]->update(-before, *stored_[1][b], 1);
  }
  stored_[1] = std::move(stored_[0]);
  stored_[0].clear();
}

/// Estimates the errors of unknowns and reactions. With a lifting v of the prescribed unknowns, a reaction is a(u, v) -
/// f(v). Its error is a(delta, v) - rho(v), summed over v: the rows of delta minus the forces in them.
void ErrorEstimator::estimate_answer(fields::BlockVector right_side, const std::vector<OutputField>& outputs,
                                     ErrorEstimate& estimate) {
  auto& system = model_.system();
  auto x = fields::create_like(model_.state());
  for (const auto& error : flux_errors_) error->add_truncation(model_.state(), right_side);
  const auto forces = system.sums_of_held(right_side), reactions = system.reactions(model_.state());
  add_before(right_side);
  try {
    prescribe(right_side);
  } catch (const Error& error) {  // the same on every rank: a condition has no value between nodes
    estimate.failure = error.what();
    return;
  }
  if (block("traction") >= 0) add_edges(right_side);
  const auto report = model_.newton().answer(model_.state(), right_side, x, solve_tolerance);
  estimate.failure = report.reason;
  if (!report.converged) return;
  if (system.has_rates()) stored_[0] = system.stored(model_.state(), x);
  estimate.lacks = fields::create_like(x);
  fields::copy(x, estimate.lacks);
  for (std::size_t k = 0; k < flux_errors_.size(); ++k) {
    const auto carried = flux_errors_[k]->carried(x);
    for (std::size_t c = 0; c < carried.size(); ++c) estimate.fluxes[k].energy[c] += carried[c];
  }
  for (std::size_t b = 0; b < x.size(); ++b) x[b]->update(1, *model_.state()[b], 1);
  estimate.improved = system.outputs(x);
  estimate.reactions = system.reactions(x);
  for (std::size_t k = 0; k < reactions.size(); ++k)
    for (std::size_t i = 0; i < reactions[k].force.size(); ++i)
      estimate.reactions[k].force[i] -= reactions[k].force[i] + forces[k].force[i];
  if (recovery_ && !model_.mesh().fracture_names.empty()) estimate_jump(outputs, estimate);
}

/// Adds the error at edges of contact zones. The traction rows are the face law, linear in increments of jumps and
/// tractions. The load that causes an increment is therefore the Jacobian of the law times the increment.
void ErrorEstimator::add_edges(fields::BlockVector& right_side) const {
  auto& system = model_.system();
  const auto& mesh = model_.mesh();
  const auto& scene = model_.scene();
  const int lambda = block("traction");
  auto move = fields::create_like(model_.state()), rows = fields::create_like(model_.state());
  if (!physics::add_edges_of_contact(mesh, layouts(), displacement(model_.state()),
                                     {physics::elasticity(scene, mesh), physics::varying_gaps(scene, mesh)},
                                     system.grips(model_.state()), *move[blocks_[physics::bubble]], *move[lambda]))
    return;
  system.globalisation().damp(0, {});
  for (std::size_t k = 0; k < system.modules().size(); ++k) {
    if (system.modules()[k]->name() != "elastic-plastic jump") continue;
    auto law = system.create_matrix();
    system.module_jacobian(static_cast<int>(k), model_.state(), law);
    law.apply(move, rows);
    right_side[lambda]->update(1, *rows[lambda], 1);
  }
}

void ErrorEstimator::estimate_jump(const std::vector<OutputField>& outputs, ErrorEstimate& estimate) const {
  const auto& mesh = model_.mesh();
  const int dim = mesh.dim();
  OutputField error{.name = "jump error",
                    .unit = "m",
                    .entity = fields::Entity::fracture_face,
                    .n_components = dim,
                    .values = values_of(estimate.improved, "jump")};
  const auto& jump = values_of(outputs, "jump");
  std::array<Real, 2> here{};
  for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f)
    for (int k = f * dim; k < (f + 1) * dim; ++k) {
      error.values[k] -= jump[k];
      here[0] += mesh.fracture_faces[f].area * error.values[k] * error.values[k];
      here[1] += mesh.fracture_faces[f].area * jump[k] * jump[k];
    }
  const auto all = base::sum_over_ranks(*mesh.comm, here);
  estimate.jump = std::sqrt(all[0]);
  const Real length = model_.system().scales().at("displacement");
  estimate.relative_jump = ratio_of(estimate.jump, std::sqrt(all[1]), std::sqrt(section_) * length);
  estimate.fields.push_back(std::move(error));
}

}  // namespace sprekk::model
