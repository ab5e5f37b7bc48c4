// Checkpoints of a run: when they are written, and how a run is restarted.
#pragma once

#include "base/log.hpp"
#include "model/adaptation.hpp"
#include "model/results.hpp"
#include "model/steps.hpp"

#include <chrono>

namespace sprekk::model {

/// Checkpoints of a model with its results and refined meshes, in DIRECTORY/checkpoints. All members are collective.
class Checkpointing {
 public:
  Checkpointing(Model& model, Steps& steps, Adaptation& adaptation, const std::string& directory, base::Log& log);

  /// Removes the checkpoints of a previous run.
  void remove_checkpoints() { checkpoints_.clear(); }
  /// Restores the model from the last undamaged checkpoint and warns of damaged ones. Returns the results up to this
  /// checkpoint. Throws an Error if there is no checkpoint, or if it belongs to another scene.
  EarlierResults restore();

  /// Writes a checkpoint after a step if required by the section Output. If writing fails, it only warns, and the run
  /// continues.
  void after_step(const Results& results, bool last);
  /// Writes a checkpoint after the last step if the scene has checkpoints and this state has none.
  void at_the_end(const Results& results);

 private:
  bool is_due(int n_steps, bool last) const;
  void write(const Results& results);

  Model& model_;
  Steps& steps_;
  Adaptation& adaptation_;
  base::Log& log_;
  io::Checkpoints checkpoints_;
  int n_saved_steps_ = 0;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace sprekk::model
