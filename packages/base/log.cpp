#include "base/log.hpp"

#include <cerrno>
#include <iostream>
#include <system_error>
#include <utility>

#include "base/check.hpp"

namespace sprekk::base {

Log::Log(const Comm& comm, bool prints) : Log(comm, prints ? &std::cout : nullptr, std::cerr) {}

Log::Log(const Comm& comm, std::ostream* out, std::ostream& warnings)
    : comm_(comm), out_(out), warnings_(&warnings), writes_(comm.getRank() == 0) {}

void Log::open(const std::string& path, bool append) {
  if (!path_.empty()) return;
  path_ = path;
  if (writes_) {
    file_.open(path, append ? std::ios::app : std::ios::trunc);
    write(std::exchange(early_, {}));
  }
  check_file();
}

void Log::check_file() const {
  collectively(comm_, [&] {
    SPREKK_CHECK(error_ == 0, "{}: cannot be written: {}", path_, std::generic_category().message(error_));
  });
}

void Log::line(std::ostream* to, const std::string& text) {
  if (path_.empty())
    early_ += text + '\n';
  else
    write(text + '\n');  // before the stream, so a visible line is also in the file
  if (to) *to << text << std::endl;
}

void Log::write(const std::string& text) {
  if (error_ != 0) return;
  file_ << text << std::flush;
  if (!file_) error_ = errno != 0 ? errno : EIO;
}

}  // namespace sprekk::base
