// Coulomb friction.
#pragma once

#include "laws/contact.hpp"
#include "laws/kinds.hpp"

namespace sprekk::laws {

/// Bound on |lambda_t|, Pa, Coulomb (13): b = -mu lambda_n.
struct CoulombFriction {
  Real coefficient = 0;  ///< mu

  static constexpr const char *name = "Coulomb", *meaning = "proportional to the compression (13)";
  static std::vector<Parameter<CoulombFriction>> parameters() {
    return {{&CoulombFriction::coefficient, Entry{"friction coefficient", "-", base::at_least(0),
                                                  "friction coefficient mu of the bound (13), in place of the angle; "
                                                  "typical: 0.6 to 0.85 (Byerlee 1978, material library)"}
                                                .also_called({"mu"})},
            {&CoulombFriction::coefficient,
             Entry{"friction angle", "degree", base::at_least(0).below(90),
                   "friction angle atan(mu) (3), in place of the coefficient; typical: 30 to 40"}
                 .converted(tangent_of_degrees)
                 .also_called({"phi"})}};
  }

  template <class T>
  KOKKOS_INLINE_FUNCTION T bound(const Contact<T>& at) const {
    return -coefficient * at.lambda_n;
  }
};

}  // namespace sprekk::laws
