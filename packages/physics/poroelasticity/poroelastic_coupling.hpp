// What a fluid's pressure does to rock that deforms, and what deformation makes of the room for fluid.
#pragma once

#include "assembly/module.hpp"
#include "base/expression.hpp"
#include "laws/elasticity.hpp"
#include "physics/hybrid_cell.hpp"
#include "physics/properties.hpp"

#include <memory>
#include <vector>

namespace sprekk::physics {

struct PoroelasticCouplingParameters {
  /// Of cells, Biot (1941): total stress is sigma(u) + sigma_0 - biot (p - p_0) I.
  Properties<Real> biot;                    ///< alpha in [0, 1]
  Properties<laws::Elasticity> elasticity;  ///< drained
  base::Expression initial = 0;             ///< p_0, Pa
  FluxScheme scheme = FluxScheme::rt0;      ///< as in the rock
};

/// Couples "displacement" (with "side bubble" and "tip displacement" where there are) to "pressure" and "face pressure"
/// of HybridDiffusion, and declares the unknown "widening" b (fracture faces, m): the aperture (15) less that of the
/// initial state. With V_K(u) = integral of alpha div u over a cell K and W_f(u) = |f| n . mean([[u]]) of a fracture
/// face:
///   momentum rows           -(p_K - p_0) dV_K/du - p_f dW_f/du     the effective traction lambda - p_f n, Wollmann
///                                                                  (2024), (6)(7), acts on the sides of a fracture
///   rows of "widening"      |f| b - W_f(u)
///   rows of "pressure"      (V_K(u) - V_K(u_old))/dt               implicit Euler, m^3/s (2D: m^2/s)
/// and to the rows of pressures, against oscillation of pressures in steps too short for drainage, the hybrid form of
///   -div(beta grad (p - p_old)/dt),   beta = alpha^2/(lambda + 2G) S
/// S the mean of x x^T over the corners of a cell, seen from its centre: h^2/4 for an edge h, as Aguilar, Gaspar,
/// Lisbona and Rodrigo (2008) have it; it vanishes with h^2. Nothing of it flows into fractures. What fluid fractures
/// have room for is the matter of make_fracture_storage().
std::unique_ptr<assembly::Module> make_poroelastic_coupling(const mesh::Mesh& mesh,
                                                            PoroelasticCouplingParameters parameters);

}  // namespace sprekk::physics
