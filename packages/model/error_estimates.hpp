// Error estimates of the states of a model.
#pragma once

#include "estimate/goals.hpp"
#include "model/model.hpp"

#include <nlohmann/json.hpp>

#include <optional>
#include <vector>

namespace sprekk::model {

/// Creates the estimator of the errors of all physics since the time `start`. It refers to the model. With the section
/// Accuracy it always computes the errors of the unknowns. Collective.
estimate::ErrorEstimator make_error_estimator(Model& model, Real start);

/// Present state of a model with its outputs. Refers to both.
estimate::State present_state(const Model& model, const std::vector<assembly::OutputField>& outputs);

/// Error estimates of the states of a model on one mesh, from a time on, with the quantities of Accuracy. Refers to the
/// model. All members are collective unless they return stored data.
class RunEstimates {
 public:
  RunEstimates(Model& model, Real start);

  /// Estimates the present state, as the next one of the run, and the errors of all quantities. take() returns the same
  /// estimate.
  const estimate::ErrorEstimate& of_step(const estimate::State& state);
  /// Returns the estimate of the present state. `last`: see Goals::add(). States that are not `converged` have no
  /// quantities.
  estimate::ErrorEstimate take(const estimate::State& state, bool last, bool converged);
  /// Returns whether the present state must be estimated. Stored data.
  bool need(bool last) const { return estimated_ || !goals_ || goals_->need(last); }

  const estimate::ErrorEstimator& estimator() const { return estimator_; }
  /// Without a value if the scene has no section Accuracy.
  std::optional<estimate::Goals>& goals() { return goals_; }
  const std::optional<estimate::Goals>& goals() const { return goals_; }

 private:
  estimate::ErrorEstimator estimator_;
  std::optional<estimate::Goals> goals_;
  std::optional<estimate::ErrorEstimate> estimated_;  // of the present state, not yet taken
  bool weighs_ = true;                                // cells are marked at the end of the run
};

/// Entry "error_estimate" of results.json. Stored data.
nlohmann::json summary(const estimate::ErrorEstimator& estimator, const estimate::ErrorEstimate& estimate);

}  // namespace sprekk::model
