// Output of JSON files.
#pragma once

#include "io/file.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace sprekk::io {

/// Writes `json` to `path` on rank 0, indented. A double is reproduced exactly when read; NaN and infinities become
/// null. The file is complete or unchanged. Throws an Error with the path on every rank. Collective.
void write_json(const Comm& comm, const std::string& path, const nlohmann::json& json);

/// Writes `json` without indentation into the disk space of the existing file. Returns false if the file is too short,
/// or on any error. If the program is killed during the call, the file is damaged. Collective.
bool overwrite_json(const Comm& comm, const std::string& path, const nlohmann::json& json);

}  // namespace sprekk::io
