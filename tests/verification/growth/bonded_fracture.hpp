// Numbers of a fracture with a bonded part, over all ranks.
#pragma once

#include "../scenes.hpp"

namespace sprekk::tests {

/// Sums over the faces of all fractures.
struct Opened {
  Real volume = 0;      ///< integral of the opening, m^3 (2D: m^2)
  Real broken = 0;      ///< integral of the damage of the bond, m^2 (2D: m); times G_I: the dissipated energy
  Real elastic = 0;     ///< half of the work of pressure beyond `compression` on the opening, J (2D: J/m): the elastic
                        ///< energy of the rock and of the bond, which unloads along the secant
  Real negative = 0;    ///< integral of negative openings
  Real wet_bonded = 0;  ///< integral of the hydraulic aperture beyond x = `notch` where there is no opening
};

/// Computes the sums. Collective.
inline Opened opened(model::Model& model, bool with_fluid, Real compression = 0, Real notch = 0) {
  const auto& mesh = model.mesh();
  const auto opening = model.output("opening").values, damage = model.output("damage of bond").values;
  std::vector<Real> pressure(opening.size(), 0), hydraulic = pressure;
  if (with_fluid) {
    pressure = model.output("fracture pressure").values;
    hydraulic = model.output("hydraulic aperture").values;
  }
  Real here[5] = {}, all[5];
  for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) {
    const Real area = mesh.fracture_faces[f].area;
    here[0] += area * opening[f];
    here[1] += area * damage[f];
    here[2] += area * opening[f] * (pressure[f] - compression) / 2;
    here[3] += area * std::min(Real(0), opening[f]);
    if (opening[f] < 1e-14 && mesh.fracture_faces[f].centre[0] > notch) here[4] += area * hydraulic[f];
  }
  Teuchos::reduceAll(*mesh.comm, Teuchos::REDUCE_SUM, 5, here, all);
  return {all[0], all[1], all[2], all[3], all[4]};
}

}  // namespace sprekk::tests
