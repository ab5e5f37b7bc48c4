// How far stress, jumps and what flows in a model's present state are off, as far as the mesh is to blame.
#pragma once

#include "model/model.hpp"
#include "physics/mechanics/stress_recovery.hpp"
#include "physics/step_rates.hpp"

#include <nlohmann/json.hpp>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sprekk::model {

struct ErrorEstimate {
  Real stress = 0, relative_stress = 0;  ///< of the stress in the norm of the energy, sqrt(J); by that of the stress
  Real jump = 0, relative_jump = 0;      ///< of the jumps of all faces in L2, m sqrt(m^2) (2D: m sqrt(m)); by the jumps
  Real stress_norm = 0;                  ///< that of the stress, sqrt(J)
  std::vector<Real> energy;              ///< [owned cell] of the stress' error, J
  /// Of balances that have an error of their own, see physics::MeshError.
  struct Flux {
    std::string name;               ///< "flux"
    std::vector<Real> parts = {};   ///< [component]
    std::vector<Real> energy = {};  ///< [owned cell] of its error, and of what it carries
    Real error = 0, whole = 0;      ///< of all in the norm of the energy, the root of that
  };
  std::vector<Flux> fluxes;
  std::string failure;  ///< why there is no estimate of the jumps
  /// The outputs of the state with what it lacks by estimate; empty where there is no estimate of the jumps.
  std::vector<assembly::OutputField> improved;
  /// By how much the unknowns are too small; empty where that is not known.
  fields::BlockVector lacks;
  /// By how much the reactions are too small, as System::reactions(); empty where there is no such estimate.
  std::vector<assembly::Reaction> reactions;
  /// On cells "... error density" of each balance, its unit per m^3, and "error density", J/m^3: energy of
  /// the stress' error per volume; on fracture faces "jump error", m: what the jump lacks, in global components.
  std::vector<assembly::OutputField> fields;

  /// What results.json has of it.
  nlohmann::json summary() const;
};

/// Keeps tables from state to state. Refers to the model.
class ErrorEstimator {
 public:
  /// Collective.
  explicit ErrorEstimator(Model& model);

  /// Of the present state. `outputs` are its. The stress against the recovered one (see physics::StressRecovery); for
  /// the jumps, the answer of the linearised problem to the forces that the recovered stress and traction leave over,
  /// to what prescribed displacements miss between nodes, and to what faces miss in which contact begins or ends, with
  /// states of contact as they are. Collective.
  ErrorEstimate operator()(const std::vector<assembly::OutputField>& outputs);
  /// From now on that of the reactions is wanted, without fractures, too.
  void want_reactions() { wants_reactions_ = true; }

  /// A functional that a balance knows, and what it lacks; infinite: that is not known.
  struct OfFunctional {
    Real value, lack;
  };
  /// Of the present state, whose estimate this is. None of all balances knows it: no value. Collective.
  std::optional<OfFunctional> of_functional(const physics::Functional& J, const ErrorEstimate& estimate);
  /// [owned cell] The product of the norms of the error of the fluxes and of that of the weight that each place has for
  /// J at the end of steps whose estimates these are, the last that of the present state; empty unless all is one
  /// symmetric balance. What each step has left out is carried on to the end, as if all were like the last one.
  /// Collective.
  bool has_shares() const { return !recovery_ && flux_errors_.size() == 1; }
  std::vector<Real> shares(const physics::Functional& J, const std::vector<std::vector<ErrorEstimate::Flux>>& steps);

  /// Where on the mesh the integral of d . [[u]] over fracture faces errs: the energy of the error of the stress, J
  /// [owned cell], of the linearised problem's answer to the forces d on the sides plus and -d on the sides minus. `d`
  /// [owned fracture face * dim] is in the faces' frames. Empty: there is no answer. Collective.
  std::vector<Real> answer_energy(const std::vector<Real>& d);

 private:
  int block(const std::string& name) const;  ///< -1: there is none
  physics::ByField<const fields::Layout*> layouts() const;
  void add_stress(const physics::StressError& error, fields::BlockVector& right_side);
  void estimate_answer(fields::BlockVector right_side, const std::vector<assembly::OutputField>& outputs,
                       ErrorEstimate& estimate);
  void add_before(fields::BlockVector& right_side);
  /// Adds to the rows of tractions what moves faces by what they miss in which contact begins or ends.
  void add_edges(fields::BlockVector& right_side) const;
  physics::ByField<RCP<const fields::Vector>> displacement(const fields::BlockVector& x) const;
  void estimate_jump(const std::vector<assembly::OutputField>& outputs, ErrorEstimate& estimate) const;

  /// Sets the rows of prescribed unknowns to what their values lack: of displacements what they miss between nodes.
  void prescribe(fields::BlockVector& right_side) const;

  ErrorEstimate::Flux flux_error(physics::MeshError& error) const;
  std::vector<Real> by_cell(const physics::MeshError& error, const std::vector<Real>& squares) const;
  /// Sets all rows of prescribed unknowns to zero.
  void hold(fields::BlockVector& right_side) const;

  Model& model_;
  std::vector<std::unique_ptr<physics::MeshError>> flux_errors_;
  physics::ByField<int> blocks_;                       // of displacements, -1: there is none
  std::unique_ptr<physics::StressRecovery> recovery_;  // null: nothing deforms
  bool wants_reactions_ = false;
  physics::StepRates rates_;
  std::array<fields::BlockVector, 2> stored_;  // what is stored too little, at the last state and the one before
  Real section_;                               // of a body of the domain's largest extent, m^2 (2D: m)
};

}  // namespace sprekk::model
