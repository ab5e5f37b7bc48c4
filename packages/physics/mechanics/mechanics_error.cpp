#include "physics/mechanics/mechanics_error.hpp"

#include "assembly/prescribed_error.hpp"
#include "assembly/system.hpp"
#include "base/host_table.hpp"
#include "base/over_ranks.hpp"
#include "mesh/extents.hpp"
#include "physics/comparison.hpp"
#include "physics/mechanics/edge_of_contact.hpp"
#include "physics/mechanics/fracture_goals.hpp"
#include "physics/mechanics/traction_recovery.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sprekk::physics {

namespace {

const std::vector<Real>& values_of(const std::vector<assembly::OutputField>& outputs, const std::string& name) {
  return std::find_if(outputs.begin(), outputs.end(), [&](const auto& o) { return o.name == name; })->values;
}

/// Returns part / whole, with a small result if the whole is only round-off of quantities of the given scale.
Real ratio_of(Real part, Real whole, Real scale) { return part == 0 ? 0 : part / std::max(whole, 1e-10 * scale); }

class MechanicsError final : public estimate::MeshError, estimate::GoalErrors {
 public:
  MechanicsError(const Setting& setting, assembly::System& system)
      : setting_(setting),
        system_(system),
        names_{.name = "stress",
               .unit = "J",
               .density = "error density",
               .output = setting.mesh.fracture_names.empty() ? "" : "jump"},
        blocks_{block("displacement"), block("side bubble"), block("tip displacement")},
        traction_(block("traction")),
        section_(std::pow(mesh::largest_extent(setting.mesh), setting.mesh.dim() - 1)),
        of_fractures_(setting.mesh) {
    for (std::size_t k = 0; k < blocks_.size(); ++k)
      if (blocks_[k] >= 0) layouts_[k] = &system.layouts()[blocks_[k]];
    if (layouts_[nodal])
      recovery_ = make_stress_recovery(Teuchos::rcpFromRef(setting.mesh), layouts_, elasticity(setting.scene, mesh()));
  }
  bool has_displacements() const { return recovery_ != nullptr; }

  const Names& names() const override { return names_; }
  estimate::GoalErrors* goals() override { return this; }

  estimate::StateError of_state(const fields::BlockVector& x, Real) override {
    stress_ = (*recovery_)(displacement(x));
    const auto& scales = system_.scales();
    const Real energy = scales.at("stress") * scales.at("displacement");
    estimate::StateError result{
        {std::move(stress_.energy), {}}, std::move(stress_.density), stress_.error, stress_.stress};
    result.relative = ratio_of(result.error, result.whole, std::sqrt(section_ * energy));
    return result;
  }

  void add_residual(const fields::BlockVector& x, fields::BlockVector& right_side) override {
    const auto forces = of_fields(right_side);
    for (std::size_t k = 0; k < blocks_.size(); ++k)
      if (forces[k] != Teuchos::null) forces[k]->update(1, *stress_.forces[k], 1);
    stress_.forces = {};
    if (traction_ < 0) return;
    add_unresolved_traction(mesh(), layouts_, system_.layouts()[traction_], initial_stress(setting_.scene, mesh()),
                            *x[traction_], forces);
    add_edges(x, right_side);
  }

  void add_prescribed(Real t, fields::BlockVector& right_side) const override {
    const int nodes = blocks_[nodal];
    const auto conditions =
        dirichlet_conditions(setting_.scene.boundary_conditions, {}, names_of(mesh()), "displacement");
    const auto missed = assembly::prescribed_error(mesh(), *layouts_[nodal], conditions, t);
    const auto constrained = base::to_host(system_.constrained(nodes));
    const auto from = missed.getLocalViewHost(Tpetra::Access::ReadOnly);
    const auto to = right_side[nodes]->getLocalViewHost(Tpetra::Access::ReadWrite);
    for (std::size_t i = 0; i < constrained.extent(0); ++i)
      if (constrained(i)) to(i, 0) = from(i, 0);
  }

  estimate::OutputError of_output(const estimate::State& state, const estimate::Correction& correction) const override {
    const int dim = mesh().dim();
    assembly::OutputField error{.name = "jump error",
                                .unit = "m",
                                .entity = fields::Entity::fracture_face,
                                .n_components = dim,
                                .values = values_of(correction.outputs, "jump")};
    const auto& jump = values_of(state.outputs, "jump");
    std::array<Real, 2> squares{};
    for (LocalIndex f = 0; f < mesh().n_owned_fracture_faces; ++f)
      for (int k = f * dim; k < (f + 1) * dim; ++k) {
        error.values[k] -= jump[k];
        squares[0] += mesh().fracture_faces[f].area * error.values[k] * error.values[k];
        squares[1] += mesh().fracture_faces[f].area * jump[k] * jump[k];
      }
    squares = base::sum_over_ranks(*mesh().comm, squares);
    const Real norm = std::sqrt(squares[0]), length = system_.scales().at("displacement");
    return {norm, ratio_of(norm, std::sqrt(squares[1]), std::sqrt(section_) * length), std::move(error)};
  }

