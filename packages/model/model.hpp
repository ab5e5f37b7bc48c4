// Interface for embedding: host applications need only this header.
#pragma once

#include "assembly/divergence.hpp"
#include "assembly/kernel_module.hpp"
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

/// Factory of host modules for a rank's part of the mesh. It is called on every rank and must not communicate.
using ModuleFactory = std::function<std::vector<std::unique_ptr<assembly::Module>>(const mesh::Mesh&)>;

/// View of a field on the entities owned by this rank. Entity i is the node with mesh().node_id[i], the cell with
/// mesh().cell_id[i], or mesh().fracture_faces[i]. Values written by a host are effective immediately.
struct FieldView {
  fields::Field field;
  View<Real**> values;  ///< [owned entity, component], in device memory
};

/// Scene on a communicator: mesh, modules, solver and present state. Several models may exist in one process. All
/// members are collective unless they return stored data.
class Model {
 public:
  /// Prepares the scene (see prepared()) and builds its system. `more_modules` are appended to the modules of the
  /// scene. Errors are the same on every rank.
  Model(const Scene& scene, RCP<const Comm> comm, const ModuleFactory& more_modules = {});

  /// Advances from time() to t, s, in one step; if Newton's method fails, in substeps. If the report is not converged
  /// or an Error is thrown, the state is the last converged one, at time().
  solve::StepReport step_to(Real t);

  /// Replaces the scene by `changed` from time() on: materials, loads, conditions and laws may change, regions may be
  /// excavated. The state is preserved. Unbalanced forces act in the next step, or are released gradually according to
  /// "release" of Bulk. If both scenes are equal, the call has no effect. Unsupported changes throw an Error, and the
  /// model remains unchanged.
  void change(const Scene& changed);
  /// Returns the number of effective calls of change() and change_mesh(), each with a new system. Stored data.
  int n_changes() const { return n_changes_; }
  /// Bisects cells, given on all ranks by their numbers in the mesh with all regions, into cells with edges half as
  /// long, and adjacent cells as necessary. The state is transferred, see transfer(); it counts as a change. Throws an
  /// Error if the scene has neither Scene::bisection nor the section Growth.
  void refine(const std::vector<GlobalIndex>& cells) { change_mesh({cells}); }
  /// Like refine(), with extensions of fractures in 2D. New faces have their initial state. Returns the results of
  /// extensions, and Extended::tip for each turn that was made.
  std::vector<mesh::Extended> change_mesh(const mesh::MeshChange& change);
  /// Returns the tips of all extensions so far that had no room, also before a restart. Stored data.
  const std::vector<std::array<Real, 2>>& tips_without_room() const { return without_room_; }

  /// Finds an equilibrium at time() after changes of the scene, of fields or of host modules. Behaves otherwise like
  /// step_to(). Throws an Error in models with storage, which requires time.
  solve::StepReport find_equilibrium();

  /// Reverts the last step, so it can be repeated with other loads. A host that solves a part of the problem iterates
  /// within a step in this way. The solver retains its data, and modules retain data outside their histories. Throws an
  /// Error if there was no step since construction, or since the last take_back() or restore().
  void take_back();

  /// Returns a view of the unknowns of a field, given by its name; they are the initial iterate of the next step.
  /// "MODULE: HISTORY" returns a history, on which the next step depends. The view is valid until the next member call.
  /// Throws an Error if the field does not exist. Stored data.
  FieldView field(const std::string& name);
  /// Returns one output of the present state. Throws an Error if the output does not exist.
  assembly::OutputField output(const std::string& name);

  /// Returns all data on which the next step depends. The solver is reset, as in restore(). The following steps are
  /// therefore bitwise identical after save() and restore(), on the same number of ranks.
  io::Checkpoint save();
  /// Restores a state saved on any number of ranks. Throws an Error that names the difference if it is of another
  /// scene.
  void restore(const io::Checkpoint& checkpoint);

  /// Returns one line per implausible input: conditions without effect, ignored columns, warnings of each physics,
  /// steps that skip knots of a table, stages after the end.
  std::vector<std::string> warnings() const;

  Real time() const { return time_; }
  const Scene& scene() const { return scene_; }
  physics::Setting setting() const { return {scene_, mesh(), scene_.time.start}; }
  const mesh::Mesh& mesh() const { return system_->mesh(); }
  assembly::System& system() { return *system_; }
  const assembly::System& system() const { return *system_; }
  const solve::Newton& newton() const { return *newton_; }
  solve::Newton& newton() { return *newton_; }
  /// Present unknowns, one vector per block, owned by the model.
  const fields::BlockVector& state() const { return x_; }
  base::Timers& timers() { return *timers_; }

 private:
  /// Data from which equations are built.
  struct Draft {
    Scene scene;
    RCP<const mesh::Mesh> mesh;
    std::vector<std::unique_ptr<assembly::Module>> modules;
  };
  RCP<const mesh::Mesh> make_whole_mesh(const base::Draft<Scene>& draft, RCP<const Comm> comm,
                                        std::string& unconstrained) const;
  Draft drafted(Scene scene, const std::string& unconstrained = "") const;
  Draft drafted_change(const Scene& before, const Scene& changed) const;
  void check_stages() const;
  void check_start(Draft draft, const StagedScene& stage) const;
  std::unique_ptr<assembly::System> make_system(Draft draft) const;

  /// State at the beginning of a step.
  struct Beginning {
    fields::BlockVector x;
    std::vector<View<Real**>> histories;
    assembly::System::Memory memory;
    Real time;
  };
  solve::StepReport advance(Real t);
  void start_solver();
  void replace(std::unique_ptr<assembly::System> system, fields::BlockVector x);
  Beginning beginning();

  ModuleFactory more_modules_;
  Scene scene_;
  RCP<const mesh::Mesh> whole_mesh_;  ///< including excavated regions
  RCP<base::Timers> timers_;
  std::unique_ptr<assembly::System> system_;
  std::unique_ptr<solve::Newton> newton_;
  std::unique_ptr<solve::TimeStepper> stepper_;
  fields::BlockVector x_;
  Real time_ = 0;
  int n_changes_ = 0;
  std::vector<mesh::MeshChange> mesh_changes_;  ///< of all calls of change_mesh()
  std::vector<std::array<Real, 2>> without_room_;
  std::optional<Beginning> beginning_;  // of the last step
};

/// Makes the modules of a scene, which together form its equation system. Collective.
physics::Modules make_modules(const Scene& scene, const mesh::Mesh& mesh);

}  // namespace sprekk::model
