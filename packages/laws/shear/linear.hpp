// Linear tangential elasticity of a joint.
#pragma once

#include "laws/contact.hpp"
#include "laws/kinds.hpp"

#include <limits>

namespace sprekk::laws {

/// Elastic part of the tangential jump (12), m: u_t^e = lambda_t/K_t.
struct LinearShear {
  Real inverse_stiffness = 0;  ///< 1/K_t, m/Pa; 0: rigid

  static constexpr const char *name = "linear", *meaning = "proportional to the shear traction (12)";
  static std::vector<Parameter<LinearShear>> parameters() {
    return {{&LinearShear::inverse_stiffness,
             Entry{"tangential stiffness", "Pa/m", base::positive_or_infinite(),
                   "stiffness K_t of the elastic part of the tangential jump (12); infinite: purely plastic tangential "
                   "jump; typical: 2e10 to 1e11 (material library)"}
                 .or_else(std::numeric_limits<Real>::infinity())
                 .converted(reciprocal)
                 .also_called({"ks", "kt", "jks", "shear stiffness"})}};
  }

  /// Compliance, u_t^e per lambda_t, m/Pa.
  template <class T>
  KOKKOS_INLINE_FUNCTION T compliance(const Contact<T>&) const {
    return inverse_stiffness;
  }
  KOKKOS_INLINE_FUNCTION Real initial_compliance() const { return inverse_stiffness; }
};

}  // namespace sprekk::laws
