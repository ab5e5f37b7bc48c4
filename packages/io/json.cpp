#include "io/json.hpp"

#include "base/check.hpp"

#include <nlohmann/json.hpp>

namespace sprekk::io {

void write_json(const Comm& comm, const std::string& path, const nlohmann::json& json) {
  base::collectively(comm, [&] {
    if (comm.getRank() == 0)
      write_file(path, json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + '\n');
  });
}

}  // namespace sprekk::io
