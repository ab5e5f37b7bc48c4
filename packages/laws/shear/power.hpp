// Tangential stiffness that increases with the compression.
#pragma once

#include "laws/contact.hpp"
#include "laws/kinds.hpp"
#include "laws/exponentials.hpp"

namespace sprekk::laws {

/// Elastic part of the tangential jump, m: u_t^e = lambda_t/(K_t (1 + N/N_r)^m) under the compression N = -lambda_n.
/// The stiffness is a secant stiffness without stored energy: if N changes at constant shear traction, the joint does
/// net work.
struct PowerShear {
  Real stiffness = 1;  ///< K_t at zero compression, Pa/m
  Real reference = 1;  ///< N_r, Pa
  Real exponent = 0;   ///< m

  static constexpr const char *name = "power", *meaning = "with a stiffness that grows with a power of the compression";
  static std::vector<Parameter<PowerShear>> parameters() {
    using Law = PowerShear;
    return {
        {&Law::stiffness, Entry{"tangential stiffness", "Pa/m", base::positive(),
                                "stiffness K_t of the elastic part of the tangential jump, without compression"}},
        {&Law::reference, Entry{"shear stiffening stress", "Pa", base::positive(),
                                "stress N_r in the tangential stiffness K_t (1 + N/N_r)^m under the compression N"}},
        {&Law::exponent,
         Entry{"shear stiffening exponent", "-", base::at_least(0), "exponent m of the tangential stiffness"}}};
  }

  template <class T>
  KOKKOS_INLINE_FUNCTION T compliance(const Contact<T>& at) const {
    return 1 / (stiffness * stiffening(T(-at.lambda_n), reference, exponent));
  }
  KOKKOS_INLINE_FUNCTION Real initial_compliance() const { return 1 / stiffness; }
};

}  // namespace sprekk::laws
