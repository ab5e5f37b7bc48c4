// Bond of a sharp front: a process zone as short as the mesh resolves.
#pragma once

#include "laws/bond/linear_softening.hpp"

#include <cmath>

namespace sprekk::laws {

/// Linear softening whose strengths follow from the fracture energies and from the length h of a face: the process zone
/// has n = 3 faces,
///   T = sqrt(0.73 E' G_I/(n h)),  c = sqrt(0.73 E' G_II/(n h)),  E' = E/(1 - nu^2).
/// 0.73 E' G_I/T^2 is the length of the zone at a front in opening far from boundaries (perf/growth/similarity.py).
/// Under mesh refinement the front becomes that of linear fracture mechanics with the toughness K_c = sqrt(E' G_I).
/// Strengths are 0 before set_zone().
struct SharpFrontBond : SofteningBond {
  static constexpr Real zone = 0.73, faces_in_zone = 3;

  static constexpr const char *name = "sharp front",
                              *meaning = "linear softening with strengths from fracture energies and face length";
  static std::vector<Parameter<SharpFrontBond>> parameters() {
    return {{&SharpFrontBond::energy, Entry{"fracture energy", "J/m^2", base::positive(),
                                            "fracture energy G_I, dissipated by opening until the bond is lost"}},
            {&SharpFrontBond::shear_energy,
             Entry{"shear fracture energy", "J/m^2", base::positive(),
                   "fracture energy G_II, dissipated by slip in addition to friction until the bond is lost"}
                 .may_be_absent()}};
  }
  static std::vector<Quantity<SharpFrontBond>> quantities() { return quantities_of_softening<SharpFrontBond>(); }

  /// Sets the strengths on a face of length `size`, m, in rock with the modulus E', Pa. An absent G_II is G_I.
  void set_zone(Real modulus, Real size) {
    if (!(shear_energy > 0)) shear_energy = energy;
    tensile = std::sqrt(zone * modulus * energy / (faces_in_zone * size));
    shear = std::sqrt(zone * modulus * shear_energy / (faces_in_zone * size));
  }
};

}  // namespace sprekk::laws
