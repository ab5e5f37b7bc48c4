// Results as JSON.
#pragma once

#include "io/file.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace sprekk::io {

/// Rank 0 writes `json` to `path`, indented; every double reads back to the same bits, NaN and infinities become null.
/// The file is complete or untouched. Collective; Error on every rank, naming the path.
void write_json(const Comm& comm, const std::string& path, const nlohmann::json& json);

/// The same into the room that the file has on the disk, without indentation; false if it has too little, or on any
/// error. Killed meanwhile, the program leaves a damaged file. Collective.
bool overwrite_json(const Comm& comm, const std::string& path, const nlohmann::json& json);

}  // namespace sprekk::io
