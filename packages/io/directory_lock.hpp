// One program at a time writes into a directory.
#pragma once

#include "base/types.hpp"

#include <string>

namespace sprekk::io {

/// The lock of a directory, which rank 0 holds by flock(2) on the file DIRECTORY/.lock: the system releases it when the
/// process ends, however it ends, and a file that is left over locks nothing.
class DirectoryLock {
 public:
  DirectoryLock(RCP<const Comm> comm, std::string directory);
  ~DirectoryLock();  ///< removes the file and releases the lock; not collective
  DirectoryLock(const DirectoryLock&) = delete;
  DirectoryLock& operator=(const DirectoryLock&) = delete;

  /// Whether there is a directory to lock. Collective.
  bool has_directory() const;

  /// Makes the directory and takes its lock; the second call does nothing. Returns why the file system offers no locks,
  /// or an empty text. Collective; Error on every rank, naming the directory: another process has the lock, which the
  /// message names, or the directory cannot be made or written to.
  std::string take();

 private:
  RCP<const Comm> comm_;
  std::string directory_, file_;
  bool asked_ = false;
  int descriptor_ = -1;
};

}  // namespace sprekk::io
