// Material properties of mesh entities.
#pragma once

#include "fields/layout.hpp"

#include <vector>

namespace sprekk::fields {

/// Distinct values of a property, and the number of the value of each entity. Without numbers, the group of an entity
/// (region, fracture) selects its value.
template <class T>
struct Properties {
  std::vector<T> values;
  std::vector<int> number = {};

  int number_of(int entity, int group) const { return number.empty() ? group : number[entity]; }
  const T& of(int entity, int group) const { return values[number_of(entity, group)]; }
  /// Value of a local cell, if groups are regions.
  const T& of_cell(const mesh::Mesh& mesh, LocalIndex cell) const { return of(cell, mesh.cell_region[cell]); }
  /// Value of a fracture face, if groups are fractures.
  const T& of_face(const mesh::Mesh& mesh, LocalIndex face) const {
    return of(face, mesh.fracture_faces[face].fracture);
  }
};

/// Collects a property. `uniform(group)`: one value holds in the whole group. `at(group, entity)`: the value at the
/// position of the entity; entity -1 in uniform groups.
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

/// Values of local entities from those of owned entities. Collective.
std::vector<Real> with_ghosts(const mesh::Mesh& mesh, Entity entity, const std::vector<Real>& owned);
/// Does the same for the components of a layout, [entity * components + component].
std::vector<Real> with_ghosts(const Layout& layout, const std::vector<Real>& owned);

}  // namespace sprekk::fields
