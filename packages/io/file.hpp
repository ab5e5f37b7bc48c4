// Files and directories of a parallel program. Files are complete or unchanged, and errors are reported.
#pragma once

#include "base/types.hpp"

#include <string>

namespace sprekk::io {

/// Writes `content` to a temporary file and renames it to `path`, so that `path` is always complete. Throws an Error
/// with the path and the system's reason; then the temporary file is removed and `path` is unchanged. Not collective.
void write_file(const std::string& path, const std::string& content);

/// Truncates the file to its first `length` bytes, appends `content`, and flushes it to disk. A missing file requires
/// length 0. Throws an Error with the path and the system's reason; the first `length` bytes are preserved. Not
/// collective.
void append_durably(const std::string& path, long long length, const std::string& content);

/// Replaces the content of a file in place, without a temporary file, for instance on a full disk. The file must be at
/// least as long as `content`. Returns false if it is shorter, or on any error. Not collective.
bool overwrite(const std::string& path, const std::string& content);

/// Flushes the content of a file, or the names in a directory, to disk so that they survive a power failure. No effect
/// on a directory if the file system does not support this. Throws an Error with the path and the system's reason. Not
/// collective.
void flush_to_disk(const std::string& path);

/// Creates the directory and its parents; it may already exist. Throws the same Error on every rank. Collective.
void make_directory(const Comm& comm, const std::string& path);

}  // namespace sprekk::io
