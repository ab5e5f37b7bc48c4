#include "io/json.hpp"

#include "base/check.hpp"
#include "base/over_ranks.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace sprekk::io {

namespace {

std::string in_one_line(const nlohmann::json& json) {
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// Appends indented JSON. Arrays without nested structures are on one line, because they may be long.
void append(std::string& text, const nlohmann::json& json, int indent) {
  const auto structured = [](const auto& one) { return one.is_structured(); };
  if (!json.is_structured() || (json.is_array() && std::none_of(json.begin(), json.end(), structured)) ||
      json.empty()) {
    text += in_one_line(json);
    return;
  }
  const std::string begin = '\n' + std::string(indent + 2, ' ');
  bool first = true;
  text += json.is_object() ? '{' : '[';
  for (const auto& [name, value] : json.items()) {
    text += (first ? "" : ",") + begin;
    if (json.is_object()) text += in_one_line(name) + ": ";
    append(text, value, indent + 2);
    first = false;
  }
  text += '\n' + std::string(indent, ' ') + (json.is_object() ? '}' : ']');
}

}  // namespace

void write_json(const Comm& comm, const std::string& path, const nlohmann::json& json) {
  base::collectively(comm, [&] {
    if (comm.getRank() != 0) return;
    std::string text;
    append(text, json, 0);
    write_file(path, text + '\n');
  });
}

bool overwrite_json(const Comm& comm, const std::string& path, const nlohmann::json& json) {
  const int done = comm.getRank() == 0 && overwrite(path, in_one_line(json) + '\n');
  return base::of_rank(comm, 0, done) != 0;
}

}  // namespace sprekk::io
