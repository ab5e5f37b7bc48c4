// Results as JSON.
#pragma once

#include "io/file.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace sprekk::io {

/// Rank 0 writes `json` to `path`, indented; every double reads back to the same bits, NaN and infinities become null.
/// The file is complete or untouched. Collective; Error on every rank, naming the path.
void write_json(const Comm& comm, const std::string& path, const nlohmann::json& json);

}  // namespace sprekk::io
