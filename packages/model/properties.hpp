// What the materials of a scene give the entities of a mesh.
#pragma once

#include "fields/layout.hpp"
#include "model/scene.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace sprekk::model {

inline int index_of(const std::vector<std::string>& names, const std::string& name) {
  return static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
}

/// The different values of a property, and which of them each entity has; no list of numbers where the group of an
/// entity (region, fracture) tells.
template <class T>
struct Properties {
  std::vector<T> values;
  std::vector<int> number;
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

/// What `find` finds of a material; its errors get the place of the material in the scene.
template <class Find>
auto at_place(const Scene& scene, const Material& material, const Find& find) {
  try {
    return find();
  } catch (const Error& error) {
    const auto is_it = [&](const auto& one) { return &one.second == &material; };
    const auto found = std::find_if(scene.materials.begin(), scene.materials.end(), is_it);
    throw Error(fmt::format("{}: Sprekk > Materials > {}: {}", scene.origin, found->first, error.what()));
  }
}

/// Of local cells.
Properties<laws::Elasticity> elasticity(const Scene& scene, const mesh::Mesh& mesh);

/// Young's, Pa. Collective.
Real largest_modulus(const Scene& scene, const mesh::Mesh& mesh);

/// The values of local entities from those of owned ones. Collective.
std::vector<Real> with_ghosts(const mesh::Mesh& mesh, fields::Entity entity, const std::vector<Real>& owned);

}  // namespace sprekk::model
