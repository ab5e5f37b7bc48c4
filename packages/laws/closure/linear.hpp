// Linear closure of a joint.
#pragma once

#include "laws/contact.hpp"
#include "laws/kinds.hpp"

namespace sprekk::laws {

/// Normal closure, m, proportional to the traction: B = lambda_n/K_n.
struct LinearClosure {
  Real compliance = 0;  ///< 1/K_n, m/Pa

  static constexpr const char *name = "linear", *meaning = "proportional to the traction";
  static std::vector<Parameter<LinearClosure>> parameters() {
    return {{&LinearClosure::compliance,
             Entry{"normal stiffness", "Pa/m", base::positive(), "normal stiffness K_n of the joint"}.converted(
                 reciprocal)}};
  }

  template <class T>
  KOKKOS_INLINE_FUNCTION T opening(const Contact<T>& at) const {
    return compliance * at.lambda_n;
  }
  KOKKOS_INLINE_FUNCTION Real initial_compliance() const { return compliance; }
};

}  // namespace sprekk::laws
