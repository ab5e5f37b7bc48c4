// A scene file run from beginning to end.
#pragma once

#include "base/types.hpp"

#include <functional>
#include <string>
#include <vector>

namespace sprekk::model {

struct RunOptions {
  std::string scene;                   ///< path of the XML file
  std::string output;                  ///< directory; empty: output/NAME of the scene, under the current directory
  std::vector<std::string> overrides;  ///< "Path.To.Entry=value"
  bool restart = false;                ///< go on from the last checkpoint in the output directory
  bool terminal = false;               ///< print a line per time step
  std::function<bool()> should_stop;   ///< if not empty: asked on every rank after each step; true on any ends the run
};

enum class Ending {
  completed,
  failed,      ///< a step did not converge
  interrupted  ///< should_stop said so before the last step
};

/// Runs the scene, from its beginning or from a checkpoint, and writes its results. A step that did not converge is
/// reported, and what was computed before is kept. An interrupted run writes a checkpoint if the scene asks for any.
/// Throws an Error for bad input, the same on every rank. Collective.
Ending run(const RunOptions& options, RCP<const Comm> comm);

/// Reads and checks a scene, builds its mesh and its equation system, and computes nothing. Throws like run().
/// Collective.
void check(const RunOptions& options, RCP<const Comm> comm);

/// What is in a gmsh file, with the named physical groups as fractures. Not collective.
std::string mesh_info(const std::string& path, const std::vector<std::string>& fractures);

/// All parameters of a scene, as Markdown.
std::string reference();

/// A RELAX NG schema of scenes, those of read_point_scene included.
std::string schema();

}  // namespace sprekk::model
