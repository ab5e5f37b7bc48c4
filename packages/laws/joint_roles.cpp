#include "laws/joint_roles.hpp"

#include "laws/conduit.hpp"
#include "laws/joint.hpp"

#include <algorithm>
#include <type_traits>

namespace sprekk::laws {

namespace {

template <class K, class = void>
constexpr bool is_flat = false;
template <class K>
constexpr bool is_flat<K, std::void_t<decltype(K::flat)>> = K::flat;

template <class K>
Kind kind() {
  Kind result{K::name, K::meaning, is_flat<K>, {}, {}};
  const auto parameters = K::parameters();
  for (const auto& parameter : parameters) {
    const auto same = [&](const auto& other) { return other.number == parameter.number; };
    result.entries.push_back(parameter.entry);
    result.number.push_back(
        static_cast<int>(std::find_if(parameters.begin(), parameters.end(), same) - parameters.begin()));
  }
  return result;
}

template <class... Ks>
std::vector<Kind> kinds(const Kinds<Ks...>&) {
  return {kind<Ks>()...};
}

}  // namespace

std::vector<std::string> Role::names() const {
  std::vector<std::string> all;
  for (const auto& one : kinds) all.push_back(one.name);
  return all;
}

const Kind* Role::kind_of(const JointMaterial& material) const {
  for (const auto& one : kinds)
    if (one.name == material.*chosen) return &one;
  return nullptr;
}

std::vector<Entry> Role::entries() const {
  std::vector<Entry> all;
  for (const auto& one : kinds)
    for (const auto& entry : one.entries)
      if (std::none_of(all.begin(), all.end(), [&](const auto& other) { return other.name == entry.name; }))
        all.push_back(entry);
  return all;
}

std::vector<std::string> Role::kinds_with(const std::string& entry) const {
  std::vector<std::string> with;
  for (const auto& one : kinds)
    for (const auto& other : one.entries)
      if (other.name == entry) with.push_back(one.name);
  return with;
}

std::vector<std::string> Role::kinds_that_need(const std::string& entry) const {
  std::vector<std::string> needed;
  for (const auto& one : kinds)
    for (std::size_t k = 0; k < one.entries.size(); ++k)
      if (one.entries[k].name == entry && std::count(one.number.begin(), one.number.end(), one.number[k]) == 1 &&
          !one.entries[k].optional && !one.entries[k].otherwise)
        needed.push_back(one.name);
  return needed;
}

const std::vector<Role>& roles() {
  static const std::vector<Role> all = {
      {"tangential elasticity", "law of the elastic part of the tangential jump", &JointMaterial::tangential_elasticity,
       kinds(ShearKinds())},
      {"friction", "friction law, the bound on the shear traction", &JointMaterial::friction, kinds(FrictionKinds())},
      {"dilation", "dilation law, the opening by slip", &JointMaterial::dilation, kinds(DilationKinds())},
      {"closure", "closure law, the normal closure under compression", &JointMaterial::closure, kinds(ClosureKinds())},
      {"bond", "bond law, the cohesion and tensile strength in addition to friction", &JointMaterial::bond,
       kinds(BondKinds())},
      {"damage", "damage law, the wear of friction and dilation", &JointMaterial::damage, kinds(DamageKinds())},
      {"damage driver", "driver of damage, per unit of slip", &JointMaterial::damage_driver, kinds(DriverKinds())},
      {"hydraulic aperture", "hydraulic aperture law, the aperture for flow in the fracture, with \"Flow\"",
       &JointMaterial::hydraulic_aperture, kinds(ApertureKinds())}};
  return all;
}

const Entry* entry_of(const Kind& kind, const std::string& name) {
  for (const auto& entry : kind.entries)
    if (entry.name == name) return &entry;
  return nullptr;
}

}  // namespace sprekk::laws
