// A scene: everything that a run needs to know, as the XML file or a host application gives it.
#pragma once

#include "base/parameters.hpp"
#include "mesh/bisect.hpp"
#include "mesh/box.hpp"
#include "mesh/mesh.hpp"
#include "model/accuracy.hpp"
#include "model/network.hpp"
#include "model/stages.hpp"
#include "physics/scene.hpp"
#include "solve/newton.hpp"
#include "solve/time_stepping.hpp"

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sprekk::model {

using physics::BoundaryCondition;
using physics::Bulk;
using physics::Fracture;
using physics::Material;
using physics::Region;

/// A mesh from a file of gmsh instead of a box.
struct MeshFile {
  struct Fracture {
    std::optional<std::vector<Real>> reference_normal;
    bool swap_sides = false;
    void describe(base::Section& section);
  };
  std::string path;                           ///< relative to the scene's file; of a host, to the current directory
  std::optional<Network> network;             ///< that the mesh was made of; its sets are fractures
  std::optional<int> order;                   ///< of the cells, 1 or 2; absent: as in the file
  int refinements = 0;                        ///< see mesh::describe_refinements()
  std::string tips = "enriched";              ///< see mesh::describe_tips()
  std::vector<std::string> periodic;          ///< boundaries in pairs, see mesh::tie_periodic()
  std::map<std::string, Fracture> fractures;  ///< the physical groups that are fractures
  void describe(base::Section& section);
};

struct Time {
  Real start = 0, end = 1;
  std::optional<int> steps;  ///< absent: one, if their length is not chosen
  std::optional<std::vector<Real>> schedule;
  std::optional<Real> tolerance;         ///< of relative errors, by which lengths of steps are chosen
  std::optional<int> newton_iterations;  ///< of a step, likewise
  std::optional<Real> first_step, smallest_step, largest_step;
  std::string scheme = "implicit Euler";  ///< or BDF2, of rates of what is stored
  solve::TimeSteppingOptions stepping;
  void describe(base::Section& section);
  bool chooses_steps() const { return tolerance || newton_iterations; }
  std::vector<Real> times() const;  ///< the ends of all steps; if their length is chosen, of those that must be met

 private:
  void describe_choice(base::Section& section) const;
};

/// When a run writes a checkpoint: whatever comes first, and after the last step.
struct CheckpointTimes {
  std::optional<int> steps;
  std::optional<Real> minutes;  ///< of the wall clock
  void describe(base::Section& section);
};

struct Output {
  bool vtu = true;
  int every = 1;  ///< steps
  bool error_estimate = false;
  std::string time_unit = "s";  ///< of tables and pictures
  std::optional<CheckpointTimes> checkpoints;
  void describe(base::Section& section);
};

struct Scene : physics::Scene {
  mesh::BoxMesh mesh;
  std::optional<MeshFile> mesh_file;  ///< used instead of `mesh` if it is there
  Time time;
  solve::NewtonOptions solver;
  Output output;
  Stages stages;
  std::optional<Accuracy> accuracy;
  /// With `accuracy`: the mesh as it has been halved so far, on the rank that makes it. Null, or empty: not yet.
  std::shared_ptr<std::optional<mesh::Bisection>> bisection;

  void describe(base::Section& section);
  /// The global mesh of either kind; if it is to be refined, as refined() takes it; halved as far as `bisection` is.
  /// Not collective.
  mesh::GlobalMesh make_mesh() const;
  /// What is left to do once make_mesh() has been distributed: refinement, and what comes after it. Collective.
  RCP<const mesh::Mesh> refined(RCP<const mesh::Mesh> mesh) const;
  mesh::GlobalMesh read_mesh() const;  ///< without what is done about crack tips
  int refinements() const;             ///< of the mesh that is used
  int order() const;                   ///< that its cells are to have; of a file that does not say, 1
  const std::string& tips() const;     ///< the same

 private:
  void add_default_joints();  ///< to fractures of the mesh that name no material
  void check_accuracy(base::Section& section) const;
  mesh::Bisection bisected() const;  ///< not at all yet
};

/// The scene as a Model uses it: checked as if it had been read from a file, materials of the library added,
/// expressions made ready; and what is wrong with its entries. What holds for one that was read does not change. Not
/// collective.
base::Draft<Scene> prepared(const Scene& scene);

/// A stage with the scene that it begins.
struct StagedScene {
  std::string name;
  Real time;
  base::Draft<Scene> draft;  ///< `SCENE: stage "NAME"` opens its messages
};

/// All stages of a scene by their times. Not collective.
std::vector<StagedScene> staged_scenes(const Scene& scene);

/// Reads a scene file, applies overrides "Path.To.Entry=value", checks its entries, and makes the expressions ready.
/// Where an entry is wrong, the mesh is made to check the rest as well; throws one Error with a line for each thing
/// that is wrong, see checked_mesh(). So it does for the scenes of its stages, without a mesh. Collective.
Scene read_scene(const Comm& comm, const std::string& path, const std::vector<std::string>& overrides = {});

/// The same of entries as a file would have them: `origin` opens messages, files are looked for in `folder`.
/// Collective.
Scene scene_of(const Comm& comm, Teuchos::ParameterList entries, const std::string& origin, const std::string& folder,
               const std::vector<std::string>& overrides = {});

}  // namespace sprekk::model
