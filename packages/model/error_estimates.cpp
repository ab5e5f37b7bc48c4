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
