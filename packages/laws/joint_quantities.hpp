// What the laws of a joint tell of a face, by name.
#pragma once

#include "laws/joint.hpp"

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

namespace sprekk::laws {

/// As a law has declared it, see Quantity.
struct JointQuantity {
  std::string name, unit, meaning, error_of;
};

/// The value of a face, by the contact at the end of a step with all numbers that the joint keeps.
using QuantityOfFace = std::function<Real(const Contact<Real>&)>;

/// That of the joint by this name; nothing where none of its laws has it. Of several that do, the first counts.
inline QuantityOfFace quantity_of(const Joint& joint, const std::string& name) {
  QuantityOfFace found;
  joint.for_each_part([&](const auto& part, int offset) {
    part.visit([&](const auto& law) {
      for (const auto& quantity : quantities_of<std::decay_t<decltype(law)>>())
        if (!found && quantity.name == name)
          found = [law, offset, value = quantity.value](const Contact<Real>& at) {
            return at.after(offset, [&](const auto& own) { return value(law, own); });
          };
      return 0;
    });
  });
  return found;
}

/// Those of all laws that a joint can have, each name once.
inline std::vector<JointQuantity> joint_quantities() {
  std::vector<JointQuantity> all;
  const auto add = [&](const auto& quantities) {
    for (const auto& one : quantities)
      if (std::none_of(all.begin(), all.end(), [&](const auto& other) { return other.name == one.name; }))
        all.push_back({one.name, one.unit, one.meaning, one.error_of});
  };
  const auto add_all = [&]<class... Ks>(const Kinds<Ks...>&) { (add(quantities_of<Ks>()), ...); };
  add_all(DilationKinds());
  add_all(ClosureKinds());
  add_all(FrictionKinds());
  add_all(ShearKinds());
  add_all(BondKinds());
  add_all(DamageKinds());
  return all;
}

}  // namespace sprekk::laws
