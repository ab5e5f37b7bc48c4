// What the materials of a scene give the entities of a mesh.
#pragma once

#include "fields/layout.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace sprekk::physics {

/// The number of a name; how many there are, if it is none of them.
inline int index_of(const std::vector<std::string>& names, const std::string& name) {
  return static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
}

/// The different values of a property, and which of them each entity has; no list of numbers where the group of an
/// entity (region, fracture) tells.
template <class T>
struct Properties {
  std::vector<T> values;
  std::vector<int> number = {};

  const T& of(int entity, int group) const { return values[number.empty() ? group : number[entity]]; }
  /// Of a local cell, where groups are regions.
  const T& of_cell(const mesh::Mesh& mesh, LocalIndex cell) const { return of(cell, mesh.cell_region[cell]); }
};

/// `uniform` and `at(group, entity)` tell of a group whether one value holds everywhere, and the value at an entity's
/// place.
template <class T, class Uniform, class At>
Properties<T> properties(int n_groups, const std::vector<int>& group_of, const Uniform& uniform, const At& at) {
  Properties<T> result;
  bool all_uniform = true;
  for (int group = 0; group < n_groups; ++group) {
    all_uniform = all_uniform && uniform(group);
    result.values.push_back(uniform(group) ? at(group, -1) : T());
  }
  if (all_uniform) return result;
  for (int entity = 0; entity < static_cast<int>(group_of.size()); ++entity) {
    const int group = group_of[entity];
    result.number.push_back(uniform(group) ? group : static_cast<int>(result.values.size()));
    if (!uniform(group)) result.values.push_back(at(group, entity));
  }
  return result;
}

/// The values of local entities from those of owned ones. Collective.
std::vector<Real> with_ghosts(const mesh::Mesh& mesh, fields::Entity entity, const std::vector<Real>& owned);
/// Likewise with the components of a layout, [entity * components + component].
std::vector<Real> with_ghosts(const fields::Layout& layout, const std::vector<Real>& owned);

}  // namespace sprekk::physics
