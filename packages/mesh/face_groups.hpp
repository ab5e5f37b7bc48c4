// Physical groups of faces inside of a mesh, of which a scene lists some as fractures.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "base/types.hpp"

namespace sprekk::mesh {

/// A face inside of a mesh: the element of the file that it is, for messages, and the groups that it is in.
struct InnerFace {
  std::string element;
  std::set<std::string> groups;
};

/// By faces. Each may be in several groups, of which one is a fracture; other groups do not count there.
using InnerFaces = std::map<GlobalIndex, InnerFace>;

/// The error in the choice of `fractures`, and a right choice: a face in two of them, or in none. Empty if
/// each face is in one.
std::string wrong_fractures(const InnerFaces& faces, const std::vector<std::string>& fractures,
                            const std::vector<std::string>& boundaries);

}  // namespace sprekk::mesh
