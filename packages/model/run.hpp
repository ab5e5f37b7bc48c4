// Complete run of a scene file.
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
  bool restart = false;                ///< continue from the last checkpoint in the output directory
  bool prints_log = false;             ///< print the log to the standard output too, not only to log.txt
  bool reserved = false;               ///< the caller prevents other runs in the directory
  bool strict = false;  ///< treat warnings of the scene as errors, and require the tolerances of Accuracy
  /// Stop function, may be empty. It is called on every rank in each Newton iteration and after each step; true on any
  /// rank ends the run.
  std::function<bool()> should_stop;
};

/// Version of Sprekk, such as "0.1.0".
std::string version();

/// Returns output/NAME of the scene in the current directory, followed by the overrides, so each variant has its own
/// directory. Each override is appended as -PATH=VALUE. Characters other than letters, digits and .=+- become _. If the
/// name is long, or if it loses other characters than blanks, a checksum of the overrides is appended.
std::string default_directory(const RunOptions& options);

enum class Ending {
  completed,
  inaccurate,  ///< completed, but the tolerances of Accuracy are not met
  failed,      ///< a step did not converge
  interrupted  ///< should_stop returned true before the end of the last step
};

/// Runs the scene from its beginning or from a checkpoint and writes the results. With the section Accuracy, the run is
/// repeated on finer meshes; each run replaces the previous results. The log is written to log.txt line by line,
/// warnings also to the standard error. A step that does not converge is reported; the results of earlier steps remain.
/// An interrupted run ends after its last complete step, with a checkpoint if the scene has checkpoints. Throws an
/// Error, the same on every rank, for invalid input and for files that cannot be written. A directory used by another
/// run is an error too and remains unchanged. Collective.
Ending run(const RunOptions& options, RCP<const Comm> comm);

/// Reads and checks a scene and builds its mesh and equation system, without computation. Prints the warnings and
/// returns their number. Throws like run(). Collective.
std::size_t check(const RunOptions& options, RCP<const Comm> comm);

/// Describes the content of a gmsh file; the named physical groups are fractures. Not collective.
std::string mesh_info(const std::string& path, const std::vector<std::string>& fractures);

/// Returns all parameters of a scene, as Markdown.
std::string reference();

/// Returns all parameters of a scene, as JSON; see base::to_json().
std::string specification();

/// Returns a RELAX NG schema of scenes, also for read_point_scene().
std::string schema();

}  // namespace sprekk::model
