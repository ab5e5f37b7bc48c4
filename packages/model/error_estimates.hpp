// Error estimates of the states of a model.
#pragma once

#include "estimate/error_estimate.hpp"
#include "model/model.hpp"

#include <nlohmann/json.hpp>

#include <vector>

namespace sprekk::model {

/// Creates the estimator of the errors of all physics since the time `start`. It refers to the model. With the section
/// Accuracy it always computes the errors of the unknowns. Collective.
estimate::ErrorEstimator make_error_estimator(Model& model, Real start);

/// Present state of a model with its outputs. Refers to both.
estimate::State present_state(const Model& model, const std::vector<assembly::OutputField>& outputs);

/// Entry "error_estimate" of results.json. Stored data.
nlohmann::json summary(const estimate::ErrorEstimator& estimator, const estimate::ErrorEstimate& estimate);

}  // namespace sprekk::model
