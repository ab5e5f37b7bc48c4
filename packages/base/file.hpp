// Input files, read without trust.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace sprekk::base {

/// The content of the file at `path`, which should be `kind`, e.g. "an XML file". Before all of it is read,
/// `check_start` may refuse its first 4096 bytes, so that a wrong file costs no memory. Throws an Error that names the
/// file if there is none, if it is a folder or no regular file (reading which may never end), cannot be read, or is
/// larger than `limit` bytes or than the memory of this machine. Not collective.
std::string read_file(const std::string& path, const std::string& kind, std::size_t limit,
                      const std::function<void(std::string_view)>& check_start);

}  // namespace sprekk::base
