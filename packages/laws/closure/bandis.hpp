// Hyperbolic closure of a rough joint, from JRC, JCS and aperture.
#pragma once

#include "laws/closure/barton_bandis.hpp"
#include "laws/roughness.hpp"

#include <cmath>

namespace sprekk::laws {

/// Closure of Barton and Bandis with the regressions of Bandis, Lumsden and Barton (1983). Units: a in mm, JCS in MPa.
///   K_n = -7.15 + 1.75 JRC + 0.02 JCS/a  GPa/m,  Du = A + B JRC + C (JCS/a)^D  mm
/// A to D are those of the first or third loading cycle. The formulas were taken from source code (Lei's Y; Kubeyev and
/// Maier for MRST), not from the paper.
struct BandisClosure : BartonBandisClosure {
  Real roughness = 0;      ///< JRC
  Real wall_strength = 1;  ///< JCS, Pa
  Real aperture = 1;       ///< a, mechanical aperture without load, m
  Real cycle = 1;

  static constexpr const char *name = "Bandis", *meaning = "hyperbolic, by JRC, JCS and aperture (Bandis et al. 1983)";
  static std::vector<Parameter<BandisClosure>> parameters() {
    using Law = BandisClosure;
    return {{&Law::roughness, roughness_entry()},
            {&Law::wall_strength, wall_strength_entry()},
            {&Law::aperture,
             Entry{"joint aperture", "m", base::positive(),
                   "mechanical aperture a of the unloaded joint; JRC/50 mm for fresh walls (Bandis et al. 1983)"}},
            {&Law::cycle, Entry{"loading cycle", "-", base::at_least(1).to(3),
                                "loading cycle, from 1 (first loading) to 3 (after two cycles) (Bandis et al. 1983)"}
                              .or_else(1)}};
  }
  void complete() {
    const Real a = aperture * 1e3, strength = wall_strength / 1e6 / a;
    stiffness = 1e9 * (-7.15 + 1.75 * roughness + 0.02 * strength);
    maximum = 1e-3 * (cycle == 1 ? -0.2960 - 0.0056 * roughness + 2.2410 * std::pow(strength, -0.2450)
                                 : -0.1032 - 0.0074 * roughness + 1.1350 * std::pow(strength, -0.2510));
  }
  std::string defect() const {
    if (cycle != 1 && cycle != 3) return "\"loading cycle\" must be 1 or 3: other cycles have no measured values";
    if (stiffness > 0 && maximum > 0) return "";
    return "\"joint roughness coefficient\", \"joint wall strength\" and \"joint aperture\" are outside of the "
           "measured range of the closure law: stiffness or maximum closure would be negative";
  }
};

}  // namespace sprekk::laws
