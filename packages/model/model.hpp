// The embedding surface: a host application includes this header and no other.
#pragma once

#include "assembly/system.hpp"
#include "base/log.hpp"
#include "base/timer.hpp"
#include "model/scene.hpp"
#include "solve/condensed_solve.hpp"
#include "solve/time_stepping.hpp"

#include <memory>
#include <string>
#include <vector>

namespace sprekk::model {

/// A scene brought to life on a communicator: mesh, modules, solver and the present state. Several can live in one
/// process. All members are collective unless they return stored data.
class Model {
 public:
  Model(const Scene& scene, RCP<const Comm> comm);

  /// Goes from time() to t in one step, in substeps where Newton needs them. If the report is not converged, the state
  /// is the last that did, at report.time.
  solve::StepReport step_to(Real t);

  Real time() const { return time_; }
  const Scene& scene() const { return scene_; }
  const mesh::Mesh& mesh() const { return system_->mesh(); }
  assembly::System& system() { return *system_; }
  const assembly::System& system() const { return *system_; }
  const solve::Newton& newton() const { return *newton_; }
  /// The present unknowns, one vector per block, owned by the model.
  const fields::BlockVector& state() const { return x_; }
  base::Timers& timers() { return *timers_; }

 private:
  Scene scene_;
  RCP<base::Timers> timers_;
  std::unique_ptr<assembly::System> system_;
  std::unique_ptr<solve::Newton> newton_;
  std::unique_ptr<solve::TimeStepper> stepper_;
  fields::BlockVector x_;
  Real time_ = 0;
};

/// The equation system of a scene is a list of modules.
std::vector<std::unique_ptr<assembly::Module>> make_modules(const Scene& scene, const mesh::Mesh& mesh);

}  // namespace sprekk::model
