// Damage drivers: damage k per unit of slip.
#pragma once

#include "laws/contact.hpp"
#include "laws/kinds.hpp"

namespace sprekk::laws {

/// Damage by slip: k = 1.
struct SlipDriver {
  static constexpr const char *name = "slip", *meaning = "slip itself";
  static std::vector<Parameter<SlipDriver>> parameters() { return {}; }

  template <class T>
  KOKKOS_INLINE_FUNCTION T wear(const Contact<T>&) const {
    return T(1);
  }
};

/// Damage by slip times compression (Archard's law of wear): k = N/sigma_r with N = -lambda_n, 0 in tension.
struct CompressionDriver {
  Real reference = 1e6;  ///< sigma_r, Pa

  static constexpr const char *name = "compression",
                              *meaning = "slip times compression divided by the reference stress";
  static std::vector<Parameter<CompressionDriver>> parameters() {
    return {{&CompressionDriver::reference, Entry{"reference stress", "Pa", base::positive(),
                                                  "reference stress, under which damage counts the slip itself"}}};
  }

  template <class T>
  KOKKOS_INLINE_FUNCTION T wear(const Contact<T>& at) const {
    if (at.lambda_n > 0) return T(0);
    return -at.lambda_n / reference;
  }
};

/// Damage by frictional work: k = |lambda_t|/sigma_r. Implicit, because friction depends on damage.
struct WorkDriver {
  Real reference = 1e6;  ///< sigma_r, Pa

  static constexpr const char *name = "frictional work",
                              *meaning = "slip times shear traction divided by the reference stress";
  static std::vector<Parameter<WorkDriver>> parameters() {
    return {{&WorkDriver::reference, Entry{"reference stress", "Pa", base::positive(),
                                           "reference stress, under which damage counts the slip itself"}}};
  }

  template <class T>
  KOKKOS_INLINE_FUNCTION T wear(const Contact<T>& at) const {
    return at.shear / reference;
  }
};

}  // namespace sprekk::laws
