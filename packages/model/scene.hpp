// Scene: complete input of a run, from an XML file or a host application.
#pragma once

#include "base/parameters.hpp"
#include "mesh/bisect.hpp"
#include "mesh/box.hpp"
#include "mesh/mesh.hpp"
#include "model/accuracy.hpp"
#include "model/growth.hpp"
#include "model/network.hpp"
#include "model/stages.hpp"
#include "physics/scene.hpp"
#include "solve/newton.hpp"
#include "solve/time.hpp"

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
using solve::Time;

/// Mesh from a gmsh file, instead of a box.
struct MeshFile {
  struct Fracture {
    std::optional<std::vector<Real>> reference_normal;
    bool swap_sides = false;
    void describe(base::Section& section);
  };
  std::string path;                           ///< relative to the scene file; for hosts, to the current directory
  std::optional<Network> network;             ///< network from which the mesh was made; its sets are fractures
  std::optional<int> order;                   ///< order of the cells, 1 or 2; absent: as in the file
  int refinements = 0;                        ///< see mesh::describe_refinements()
  std::string tips = "enriched";              ///< see mesh::describe_tips()
  std::vector<std::string> periodic;          ///< boundaries in pairs, see mesh::tie_periodic()
  std::map<std::string, Fracture> fractures;  ///< physical groups that are fractures
  void describe(base::Section& section);
};

/// Intervals of checkpoints: the first condition met applies; a checkpoint also follows the last step.
struct CheckpointTimes {
  std::optional<int> steps;
  std::optional<Real> minutes;  ///< of wall-clock time
  void describe(base::Section& section);
};

/// Catalogue of events by their rate, see EventCatalogue.
struct EventThreshold {
  Real rate = 1e-3;  ///< m/s
  void describe(base::Section& section);
};

struct Output {
  bool vtu = true;
  int every = 1;  ///< steps
  bool error_estimate = false;
  bool energy = false;          ///< sums of work
  std::string time_unit = "s";  ///< time unit of tables and files for ParaView
  std::optional<CheckpointTimes> checkpoints;
  std::optional<EventThreshold> events;
  void describe(base::Section& section);
};

struct Scene : physics::Scene {
  mesh::BoxMesh mesh;
  std::optional<MeshFile> mesh_file;  ///< used instead of `mesh` if present
  Time time;
  solve::NewtonOptions solver;
  Output output;
  Stages stages;
  std::optional<Accuracy> accuracy;
  std::optional<Growth> growth;
  /// Bisected mesh of `accuracy` or `growth`, on the rank that makes the mesh. Null or empty before the first
  /// bisection.
  std::shared_ptr<std::optional<mesh::Bisection>> bisection;

  void describe(base::Section& section);
  /// Makes the global mesh from a box or a file, bisected as in `bisection`. If uniform refinement follows, the mesh is
  /// prepared for refined(). Not collective.
  mesh::GlobalMesh make_mesh() const;
  /// Completes the distributed mesh of make_mesh(): uniform refinement and the steps after it. Collective.
  RCP<const mesh::Mesh> refined(RCP<const mesh::Mesh> mesh) const;
  mesh::GlobalMesh read_mesh() const;  ///< without the treatment of crack tips
  int refinements() const;             ///< of the mesh in use
  int order() const;                   ///< required order of the cells; 1 if a mesh file does not specify it
  const std::string& tips() const;     ///< of the mesh in use

 private:
  void add_default_joints();  ///< for fractures of the mesh without a material
  void check_accuracy(base::Section& section) const;
  void check_growth(base::Section& section) const;
  mesh::Bisection bisected() const;  ///< initial state, without bisections
};

/// Prepares a scene for a Model: checked as if read from a file, with library materials and compiled expressions. The
/// result contains the list of mistakes. A scene that was read from a file remains unchanged. Not collective.
base::Draft<Scene> prepared(const Scene& scene);

/// Stage with the scene that begins with it.
struct StagedScene {
  std::string name;
  Real time;
  base::Draft<Scene> draft;  ///< prefix of its messages: `SCENE: stage "NAME"`
};

/// Returns all stages of a scene, ordered by time. Not collective.
std::vector<StagedScene> staged_scenes(const Scene& scene);

/// Reads a scene file, applies overrides "Path.To.Entry=value", checks the entries, and compiles the expressions.
/// Throws one Error with a line for each mistake. If an entry is wrong, the mesh is made too for the remaining checks,
/// see checked_mesh(). The scenes of stages are checked in the same way, without a mesh. Collective.
Scene read_scene(const Comm& comm, const std::string& path, const std::vector<std::string>& overrides = {});

/// Builds a scene from entries like those of a file. `origin` is the prefix of messages, `folder` the folder of
/// relative file names. Collective.
Scene scene_of(const Comm& comm, Teuchos::ParameterList entries, const std::string& origin, const std::string& folder,
               const std::vector<std::string>& overrides = {});

}  // namespace sprekk::model
