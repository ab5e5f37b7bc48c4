// Lock of an output directory: one program at a time writes there.
#pragma once

#include "base/types.hpp"

#include <string>

namespace sprekk::io {

/// Lock of a directory. Rank 0 holds it by flock(2) on the file DIRECTORY/.lock. The system releases the lock when the
/// process ends for any reason, so a remaining file does not lock the directory.
class DirectoryLock {
 public:
  DirectoryLock(RCP<const Comm> comm, std::string directory);
  ~DirectoryLock();  ///< removes the file and releases the lock; not collective
  DirectoryLock(const DirectoryLock&) = delete;
  DirectoryLock& operator=(const DirectoryLock&) = delete;

  /// True if the directory exists. Collective.
  bool has_directory() const;

  /// Creates the directory and takes its lock; a second call has no effect. Returns an empty text, or the reason if the
  /// file system does not support locks. Throws an Error with the directory on every rank if another process has the
  /// lock (named in the message), or if the directory cannot be created or written to. Collective.
  std::string take();

 private:
  RCP<const Comm> comm_;
  std::string directory_, file_;
  bool asked_ = false;
  int descriptor_ = -1;
};

}  // namespace sprekk::io
