// Friction composed of rock friction, riding over asperities, and shearing of asperities.
#pragma once

#include "laws/contact.hpp"
#include "laws/kinds.hpp"

#include <cmath>

namespace sprekk::laws {

/// Bound on |lambda_t|, Pa, under the compression N = -lambda_n, after Patton (1966) at low and Ladanyi and Archambault
/// (1970) at high compression, in the form of PorePy's composed friction:
///   b = N mu,  mu = (mu_b + tan psi)/(1 - mu_b tan psi) + a mu_a d_f,  tan psi = (1 - a) tan psi_0 d_d
///   a = 1 - (1 - N/N_T)^K,  sheared share of the asperities, 1 for N >= N_T
/// d_f and d_d are the factors of damage for friction and dilation. The rock friction mu_b is not damaged. For N < 0
/// the tangent at N = 0 continues.
struct ComposedFriction {
  static constexpr bool takes_damage = true;  ///< applies the factors of damage itself
  Real basic = 0;                             ///< mu_b
  Real asperity = 0;                          ///< tan psi_0
  Real sheared = 0;                           ///< mu_a
  Real transition = 1;                        ///< N_T, Pa
  Real exponent = 1.5;                        ///< K

  static constexpr const char *name = "composed",
                              *meaning =
                                  "sliding over asperities and shearing through them (Ladanyi and Archambault 1970)";
  static std::vector<Parameter<ComposedFriction>> parameters() {
    using Law = ComposedFriction;
    return {{&Law::basic, Entry{"basic friction coefficient", "-", base::at_least(0),
                                "basic friction coefficient mu_b of the smooth rock, in place of the angle"}},
            {&Law::basic,
             Entry{"basic friction angle", "degree", base::at_least(0).below(90),
                   "basic friction angle atan(mu_b) of the smooth rock, in place of the coefficient; typical: 25 to 35"}
                 .converted(tangent_of_degrees)},
            {&Law::asperity,
             Entry{"asperity angle", "degree", base::at_least(0).below(90), "inclination psi_0 of the asperities"}
                 .converted(tangent_of_degrees)},
            {&Law::sheared, Entry{"asperity friction coefficient", "-", base::at_least(0),
                                  "additional friction coefficient mu_a of sheared asperities"}},
            {&Law::transition, Entry{"transition stress", "Pa", base::positive(),
                                     "transition stress N_T, the compression above which all asperities are sheared"}},
            {&Law::exponent,
             Entry{"transition exponent", "-", base::greater_than(1),
                   "exponent K of the fraction of sheared asperities; 1.5 after Ladanyi and Archambault (1970)"}
                 .or_else(1.5)}};
  }
  std::string defect() const {
    return basic * asperity >= 1 ? "basic friction times the tangent of the \"asperity angle\" must be below 1: "
                                   "otherwise the faces lock at any shear traction"
                                 : "";
  }

  template <class T>
  KOKKOS_INLINE_FUNCTION T bound(const Contact<T>& at) const {
    using std::pow;
    const T N = -at.lambda_n;
    T rides = 1;  // 1 - a
    if (N >= transition)
      rides = 0;
    else if (N > 0)
      rides = pow(1 - N / transition, exponent);
    const T slope = rides * asperity * at.dilation_left;
    return N * ((basic + slope) / (1 - basic * slope) + (1 - rides) * sheared * at.friction_left);
  }
};

}  // namespace sprekk::laws