  bool knows(const std::string& what) const override { return what == "reaction" || FractureGoals::knows(what); }
  bool has_history(const estimate::Functional& J) const override { return J.what == "slip"; }
  bool follow(const estimate::State& state, const estimate::Correction* correction) override {
    return of_fractures_.follow(state.outputs, correction ? &correction->outputs : nullptr);
  }
  estimate::Estimate evaluate(const estimate::Functional& J, const estimate::State& state,
                              const estimate::Correction* correction) override {
    if (J.what != "reaction")
      return of_fractures_.evaluate(J, state.outputs, correction ? &correction->outputs : nullptr);
    return {reaction(J, system_.reactions(state.x)),
            correction ? std::abs(reaction(J, correction->reactions)) : std::numeric_limits<Real>::infinity()};
  }

  /// Adds forces d on the plus sides and -d on the minus sides, for a mean of d . [[u]].
  bool add_derivative(const estimate::Functional& J, const estimate::State& state,
                      fields::BlockVector& right_side) override {
    if (!FractureGoals::is_mean_jump(J.what)) return false;
    const auto d = of_fractures_.directions(J, state.outputs);
    const auto& layout = system_.layouts()[traction_];
    fields::Vector direction(layout.owned());
    {
      const auto view = direction.getLocalViewHost(Tpetra::Access::OverwriteAll);
      for (std::size_t i = 0; i < d.size(); ++i) view(i, 0) = d[i];
    }
    add_opposite_tractions(mesh(), layouts_, layout, direction, of_fields(right_side));
    estimate::zero_constrained_rows(system_, right_side);
    return true;
  }
  estimate::CellErrors of_adjoint(const fields::BlockVector&, const fields::BlockVector& z) override {
    return {(*recovery_)(displacement(z)).energy, {}};
  }

 private:
  const mesh::Mesh& mesh() const { return setting_.mesh; }
  int block(const std::string& name) const {
    const auto& blocks = system_.blocks();
    const auto found = std::find_if(blocks.begin(), blocks.end(), [&](const auto& b) { return b.name == name; });
    return found == blocks.end() ? -1 : static_cast<int>(found - blocks.begin());
  }
  ByField<RCP<fields::Vector>> of_fields(const fields::BlockVector& all) const {
    ByField<RCP<fields::Vector>> fields;
    for (std::size_t k = 0; k < blocks_.size(); ++k)
      if (blocks_[k] >= 0) fields[k] = all[blocks_[k]];
    return fields;
  }
  ByField<RCP<const fields::Vector>> displacement(const fields::BlockVector& x) const {
    const auto [nodes, bubbles, tips] = of_fields(x);
    return {nodes, bubbles, tips};
  }

  /// Adds the error at edges of contact zones. The traction rows are the face law, linear in increments of jumps and
  /// tractions. The load that causes an increment is therefore the Jacobian of the law times the increment.
  void add_edges(const fields::BlockVector& x, fields::BlockVector& right_side) {
    auto increment = fields::create_like(x), rows = fields::create_like(x);
    if (!add_edges_of_contact(mesh(), layouts_, displacement(x),
                              {elasticity(setting_.scene, mesh()), varying_gaps(setting_.scene, mesh())},
                              system_.contact_constraints(x), *increment[blocks_[bubble]], *increment[traction_]))
      return;
    system_.globalisation().damp(0, {});
    for (std::size_t k = 0; k < system_.modules().size(); ++k) {
      if (system_.modules()[k]->name() != "elastic-plastic jump") continue;
      auto law = system_.create_matrix();
      system_.module_jacobian(static_cast<int>(k), x, law);
      law.apply(increment, rows);
      right_side[traction_]->update(1, *rows[traction_], 1);
    }
  }

  /// Component of the force on a boundary, of reactions or of their errors.
  Real reaction(const estimate::Functional& J, const std::vector<assembly::Reaction>& reactions) const {
    const auto component = static_cast<std::size_t>(J.component[0] - 'x');
    Real sum = 0;
    for (const auto& one : reactions)
      if (one.called.name == "reactions" && component < one.force.size() && one.region < 0 &&
          setting_.scene.boundary_conditions.at(one.condition).boundary == J.boundary)
        sum += one.force[component];
    return sum;
  }

  Setting setting_;
  assembly::System& system_;
  Names names_;
  ByField<int> blocks_;  // -1 if there is none
  int traction_;         // block; -1 if there is none
  ByField<const fields::Layout*> layouts_{};
  std::unique_ptr<StressRecovery> recovery_;  // null without deformation
  Real section_;        // cross-section of a body with the largest extent of the domain, m^2 (2D: m)
  StressError stress_;  // of the last state of of_state()
  FractureGoals of_fractures_;
};

}  // namespace

std::unique_ptr<estimate::MeshError> make_mechanics_error(const Setting& setting, assembly::System& system) {
  auto error = std::make_unique<MechanicsError>(setting, system);
  if (!error->has_displacements()) return nullptr;
  return error;
}

}  // namespace sprekk::physics
