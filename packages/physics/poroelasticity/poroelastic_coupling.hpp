// What a fluid's pressure does to rock that deforms, and what deformation makes of the room for fluid.
#pragma once

#include "assembly/module.hpp"
#include "physics/flow/stabilisation.hpp"
#include "physics/properties.hpp"

#include <memory>
#include <vector>

namespace sprekk::physics {

struct PoroelasticCouplingParameters {
  /// Of cells, Biot (1941): total stress is sigma(u) + sigma_0 - biot (p - p_0) I.
  Properties<Real> biot;        ///< alpha in [0, 1]
  Stabilisation stabilisation;  ///< with p_0
};

/// Couples "displacement" (with "side bubble" and "tip displacement" where there are) to "pressure" and "face pressure"
/// of HybridDiffusion, and declares the unknown "widening" b (fracture faces, m): the aperture (15) less that of the
/// initial state. With V_K(u) = integral of alpha div u over a cell K and W_f(u) = |f| n . mean([[u]]) of a fracture
/// face:
///   momentum rows           -(p_K - p_0) dV_K/du - p_f dW_f/du     the effective traction lambda - p_f n, Wollmann
///                                                                  (2024), (6)(7), acts on the sides of a fracture
///   rows of "widening"      |f| b - W_f(u)
///   rows of "pressure"      (V_K(u) - V_K(u_old))/dt               implicit Euler, m^3/s (2D: m^2/s)
/// and to the rows of pressures the flow of Stabilisation. make_fracture_storage() stores the fluid in fractures.
std::unique_ptr<assembly::Module> make_poroelastic_coupling(const mesh::Mesh& mesh,
                                                            PoroelasticCouplingParameters parameters);

}  // namespace sprekk::physics
