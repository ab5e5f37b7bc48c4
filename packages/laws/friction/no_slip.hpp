// Closed faces without slip.
#pragma once

#include "laws/contact.hpp"
#include "laws/kinds.hpp"

namespace sprekk::laws {

/// Bound on |lambda_t|, Pa, that no shear traction reaches: b = -1e6 lambda_n; 0 on unloaded faces.
struct NoSlip {
  static constexpr Real coefficient = 1e6;

  static constexpr const char *name = "no slip",
                              *meaning =
                                  "no slip of faces under compression, a purely elastic joint without further entries";
  static std::vector<Parameter<NoSlip>> parameters() { return {}; }

  template <class T>
  KOKKOS_INLINE_FUNCTION T bound(const Contact<T>& at) const {
    return -coefficient * at.lambda_n;
  }
};

}  // namespace sprekk::laws
