// Output quantities of joint laws, by name.
#pragma once

#include "laws/joint.hpp"

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

namespace sprekk::laws {

/// Declaration of an output quantity; see Quantity.
struct JointQuantity {
  std::string name, unit, meaning, error_of, integral;
};

/// Value on a face from the contact at the end of a step, with all history variables of the joint.
using QuantityOfFace = std::function<Real(const Contact<Real>&)>;

/// Returns the quantity of the joint with this name; an empty function if no law has it. If several laws have it, the
/// first one counts.
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

/// Returns the quantities of all available laws, each name once.
inline std::vector<JointQuantity> joint_quantities() {
  std::vector<JointQuantity> all;
  const auto add = [&](const auto& quantities) {
    for (const auto& one : quantities)
      if (std::none_of(all.begin(), all.end(), [&](const auto& other) { return other.name == one.name; }))
        all.push_back({one.name, one.unit, one.meaning, one.error_of, one.integral});
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
