// Files and directories as a parallel program writes them: complete or not at all, and every rank learns of an error.
#pragma once

#include "base/types.hpp"

#include <string>

namespace sprekk::io {

/// Writes `content` to a file beside `path` and renames it, so that `path` never holds half a file. Not collective.
/// Error: the path and the system's reason; the file beside is removed and an earlier `path` stays as it was.
void write_file(const std::string& path, const std::string& content);

/// Makes the file its first `length` bytes, 0 if there is none, and then `content`, and brings it to the disk. Not
/// collective. Error: the path and the system's reason; the first `length` bytes stay.
void append_durably(const std::string& path, long long length, const std::string& content);

/// Replaces the content of a file that has at least this length, in place and without a file beside it, as on a disk
/// that is full; false if it is shorter, or on any error. Not collective.
bool overwrite(const std::string& path, const std::string& content);

/// Returns when a file's content, or a directory's names, would outlive a failure of power; at once for a directory
/// that the file system cannot bring to the disk by itself. Not collective; Error: the path and the system's reason.
void bring_to_disk(const std::string& path);

/// Makes the directory with its parents; one that exists is fine. Collective, with the same error on every rank.
void make_directory(const Comm& comm, const std::string& path);

}  // namespace sprekk::io
