// States for which the Jacobian is the derivative of the residual.
#pragma once

#include <cmath>

#include "assembly/system.hpp"

namespace sprekk {

/// Directs the shear tractions against the plastic jump p_old of the committed state `before`. This excludes slip
/// against the traction, p.z < 0 <= p_old.z. There, contact_residual() intentionally has derivatives along z.
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
