// Traction balance of the two interfaces of every fracture: rows of the side bubbles.
#pragma once

#include "assembly/module.hpp"
#include "laws/elasticity.hpp"
#include "physics/mechanics/loads.hpp"
#include "physics/properties.hpp"

#include <memory>
#include <vector>

namespace sprekk::physics {

struct InterfaceTractionBalanceParameters {
  Properties<laws::Elasticity> elasticity;  ///< all of these the same as the bulk's: bubbles test every load
  BodyForce body_force = {};
  InitialStress initial_stress = {};
  FluidPressure fluid_pressure = {};
};

/// Declares the unknown "side bubble" beta (fracture faces; dim components of side minus, then of side plus; m). With
/// the face function b of a side's cell the displacement is u = u_nodes + beta b there, and the module adds the
/// balances sigma n = lambda on side minus and -sigma n_h = lambda on side plus, Wollmann (2024), (6)(7), twice in weak
/// form:
///   displacement rows  integral sigma(beta b) : grad v + s |f| lambda . mean(v)          s = 1 on side plus, -1 on
///   side minus side bubble rows   integral sigma(u_nodes) : grad(b e_i) + alpha beta_i + s |f| mean(b) lambda_i -
///   integral F_i b
/// and for an initial stress, in the side bubble rows, integral sigma_0 : grad(b e_i), and in both, so that an initial
/// equilibrium is one at zero displacement although lambda is constant on a face, the deviation of the traction from
/// its mean on the face: s integral (sigma_0 n - mean(sigma_0 n)) . v over the face. lambda: field "traction", frame of
/// the face. alpha = m lambda_max(B), B_ij = integral sigma(b e_i) : grad(b e_j), m the number of fracture faces of the
/// cell, bounds the bubbles' own stiffness, so that sides do not couple and the balance of a face stays isotropic.
/// Where there is fluid, lambda - p n takes the place of lambda, p its mean pressure on the face: output "fluid
/// pressure" (fracture faces, Pa).
std::unique_ptr<assembly::Module> make_interface_traction_balance(mesh::Shape shape,
                                                                  InterfaceTractionBalanceParameters parameters);

}  // namespace sprekk::physics
