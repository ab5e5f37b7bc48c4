#include "io/directory_lock.hpp"

#include "base/check.hpp"
#include "base/over_ranks.hpp"
#include "io/file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

namespace sprekk::io {

namespace {

constexpr int max_tries = 100;  // of runs that end simultaneously

/// True if the path still refers to the open file. A process that releases the lock removes the file.
bool is_at(const std::string& path, int descriptor) {
  struct stat open, there;
  return ::fstat(descriptor, &open) == 0 && ::stat(path.c_str(), &there) == 0 && open.st_ino == there.st_ino &&
         open.st_dev == there.st_dev;
}

/// Writes the owner of the lock to the file, if the disk has space.
void sign(int descriptor) {
  char host[256] = "";
  ::gethostname(host, sizeof host - 1);
  const auto text = fmt::format("process {} on {}\n", ::getpid(), host);
  [[maybe_unused]] const bool written =
      ::ftruncate(descriptor, 0) == 0 && ::write(descriptor, text.data(), text.size()) > 0;
}

/// Returns " (process 7 on node3)", or "" if the file has no owner.
std::string holder(int descriptor) {
  char text[300];
  const auto n = ::pread(descriptor, text, sizeof text, 0);
  const std::string words(text, n > 0 ? n : 0);
  return words.compare(0, 8, "process ") == 0 ? fmt::format(" ({})", words.substr(0, words.find('\n'))) : "";
}

}  // namespace

DirectoryLock::DirectoryLock(RCP<const Comm> comm, std::string directory)
    : comm_(std::move(comm)), directory_(std::move(directory)), file_(directory_ + "/.lock") {}

DirectoryLock::~DirectoryLock() {
  if (descriptor_ < 0) return;
  if (is_at(file_, descriptor_)) ::unlink(file_.c_str());
  ::close(descriptor_);
}

bool DirectoryLock::has_directory() const {
  std::error_code none;
  const int found = comm_->getRank() == 0 && std::filesystem::is_directory(directory_, none);
  return base::of_rank(*comm_, 0, found) != 0;
}

std::string DirectoryLock::take() {
  if (std::exchange(asked_, true)) return "";
  make_directory(*comm_, directory_);
  std::string not_offered;
  base::collectively(*comm_, [&] {
    for (int tries = 0; comm_->getRank() == 0 && tries < max_tries; ++tries) {
      const int file = ::open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
      SPREKK_CHECK(file >= 0, "{}: cannot be written to: {}", directory_, std::generic_category().message(errno));
      const int error = ::flock(file, LOCK_EX | LOCK_NB) == 0 ? 0 : errno;
      if (error == 0 && is_at(file_, file)) {
        sign(descriptor_ = file);
        return;
      }
      const std::string other = holder(file);
      ::close(file);
      SPREKK_CHECK(error != EWOULDBLOCK,
                   "{}: another run{} is writing its results here; wait until it has ended, or name another directory "
                   "by --output",
                   directory_, other);
      if (error != 0) {
        not_offered = std::generic_category().message(error);
        return;
      }
    }
    if (comm_->getRank() == 0) not_offered = "the file that was locked is another one than its name leads to";
  });
  return base::of_rank(*comm_, 0, not_offered);
}

}  // namespace sprekk::io
