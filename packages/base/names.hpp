// Lists of names.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace sprekk::base {

/// Index of a name; the number of names if it is missing.
inline int index_of(const std::vector<std::string>& names, const std::string& name) {
  return static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
}

}  // namespace sprekk::base
