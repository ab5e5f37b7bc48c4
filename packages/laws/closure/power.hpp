// Closure of a joint with a normal stiffness that increases with a power of the compression.
#pragma once

#include "laws/contact.hpp"
#include "laws/kinds.hpp"
#include "laws/exponentials.hpp"

namespace sprekk::laws {

/// Normal closure, m, for the stiffness dN/dV = K_n (1 + N/N_r)^m under the compression N = -lambda_n:
///   B = -N_r/(K_n (1 - m)) ((1 + N/N_r)^(1-m) - 1)
/// m = 0 is linear, m = 1 semi-logarithmic, m = 2 the hyperbola of Barton and Bandis with Du = N_r/K_n. For m > 1 the
/// closure is below N_r/(K_n (m - 1)).
struct PowerClosure {
  Real stiffness = 1;  ///< K_n at zero traction, Pa/m
  Real reference = 1;  ///< N_r, Pa
  Real exponent = 0;   ///< m

  static constexpr const char *name = "power", *meaning = "with a stiffness that grows with a power of the compression";
  static std::vector<Parameter<PowerClosure>> parameters() {
    using Law = PowerClosure;
    return {
        {&Law::stiffness, Entry{"normal stiffness", "Pa/m", base::positive(), "normal stiffness K_n at zero traction"}},
        {&Law::reference, Entry{"stiffening stress", "Pa", base::positive(),
                                "stress N_r in the normal stiffness K_n (1 + N/N_r)^m under the compression N"}},
        {&Law::exponent, Entry{"stiffening exponent", "-", base::at_least(0), "exponent m of the normal stiffness"}}};
  }

  template <class T>
  KOKKOS_INLINE_FUNCTION T opening(const Contact<T>& at) const {
    return -integral_of_softening(T(-at.lambda_n), reference, exponent) / stiffness;
  }
  KOKKOS_INLINE_FUNCTION Real initial_compliance() const { return 1 / stiffness; }
};

}  // namespace sprekk::laws
