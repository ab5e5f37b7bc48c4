// States of which the Jacobian is the derivative of the residual.
#pragma once

#include <cmath>

#include "assembly/system.hpp"

namespace sprekk {

/// Turns the shear tractions against the plastic jump p_old that the committed state `before` left. Else slip against
/// the traction, p.z < 0 <= p_old.z, could be among the states: there derivatives are those of contact_residual() along
/// z, on purpose.
inline void against_plastic_jump(assembly::System& system, const fields::BlockVector& before,
                                 fields::Vector& traction) {
  const int dim = system.mesh().dim();
  for (const auto& field : system.outputs(before)) {
    if (field.name != "plastic jump local") continue;
    for (std::size_t k = 0; k < traction.getLocalLength(); ++k)
      if (k % dim > 0) traction.replaceLocalValue(k, -std::copysign(traction.getData()[k], field.values[k]));
  }
}

}  // namespace sprekk
