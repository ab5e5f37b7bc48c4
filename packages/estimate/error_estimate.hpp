// Estimates of the spatial discretisation error of a state, from the errors of each physics.
#pragma once

#include "assembly/system.hpp"
#include "estimate/mesh_error.hpp"
#include "estimate/step_rates.hpp"

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sprekk::estimate {

struct ErrorEstimate {
  std::vector<StateError> norms;  ///< [error of the estimator]
  /// Errors of the unknowns, outputs and reactions; none: not requested, or not computed because of `failure`.
  std::optional<Correction> correction = {};
  std::string failure = {};                                 ///< reason for a missing correction
  std::vector<std::optional<OutputError>> of_outputs = {};  ///< [error of the estimator]
  /// Output fields of the estimate. On cells: MeshError::Names::density. On fracture faces: "OUTPUT error" for
  /// Names::output, exact minus computed.
  std::vector<assembly::OutputField> fields = {};
};

/// Error estimator with tables reused for all states.
class ErrorEstimator {
 public:
  /// Solves the problem linearised at x, with fixed contact states, for dx. Returns the reason of a failure; empty:
  /// none. Collective.
  using SolveLinearized = std::function<std::string(const fields::BlockVector& x, const fields::BlockVector& right_side,
                                                    fields::BlockVector& dx, Real tolerance)>;

  /// Refers to the system. `start`: time of the initial state, s.
  ErrorEstimator(assembly::System& system, std::vector<std::unique_ptr<MeshError>> errors, Real start,
                 SolveLinearized solve);

  /// Estimates the error of a state. The energy norms are those of each MeshError. The errors of the unknowns solve the
  /// linearised problem with the right side
  ///   residuals of the exact solution + storage errors of previous steps,
  /// and the errors of prescribed values in the rows of prescribed unknowns. They are computed if an output has an
  /// error or if they were requested. Collective.
  ErrorEstimate operator()(const State& state);
  /// Requests the errors of the unknowns for all following states.
  void request_correction() { requested_ = true; }

  /// Contribution of each owned cell to the error bound of J at a state that follows `steps`, errors of one MeshError
  /// in each step; the last one is that of the state. The contributions are products of the energy norms of the error
  /// and of the adjoint solution, summed over the steps. Backward in time, every step uses the linearised equations of
  /// the last step. Without an adjoint solution: the energies of the errors, summed over the steps. Collective.
  std::vector<Real> contributions(const Functional& J, const State& state, MeshError& error,
                                  const std::vector<CellErrors>& steps);

  const std::vector<std::unique_ptr<MeshError>>& errors() const { return errors_; }
  assembly::System& system() const { return system_; }

 private:
  void add_time_history(const State& state, fields::BlockVector& right_side);
  void correct(const State& state, ErrorEstimate& estimate);
  void add_errors_of_outputs(const State& state, ErrorEstimate& estimate) const;

  assembly::System& system_;
  std::vector<std::unique_ptr<MeshError>> errors_;
  SolveLinearized solve_;
  bool requested_ = false;
  StepRates rates_;
  std::array<fields::BlockVector, 2> stored_;  // missing storage in the last state and in the state before
};

}  // namespace sprekk::estimate
