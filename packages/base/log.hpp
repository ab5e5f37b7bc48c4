// The log of a run.
#pragma once

#include <fmt/format.h>

#include <fstream>
#include <string>

#include "base/types.hpp"

namespace sprekk::base {

/// Lines of text from rank 0 of a communicator; calls on other ranks write nothing. Each line is flushed to its stream
/// and to the file. open() and check_file() are collective, the other members are not.
class Log {
 public:
  /// Prints to the standard output, or not at all, and warnings to the standard error.
  Log(const Comm& comm, bool prints);
  /// Prints to `out`, unless it is null, and warnings to `warnings`.
  Log(const Comm& comm, std::ostream* out, std::ostream& warnings);

  /// Writes all lines to this file, those before this call included: after its content with `append`, else in place of
  /// it. A second call does nothing. Collective; Error as of check_file().
  void open(const std::string& path, bool append);
  /// Error, the same on every rank: a line could not be written to the file; path and the system's reason. Collective.
  void check_file() const;

  template <class... Args>
  void info(fmt::format_string<Args...> format, Args&&... args) {
    if (writes_) line(out_, fmt::format(format, std::forward<Args>(args)...));
  }
  template <class... Args>
  void warning(fmt::format_string<Args...> format, Args&&... args) {
    if (writes_) line(warnings_, "warning: " + fmt::format(format, std::forward<Args>(args)...));
  }
  /// To the file only: the message of an exception, which the caller prints.
  void error(const std::string& message) {
    if (writes_) line(nullptr, "error: " + message);
  }

 private:
  void line(std::ostream* to, const std::string& text);
  void write(const std::string& text);

  const Comm& comm_;
  std::ostream *out_, *warnings_;
  bool writes_;               ///< on this rank
  std::string path_, early_;  ///< early_: the lines before there is a file
  std::ofstream file_;
  int error_ = 0;  ///< the system's number of the first error of the file
};

}  // namespace sprekk::base
