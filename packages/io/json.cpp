#include "io/json.hpp"

#include "base/check.hpp"
#include "base/over_ranks.hpp"

#include <nlohmann/json.hpp>

namespace sprekk::io {

void write_json(const Comm& comm, const std::string& path, const nlohmann::json& json) {
  base::collectively(comm, [&] {
    if (comm.getRank() == 0)
      write_file(path, json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + '\n');
  });
}

bool overwrite_json(const Comm& comm, const std::string& path, const nlohmann::json& json) {
  const int done = comm.getRank() == 0 &&
                   overwrite(path, json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + '\n');
  return base::of_rank(comm, 0, done) != 0;
}

}  // namespace sprekk::io
