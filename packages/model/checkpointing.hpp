// The checkpoints of a run: when one is written, and how a run goes on from one.
#pragma once

#include "base/log.hpp"
#include "model/results.hpp"
#include "model/steps.hpp"

#include <chrono>

namespace sprekk::model {

/// Checkpoints of a model with its results, in DIRECTORY/checkpoints. All members are collective.
class Checkpointing {
 public:
  Checkpointing(Model& model, Steps& steps, const std::string& directory, base::Log& log);

  /// Removes the checkpoints of an earlier run.
  void start_anew() { checkpoints_.clear(); }
  /// Brings the model to the last checkpoint that is undamaged, warns of damaged ones, and returns what the results
  /// were. Error: there is none, or it is of another scene.
  EarlierResults restore();

  /// Writes a checkpoint if Output of the scene asks for one after this step. If it cannot be written, warns, and the
  /// run goes on.
  void after_step(const Results& results, bool last);
  /// Writes a checkpoint of the model after its last step, if the scene asks for any and there is none yet.
  void at_the_end(const Results& results);

 private:
  bool is_due(int n_steps, bool last) const;
  void write(const Results& results);

  Model& model_;
  Steps& steps_;
  base::Log& log_;
  io::Checkpoints checkpoints_;
  int n_saved_steps_ = 0;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace sprekk::model
