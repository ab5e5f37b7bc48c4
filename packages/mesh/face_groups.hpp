// Physical groups of faces inside the mesh. The scene lists some of them as fractures.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "base/types.hpp"

namespace sprekk::mesh {

/// Face inside the mesh: its element in the file, for messages, and its groups.
struct InnerFace {
  std::string element;
  std::set<std::string> groups;
};

/// Inner faces by face number. A face may have several groups. Exactly one must be a fracture; its other groups are
/// ignored.
using InnerFaces = std::map<GlobalIndex, InnerFace>;

/// Returns an error message if a face is in two of the `fractures` or in none, with advice for a correct list. Returns
/// an empty text if each face is in exactly one fracture.
std::string wrong_fractures(const InnerFaces& faces, const std::vector<std::string>& fractures,
                            const std::vector<std::string>& boundaries);

}  // namespace sprekk::mesh
