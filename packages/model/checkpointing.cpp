#include "model/checkpointing.hpp"

#include <Teuchos_CommHelpers.hpp>

namespace sprekk::model {

Checkpointing::Checkpointing(Model& model, Steps& steps, Adaptation& adaptation, const std::string& directory,
                             base::Log& log)
    : model_(model),
      steps_(steps),
      adaptation_(adaptation),
      log_(log),
      checkpoints_(model.system().comm(), directory + "/checkpoints") {}

EarlierResults Checkpointing::restore() {
  std::vector<std::string> damage;
  auto checkpoint = checkpoints_.read(damage);
  for (const auto& what : damage) log_.warning("{}", what);
  steps_.go_to_stage_at(checkpoint.content.at("time"), checkpoint.content.value("begins stage", false));
  model_.restore(checkpoint);
  steps_.resume(checkpoint.content.value("steps", nlohmann::json()));
  if (checkpoint.content.contains("accuracy")) adaptation_.resume(checkpoint.content["accuracy"]);
  log_.info("going on from t = {}", model_.time());
  n_saved_steps_ = static_cast<int>(checkpoint.journal.size());
  return {std::move(checkpoint.journal),   checkpoint.content.at("restarts"),
          checkpoint.content.at("probes"), checkpoint.content.value("stages", nlohmann::json::array()),
          std::move(checkpoint.vectors),   checkpoint.content.value("common", nlohmann::json::object())};
}

bool Checkpointing::is_due(int n_steps, bool last) const {
  const auto& times = model_.scene().output.checkpoints;
  if (!times) return false;
  if (last || (times->steps && n_steps % *times->steps == 0)) return true;
  const std::chrono::duration<Real, std::ratio<60>> passed = std::chrono::steady_clock::now() - last_;
  int due = times->minutes && passed.count() >= *times->minutes;  // clock of rank 0
  Teuchos::broadcast(*model_.system().comm(), 0, 1, &due);
  return due != 0;
}

void Checkpointing::after_step(const Results& results, bool last) {
  if (is_due(results.n_steps(), last)) write(results);
}

void Checkpointing::at_the_end(const Results& results) {
  if (model_.scene().output.checkpoints && results.n_steps() > n_saved_steps_) write(results);
}

void Checkpointing::write(const Results& results) {
  const auto scope = model_.timers().scope("checkpoints");
  auto checkpoint = model_.save();
  checkpoint.content["restarts"] = results.restarts();
  checkpoint.content["probes"] = results.probes_begun();
  checkpoint.content["steps"] = steps_.memory();
  checkpoint.content["stages"] = results.stages();
  checkpoint.content["common"] = results.common_entries();
  if (model_.scene().accuracy) checkpoint.content["accuracy"] = adaptation_.memory();
  checkpoint.content["begins stage"] = steps_.is_at_begin_of_stage();
  checkpoint.journal = results.journal(n_saved_steps_);
  checkpoint.vectors.merge(results.faces());
  try {
    checkpoints_.write(checkpoint);
    n_saved_steps_ = results.n_steps();
  } catch (const Error& error) {
    log_.warning("no checkpoint at t = {}: {}", model_.time(), error.what());
  }
  last_ = std::chrono::steady_clock::now();
}

}  // namespace sprekk::model
