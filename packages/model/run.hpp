// A scene file run from beginning to end.
#pragma once

#include "base/types.hpp"

#include <functional>
#include <string>
#include <vector>

namespace sprekk::model {

struct RunOptions {
  std::string scene;                   ///< path of the XML file
  std::string output;                  ///< directory; empty: default_directory()
  std::vector<std::string> overrides;  ///< "Path.To.Entry=value"
  bool restart = false;                ///< go on from the last checkpoint in the output directory
  bool prints_log = false;             ///< print the log to the standard output, as well as to log.txt
  bool reserved = false;               ///< the caller sees to it that no other run writes into the directory
  bool strict = false;                 ///< warnings of the scene are errors, and what Accuracy asks for must be reached
  /// If not empty: asked on every rank in each Newton iteration and after each step; true on any ends the run.
  std::function<bool()> should_stop;
};

/// The version of Sprekk, as "0.1.0".
std::string version();

/// output/NAME of the scene, under the current directory, followed by the overrides, so that each variant has its own:
/// -PATH=VALUE for each, with _ for all but letters, digits and .=+-; and, where that is long or loses more than
/// blanks, a checksum of them.
std::string default_directory(const RunOptions& options);

enum class Ending {
  completed,
  inaccurate,  ///< the same, without what the section Accuracy asks for
  failed,      ///< a step did not converge
  interrupted  ///< should_stop said so before the end of the last step
};

/// Runs the scene, from its beginning or from a checkpoint, and writes its results. With the section Accuracy it
/// repeats the run on finer meshes; each run replaces the results before. The log is written to log.txt line by line,
/// warnings also to the standard error. A step that did not converge is reported; the results of earlier steps remain.
/// An interrupted run ends at its last whole step, with a checkpoint if the scene has checkpoints. Error, the same on
/// every rank: bad input, a file that cannot be written, or a directory in use by another run, which remains untouched.
/// Collective.
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
