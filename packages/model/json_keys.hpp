// Keys of results.json.
#pragma once

#include <algorithm>
#include <string>

namespace sprekk::model {

inline std::string with_underscores(std::string name) {
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
}

}  // namespace sprekk::model
