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
  Real aperture = 0;       ///< a, mechanical aperture without load, m; 0: not known before in_situ(), no closure
  Real cycle = 1;

  static constexpr const char *name = "Bandis", *meaning = "hyperbolic, by JRC, JCS and aperture (Bandis et al. 1983)";
  static std::vector<Parameter<BandisClosure>> parameters() {
    using Law = BandisClosure;
    return {{&Law::roughness, roughness_entry()},
            {&Law::wall_strength, wall_strength_entry()},
            {&Law::aperture,
             Entry{"joint aperture", "m", base::positive(),
                   "mechanical aperture a of the unloaded joint; JRC/50 mm for fresh walls (Bandis et al. 1983); may "
                   "be absent with \"reference state\" in situ"}
                 .or_found_in_situ()},
            {&Law::cycle, Entry{"loading cycle", "-", base::at_least(1).to(3),
                                "loading cycle, from 1 (first loading) to 3 (after two cycles) (Bandis et al. 1983)"}
                              .or_else(1)}};
  }
  void complete() {
    if (aperture == 0) return;
    const auto& [fixed, by_roughness, factor, exponent] = closure_terms();
    const Real strength = wall_strength / 1e9 / aperture;  // MPa/mm
    stiffness = 1e9 * (-7.15 + 1.75 * roughness + 0.02 * strength);
    maximum = 1e-3 * (fixed + by_roughness * roughness + factor * std::pow(strength, exponent));
  }
  std::string defect() const {
    if (cycle != 1 && cycle != 3) return "\"loading cycle\" must be 1 or 3: other cycles have no measured values";
    if (aperture == 0 || (stiffness > 0 && maximum > 0)) return "";
    return "\"joint roughness coefficient\", \"joint wall strength\" and \"joint aperture\" are outside of the "
           "measured range of the closure law: stiffness or maximum closure would be negative";
  }

  /// Law of the joint whose aperture without dilation is a (m) under the compression N (Pa). Without a given aperture
  /// a_0 it solves a_0 - V(N; a_0) = a over the range of the regressions. Of two solutions it takes the larger one,
  /// where a grows with a_0. Throws an Error with the possible apertures if there is none.
  BandisClosure in_situ(Real N, Real a) const;
  /// Smaller unloaded aperture of the same regressions with the same aperture under the compression N, m; 0: none.
  Real smaller_aperture(Real N) const;

 private:
  /// Terms A, B, C, D of Du.
  struct ClosureTerms {
    Real fixed, by_roughness, factor, exponent;
  };
  ClosureTerms closure_terms() const {
    if (cycle == 1) return {-0.2960, -0.0056, 2.2410, -0.2450};
    return {-0.1032, -0.0074, 1.1350, -0.2510};
  }
  BandisClosure of_aperture(Real unloaded) const;
  Real least_aperture() const;    ///< unloaded aperture with Du = 0, m
  Real largest_aperture() const;  ///< unloaded aperture with K_n = 0, m; may be infinite
  Real aperture_under(Real N, Real unloaded) const;
};

}  // namespace sprekk::laws
