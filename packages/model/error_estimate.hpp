// Estimates of the spatial discretisation error of stress, jumps and fluxes in the present state of a model.
#pragma once

#include "model/model.hpp"
#include "physics/mechanics/stress_recovery.hpp"
#include "estimate/step_rates.hpp"

#include <nlohmann/json.hpp>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sprekk::model {

struct ErrorEstimate {
  Real stress = 0, relative_stress = 0;  ///< stress error in the energy norm, sqrt(J), and relative to the stress
  Real jump = 0, relative_jump = 0;  ///< L2 error of the jumps, m sqrt(m^2) (2D: m sqrt(m)), and relative to the jumps
  Real stress_norm = 0;              ///< energy norm of the stress, sqrt(J)
  std::vector<Real> energy;          ///< [owned cell] energy of the stress error, J
  /// Estimate of a balance with its own error estimator, see estimate::MeshError.
  struct Flux {
    std::string name;               ///< "flux"
    std::vector<Real> parts = {};   ///< [component] error vector e of estimate::MeshError
    std::vector<Real> energy = {};  ///< [owned cell] energy of the flux error, including that of the carried quantity
    Real error = 0, whole = 0;      ///< energy norms of the error and of the flux, square root of the unit
  };
  std::vector<Flux> fluxes;
  std::string failure;  ///< reason for a missing estimate of the jumps
  /// Outputs corrected by the estimated error of the state; empty without an estimate of the jumps.
  std::vector<assembly::OutputField> improved;
  /// Estimated error of the unknowns, exact minus computed; empty if unknown.
  fields::BlockVector lacks;
  /// Estimated error of the reactions, exact minus computed, as System::reactions(); empty without an estimate.
  std::vector<assembly::Reaction> reactions;
  /// Output fields of the estimate. On cells: "... error density" of each balance, its unit per m^3, and "error
  /// density", J/m^3, the energy of the stress error per volume. On fracture faces: "jump error", m, exact minus
  /// computed jump in global components.
  std::vector<assembly::OutputField> fields;

  /// Entry of results.json.
  nlohmann::json summary() const;
};

/// Error estimator with tables reused for all states. It refers to the model.
class ErrorEstimator {
 public:
  /// Builds the tables of the model. Collective.
  explicit ErrorEstimator(Model& model);

  /// Estimates the error of the present state; `outputs` belong to this state. The stress error is the difference to
  /// the recovered stress (see physics::StressRecovery). The error of the jumps solves the linearised problem with
  /// fixed contact states. Its loads are:
  /// * residual forces of the recovered stress and traction;
  /// * errors of prescribed displacements between nodes;
  /// * errors on faces where contact begins or ends.
  ///
  /// Collective.
  ErrorEstimate operator()(const std::vector<assembly::OutputField>& outputs);
  /// Requests the estimate of reactions for all following states, also without fractures.
  void want_reactions() { wants_reactions_ = true; }

  /// Functional supported by a balance: value, and exact minus computed value; infinite if unknown.
  struct OfFunctional {
    Real value, lack;
  };
  /// Evaluates a functional in the present state, with the estimate of this state. Returns no value if no balance
  /// supports it. Collective.
  std::optional<OfFunctional> of_functional(const estimate::Functional& J, const ErrorEstimate& estimate);
  /// Returns true for a model with exactly one flux error estimator and without mechanics; shares() requires it. Stored
  /// data.
  bool has_shares() const { return !recovery_ && flux_errors_.size() == 1; }
  /// Returns the contribution of each owned cell to the error bound of J at the end of `steps`. `steps` contains the
  /// flux estimates of all steps; the last one is that of the present state. The contributions are products of the
  /// energy norms of the flux error and of the adjoint solution, summed over the steps. Backward in time, every step
  /// uses the linearised equations of the last step. The result is empty without has_shares(), or if a solve does not
  /// converge. Collective.
  std::vector<Real> shares(const estimate::Functional& J, const std::vector<std::vector<ErrorEstimate::Flux>>& steps);

  /// Computes where mesh errors affect the integral of d . [[u]] over fracture faces. The linearised problem is solved
  /// with forces d on the plus sides and -d on the minus sides. Returns the energy of the stress error of its solution,
  /// J [owned cell]; empty without a solution. `d` [owned fracture face * dim] is in the face frames. Collective.
  std::vector<Real> answer_energy(const std::vector<Real>& d);

 private:
  int block(const std::string& name) const;  ///< -1 if there is none
  physics::ByField<const fields::Layout*> layouts() const;
  void add_stress(const physics::StressError& error, fields::BlockVector& right_side);
  void estimate_answer(fields::BlockVector right_side, const std::vector<assembly::OutputField>& outputs,
                       ErrorEstimate& estimate);
  void add_before(fields::BlockVector& right_side);
  /// Adds the error of faces where contact begins or ends to the traction rows.
  void add_edges(fields::BlockVector& right_side) const;
  physics::ByField<RCP<const fields::Vector>> displacement(const fields::BlockVector& x) const;
  void estimate_jump(const std::vector<assembly::OutputField>& outputs, ErrorEstimate& estimate) const;

  /// Sets the rows of prescribed unknowns to the error of their values: for displacements, the error between nodes.
  void prescribe(fields::BlockVector& right_side) const;

  ErrorEstimate::Flux flux_error(estimate::MeshError& error) const;
  std::vector<Real> by_cell(const estimate::MeshError& error, const std::vector<Real>& squares) const;
  /// Sets all rows of prescribed unknowns to zero.
  void hold(fields::BlockVector& right_side) const;

  Model& model_;
  std::vector<std::unique_ptr<estimate::MeshError>> flux_errors_;
  physics::ByField<int> blocks_;                       // of displacements; -1 if there is none
  std::unique_ptr<physics::StressRecovery> recovery_;  // null without deformation
  bool wants_reactions_ = false;
  estimate::StepRates rates_;
  std::array<fields::BlockVector, 2> stored_;  // missing storage in the last state and in the state before
  Real section_;  // cross-section of a body with the largest extent of the domain, m^2 (2D: m)
};

}  // namespace sprekk::model
