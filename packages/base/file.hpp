// Input files with checks of their kind and size.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace sprekk::base {

/// Returns the content of the file at `path`. `kind` describes the expected kind in messages, e.g. "an XML file".
/// `check_start` receives the first 4096 bytes before the rest is read and may throw, so a wrong file costs no memory.
/// Throws an Error with the path if the file does not exist, is not a regular file or is unreadable, or is larger than
/// `limit` bytes or the memory of this machine. Not collective.
std::string read_file(const std::string& path, const std::string& kind, std::size_t limit,
                      const std::function<void(std::string_view)>& check_start);

}  // namespace sprekk::base
