// A joint for every combination of laws.
#pragma once

#include "laws/joint.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace sprekk::device {

/// Returns the value of an entry of a rock joint. A law with an unknown entry gives an error.
inline Real entry(const std::string& name) {
  static const std::map<std::string, Real> values = {{"asperity angle", 6},
                                                     {"asperity damage coefficient", 2},
                                                     {"asperity friction coefficient", 0.2},
                                                     {"basic friction coefficient", 0.5},
                                                     {"cohesion", 1e6},
                                                     {"damage length of dilation", 5e-3},
                                                     {"damage length of friction", 5e-3},
                                                     {"direct effect", 0.01},
                                                     {"dilatancy coefficient", 1e-4},
                                                     {"dilation angle", 5},
                                                     {"dilation decay distance", 1e-3},
                                                     {"evolution effect", 0.015},
                                                     {"fracture energy", 100},
                                                     {"friction coefficient", 0.6},
                                                     {"gouge thickness", 1e-3},
                                                     {"initial friction coefficient", 0.7},
                                                     {"initial slip rate", 1e-9},
                                                     {"initial state", 1e4},
                                                     {"irrecoverable part of closure", 0.3},
                                                     {"joint aperture", 2e-4},
                                                     {"joint length", 1},
                                                     {"joint roughness coefficient", 8},
                                                     {"joint wall strength", 100e6},
                                                     {"largest dilation", 1e-4},
                                                     {"largest friction angle", 70},
                                                     {"largest past compression", 0},
                                                     {"loading cycle", 1},
                                                     {"maximum closure", 2e-4},
                                                     {"normal stiffness", 50e9},
                                                     {"opening without cohesion", 2e-5},
                                                     {"peak slip", 2e-3},
                                                     {"radiation damping", 4.41e6},
                                                     {"reference friction coefficient", 0.6},
                                                     {"reference slip rate", 1e-6},
                                                     {"reference stress", 5e6},
                                                     {"residual dilation angle", 1},
                                                     {"residual friction angle", 28},
                                                     {"residual friction coefficient", 0.5},
                                                     {"residual part of dilation", 0.3},
                                                     {"residual part of friction", 0.8},
                                                     {"sample length", 0.1},
                                                     {"shear fracture energy", 1000},
                                                     {"shear stiffening exponent", 0.5},
                                                     {"shear stiffening stress", 5e6},
                                                     {"state evolution distance", 1e-5},
                                                     {"stiffening exponent", 0.5},
                                                     {"stiffening stress", 5e6},
                                                     {"tangential stiffness", 50e9},
                                                     {"tensile strength", 0.5e6},
                                                     {"transition exponent", 1.5},
                                                     {"transition stress", 100e6},
                                                     {"weakening distance", 5e-3}};
  const auto found = values.find(name);
  if (found == values.end()) throw std::runtime_error("tests/device/joints.hpp has no value of \"" + name + "\"");
  return found->second;
}

template <class K>
K with_entries() {
  K law;
  std::vector<Real K::*> done;
  for (const auto& [number, entry] : K::parameters()) {
    bool again = false;  // other entry of the same parameter
    for (const auto& other : done) again = again || other == number;
    if (again) continue;
    done.push_back(number);
    const Real value = device::entry(entry.name);
    law.*number = entry.number_of ? entry.number_of(value) : value;
  }
  if constexpr (requires { law.complete(); }) law.complete();
  return law;
}

template <class Role, class... Ks>
std::vector<Role> all_of(const laws::Kinds<Ks...>&) {
  return {Role(with_entries<Ks>())...};
}

inline std::vector<laws::Joint> all_joints() {
  std::vector<laws::Joint> joints;
  for (const auto& shear : all_of<laws::Shear>(laws::ShearKinds()))
    for (const auto& friction : all_of<laws::Friction>(laws::FrictionKinds()))
      for (const auto& dilation : all_of<laws::Dilation>(laws::DilationKinds()))
        for (const auto& closure : all_of<laws::Closure>(laws::ClosureKinds()))
          for (const auto& bond : all_of<laws::Bond>(laws::BondKinds()))
            for (const auto& damage : all_of<laws::Damage>(laws::DamageKinds()))
              for (const auto& driver : all_of<laws::Driver>(laws::DriverKinds()))
                joints.push_back({shear, friction, {0, dilation, closure}, bond, damage, driver});
  return joints;
}

template <class... Ks>
constexpr int max_history(laws::Kinds<Ks...>*, int dim) {
  return std::max({(dim == 2 ? laws::history_size_2d<Ks> : laws::history_size<Ks>)...});
}
template <class Role>
constexpr int max_history(int dim = 3) {
  return max_history(static_cast<Role*>(nullptr), dim);
}

/// Largest number of history variables of a face.
template <int dim>
constexpr int n_saved =
    max_history<laws::DilationKinds>() + max_history<laws::ClosureKinds>() + max_history<laws::FrictionKinds>() +
    max_history<laws::ShearKinds>() + max_history<laws::BondKinds>() + max_history<laws::DamageKinds>(dim);

/// Returns a joint with Coulomb friction, constant dilation angle and hyperbolic closure, as in most scenes.
inline laws::Joint common_joint() {
  return {with_entries<laws::LinearShear>(),
          with_entries<laws::CoulombFriction>(),
          {0, with_entries<laws::ConstantDilation>(), with_entries<laws::BartonBandisClosure>()}};
}

}  // namespace sprekk::device
