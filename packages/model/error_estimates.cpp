#include "model/error_estimates.hpp"

#include "model/json_keys.hpp"

namespace sprekk::model {

estimate::ErrorEstimator make_error_estimator(Model& model, Real start) {
  std::vector<std::unique_ptr<estimate::MeshError>> errors;
  physics::for_each_physics([&]<physics::HasEstimate P>(P) {
    if (auto error = P::Estimate::mesh_error(model.setting(), model.system())) errors.push_back(std::move(error));
  });
  estimate::ErrorEstimator estimator(model.system(), std::move(errors), start,
                                     [&](const fields::BlockVector& x, const fields::BlockVector& right_side,
                                         fields::BlockVector& dx, Real tolerance) -> std::string {
                                       const auto report =
                                           model.newton().solve_linearized(x, right_side, dx, tolerance);
                                       return report.converged ? "" : report.reason;
                                     });
  if (model.scene().accuracy) estimator.request_correction();
  return estimator;
}

estimate::State present_state(const Model& model, const std::vector<assembly::OutputField>& outputs) {
  return {model.state(), model.time(), outputs};
}

RunEstimates::RunEstimates(Model& model, Real start) : estimator_(make_error_estimator(model, start)) {
  const auto& accuracy = model.scene().accuracy;
  if (!accuracy) return;
  goals_.emplace(estimator_, accuracy->functionals());
  weighs_ = !accuracy->refines_during_run();
}

const estimate::ErrorEstimate& RunEstimates::of_step(const estimate::State& state) {
  estimated_ = estimator_(state);
  goals_->add(state, *estimated_, true);
  return *estimated_;
}

estimate::ErrorEstimate RunEstimates::take(const estimate::State& state, bool last, bool converged) {
  if (estimated_) {
    auto estimate = std::move(*estimated_);
    estimated_.reset();
    return estimate;
  }
  auto estimate = estimator_(state);
  if (!goals_ || !converged) return estimate;
  goals_->add(state, estimate, last);
  if (weighs_) goals_->weigh(state, estimate, last);
  return estimate;
}

nlohmann::json summary(const estimate::ErrorEstimator& estimator, const estimate::ErrorEstimate& estimate) {
  nlohmann::json result = nlohmann::json::object();
  for (std::size_t k = 0; k < estimate.norms.size(); ++k) {
    const auto& names = estimator.errors()[k]->names();
    const auto& norm = estimate.norms[k];
    result[with_underscores(names.name)] = {{"relative", norm.relative}, {"energy_norm", norm.error}};
    if (names.output.empty()) continue;
    auto& of_output = result[with_underscores(names.output)];
    if (const auto& error = estimate.of_outputs[k])
      of_output = {{"relative", error->relative}, {"norm", error->norm}};
    else if (!estimate.failure.empty())
      of_output = {{"failure", estimate.failure}};
  }
  return result;
}

}  // namespace sprekk::model
