// Dilation with a constant angle.
#pragma once

#include "laws/contact.hpp"
#include "laws/kinds.hpp"

namespace sprekk::laws {

/// Opening by slip, the middle term of (14), m: tan(theta) |u_t^p|.
struct ConstantDilation {
  Real tangent = 0;  ///< tan(theta)

  static constexpr const char *name = "constant angle", *meaning = "proportional to the slip (14)";
  static std::vector<Parameter<ConstantDilation>> parameters() {
    return {{&ConstantDilation::tangent, Entry{"dilation angle", "degree", base::at_least(0).below(90),
                                               "dilation angle theta: the gap grows by tan(theta)|u_t^p| (14)"}
                                             .or_else(0)
                                             .converted(tangent_of_degrees)
                                             .also_called({"psi", "dilatancy", "dilatancy angle"})}};
  }

  template <class T>
  KOKKOS_INLINE_FUNCTION T opening(const Contact<T>& at) const {
    return tangent * at.plastic_slip;
  }
};

}  // namespace sprekk::laws
