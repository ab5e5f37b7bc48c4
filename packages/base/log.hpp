// What a run says on its way.
#pragma once

#include <fmt/format.h>

#include <iostream>
#include <string>

#include "base/types.hpp"

namespace sprekk::base {

/// Lines of text from rank 0 of a communicator; calls on other ranks print nothing. Not collective.
class Log {
 public:
  enum class Level { quiet, normal };  ///< quiet prints warnings only

  /// Prints to the standard output, warnings to the standard error.
  explicit Log(const Comm& comm, Level level = Level::normal);
  /// Prints to `out`, with progress lines if it is a terminal, and warnings to `warnings`.
  Log(const Comm& comm, Level level, std::ostream& out, std::ostream& warnings, bool terminal);

  template <class... Args>
  void info(fmt::format_string<Args...> format, Args&&... args) {
    if (talks()) line(*out_, fmt::format(format, std::forward<Args>(args)...));
  }
  template <class... Args>
  void warning(fmt::format_string<Args...> format, Args&&... args) {
    if (out_) line(*warnings_, "warning: " + fmt::format(format, std::forward<Args>(args)...));
  }
  /// A line that the next output replaces; on terminals only.
  template <class... Args>
  void progress(fmt::format_string<Args...> format, Args&&... args) {
    if (talks() && terminal_) replaceable(fmt::format(format, std::forward<Args>(args)...));
  }

  bool is_terminal() const { return terminal_; }

 private:
  bool talks() const { return out_ && level_ == Level::normal; }
  void line(std::ostream& to, const std::string& text);
  void replaceable(const std::string& text);
  void clear();

  std::ostream *out_, *warnings_;  ///< null on ranks that print nothing
  Level level_;
  bool terminal_, pending_ = false;
};

}  // namespace sprekk::base
