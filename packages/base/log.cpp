#include "base/log.hpp"

#include <unistd.h>

namespace sprekk::base {

Log::Log(const Comm& comm, Level level) : Log(comm, level, std::cout, std::cerr, isatty(STDOUT_FILENO) != 0) {}

Log::Log(const Comm& comm, Level level, std::ostream& out, std::ostream& warnings, bool terminal)
    : out_(comm.getRank() == 0 ? &out : nullptr),
      warnings_(comm.getRank() == 0 ? &warnings : nullptr),
      level_(level),
      terminal_(terminal) {}

void Log::line(std::ostream& to, const std::string& text) {
  clear();
  to << text << std::endl;
}

void Log::replaceable(const std::string& text) {
  clear();
  *out_ << text << std::flush;
  pending_ = true;
}

void Log::clear() {
  if (pending_) *out_ << "\r\x1b[K" << std::flush;  // to the start of the line, and erase it
  pending_ = false;
}

}  // namespace sprekk::base
