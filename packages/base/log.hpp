// Log of a run.
#pragma once

#include <fmt/format.h>

#include <fstream>
#include <string>

#include "base/types.hpp"

namespace sprekk::base {

/// Writes lines of text on rank 0 of a communicator; calls on other ranks have no effect. Each line is flushed to its
/// stream and to the file. open() and check_file() are collective, the other members are not.
class Log {
 public:
  /// Prints to the standard output if `prints`, and warnings to the standard error.
  Log(const Comm& comm, bool prints);
  /// Prints to `out` unless it is null, and warnings to `warnings`.
  Log(const Comm& comm, std::ostream* out, std::ostream& warnings);

  /// Opens the log file and writes all earlier lines to it. `append` preserves its content; otherwise the file is
  /// overwritten. A second call has no effect. Throws as check_file(). Collective.
  void open(const std::string& path, bool append);
  /// Throws an Error on every rank if a line could not be written to the file, with its path and the system's reason.
  /// Collective.
  void check_file() const;

  template <class... Args>
  void info(fmt::format_string<Args...> format, Args&&... args) {
    if (writes_) line(out_, fmt::format(format, std::forward<Args>(args)...));
  }
  template <class... Args>
  void warning(fmt::format_string<Args...> format, Args&&... args) {
    if (writes_) line(warnings_, "warning: " + fmt::format(format, std::forward<Args>(args)...));
  }
  /// Writes the message of an exception to the file only; the caller prints it.
  void error(const std::string& message) {
    if (writes_) line(nullptr, "error: " + message);
  }

 private:
  void line(std::ostream* to, const std::string& text);
  void write(const std::string& text);

  const Comm& comm_;
  std::ostream *out_, *warnings_;
  bool writes_;               ///< on this rank
  std::string path_, early_;  ///< early_: lines before the file is opened
  std::ofstream file_;
  int error_ = 0;  ///< errno of the first error of the file
};

}  // namespace sprekk::base
