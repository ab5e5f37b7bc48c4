// The embedding surface: a host application includes this header and no other.
#pragma once

#include "assembly/kernel_module.hpp"
#include "assembly/layer_volume.hpp"
#include "assembly/system.hpp"
#include "base/log.hpp"
#include "base/timer.hpp"
#include "io/checkpoints.hpp"
#include "model/scene.hpp"
#include "solve/condensed_solve.hpp"
#include "solve/time_stepping.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sprekk::model {

struct StagedScene;

/// Modules of a host for a rank's part of the mesh; called on every rank, must not communicate.
using ModuleFactory = std::function<std::vector<std::unique_ptr<assembly::Module>>(const mesh::Mesh&)>;

/// A field in place, on the entities that this rank owns: entity i is the node with mesh().node_id[i], the cell with
/// mesh().cell_id[i] or mesh().fracture_faces[i]. What a host writes counts at once.
struct FieldView {
  fields::Field field;
  View<Real**> values;  ///< [owned entity, component], in device memory
};

/// A scene brought to life on a communicator: mesh, modules, solver and the present state. Several can live in one
/// process. All members are collective unless they return stored data.
class Model {
 public:
  /// Prepares the scene (see prepared()) and builds its system; `more_modules` are appended to the scene's own. Errors
  /// are the same on every rank.
  Model(const Scene& scene, RCP<const Comm> comm, const ModuleFactory& more_modules = {});

  /// Goes from time() to t in one step, in substeps where Newton needs them. If the report is not converged, or an
  /// Error is thrown, the state is the last that did, at time().
  solve::StepReport step_to(Real t);

  /// Goes on as `changed` from time() on: materials, loads, conditions and laws may be others, regions excavated. The
  /// state stays, and what no longer balances is in the next step, or is released as "release" of Bulk says. Where both
  /// scenes say the same nothing is done, and no bit changes. Errors name what a live model cannot follow, and leave it
  /// as it was.
  void change(const Scene& changed);

  /// An equilibrium at time() with what has changed since the last: entries of the scene, fields, what modules of a
  /// host do. Otherwise as step_to(). Error: something is stored, which takes time to change.
  solve::StepReport find_equilibrium();

  /// Goes back to where the last step began, to take it again under other loads: so a host that solves for a part of
  /// the problem itself iterates within a step. The solver keeps what it has, and modules what they keep outside of
  /// their histories. Error: there was no step since the model,
  /// or the last state that was taken back or restored.
  void take_back();

  /// The unknowns of a field, by its name, which are the start of the next step's iteration; or a history, by "MODULE:
  /// HISTORY", which the next step depends on. Valid until the model's next member call. Error: there is no such field.
  /// Stored data.
  FieldView field(const std::string& name);
  /// One of the outputs of the present state. Error: there is no such output.
  assembly::OutputField output(const std::string& name);

  /// All that the next step depends on. The solver starts anew, as it does in restore(): so the steps that follow have
  /// the same bits after either, on the same number of ranks.
  io::Checkpoint save();
  /// Goes back to what save() gave on any number of ranks. Error: it is of another scene; the message says in what.
  void restore(const io::Checkpoint& checkpoint);

  /// A line for each thing of the scene that is allowed and hardly meant: conditions that hold nowhere, columns that
  /// are passed over, what each physics doubts, steps that pass over knots of a table.
  std::vector<std::string> warnings() const;

  Real time() const { return time_; }
  const Scene& scene() const { return scene_; }
  physics::Setting setting() const { return {scene_, mesh(), scene_.time.start}; }
  const mesh::Mesh& mesh() const { return system_->mesh(); }
  assembly::System& system() { return *system_; }
  const assembly::System& system() const { return *system_; }
  const solve::Newton& newton() const { return *newton_; }
  solve::Newton& newton() { return *newton_; }
  /// The present unknowns, one vector per block, owned by the model.
  const fields::BlockVector& state() const { return x_; }
  base::Timers& timers() { return *timers_; }

 private:
  /// What equations are made of.
  struct Draft {
    Scene scene;
    RCP<const mesh::Mesh> mesh;
    std::vector<std::unique_ptr<assembly::Module>> modules;
  };
  Draft drafted(Scene scene, const std::string& unheld = "") const;
  Draft drafted_change(const Scene& before, const Scene& changed) const;
  void check_stages() const;
  void check_start(Draft draft, const StagedScene& stage) const;
  std::unique_ptr<assembly::System> make_system(Draft draft) const;

  /// What a step begins with.
  struct Beginning {
    fields::BlockVector x;
    std::vector<View<Real**>> histories;
    assembly::System::Memory memory;
    Real time;
  };
  solve::StepReport advance(Real t);
  void start_solver();
  Beginning beginning();

  ModuleFactory more_modules_;
  Scene scene_;
  RCP<const mesh::Mesh> whole_mesh_;  ///< with what is excavated
  RCP<base::Timers> timers_;
  std::unique_ptr<assembly::System> system_;
  std::unique_ptr<solve::Newton> newton_;
  std::unique_ptr<solve::TimeStepper> stepper_;
  fields::BlockVector x_;
  Real time_ = 0;
  std::optional<Beginning> beginning_;  // of the last step
};

/// The equation system of a scene is a list of modules. Collective.
physics::Modules make_modules(const Scene& scene, const mesh::Mesh& mesh);

}  // namespace sprekk::model
