#include "laws/closure/barton_bandis_cycles.hpp"

#include "base/check.hpp"

namespace sprekk::laws {

BartonBandisCycles BartonBandisCycles::in_situ(Real N, Real) const {
  constexpr Real rounding = 1e-9;
  SPREKK_CHECK(past == 0 || N <= (1 + rounding) * past,
               "\"largest past compression\": is {:.6g} Pa, must be at least the initial compression {:.6g} Pa", past,
               N);
  return *this;
}

}  // namespace sprekk::laws
