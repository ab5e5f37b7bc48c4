// Hyperbolic closure of a joint.
#pragma once

#include "laws/contact.hpp"
#include "laws/kinds.hpp"

#include <limits>

namespace sprekk::laws {

/// Normal closure, m, the last term of (14) (Barton and Bandis): B = lambda_n/(K_n - lambda_n/Du), B <= 0. For tensile
/// tractions (iterates) it continues as lambda_n/K_n, continuously differentiable. An infinite Du gives lambda_n/K_n,
/// an infinite K_n gives B = 0.
struct BartonBandisClosure {
  Real maximum = std::numeric_limits<Real>::infinity();    ///< Du, m; 0: the joint does not close
  Real stiffness = std::numeric_limits<Real>::infinity();  ///< K_n at zero traction, Pa/m

  static constexpr const char *name = "Barton-Bandis", *meaning = "hyperbolic (14) (Bandis et al. 1983)";
  static std::vector<Parameter<BartonBandisClosure>> parameters() {
    return {
        {&BartonBandisClosure::maximum,
         Entry{"maximum closure", "m", base::at_least(0).or_infinite(),
               "maximum closure Du in (14); 0: no closure; infinite or absent: linear closure, traction divided by "
               "K_n; 6e-5 for a fresh joint with JRC 10 and JCS 100 MPa (Bandis et al. 1983)"}
             .may_be_absent()
             .with("normal stiffness")},
        {&BartonBandisClosure::stiffness, Entry{"normal stiffness", "Pa/m", base::positive(),
                                                "normal stiffness K_n at zero traction; absent: no closure; 2e10 for a "
                                                "fresh joint with JRC 10 and JCS 100 MPa (Bandis et al. 1983)"}
                                              .may_be_absent()
                                              .also_called({"kn", "jkn"})}};
  }

  /// Returns B, m; negative under compression.
  template <class T>
  KOKKOS_INLINE_FUNCTION T opening(const Contact<T>& at) const {
    if (initial_compliance() == 0) return T(0);
    if (at.lambda_n > 0) return at.lambda_n / stiffness;
    return at.lambda_n / (stiffness - at.lambda_n / maximum);
  }
  /// Derivative at zero traction, m/Pa.
  KOKKOS_INLINE_FUNCTION Real initial_compliance() const { return maximum == 0 ? 0 : 1 / stiffness; }
};

}  // namespace sprekk::laws
