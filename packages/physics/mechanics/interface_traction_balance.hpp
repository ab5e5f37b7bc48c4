// Traction balance of the two sides of every fracture: rows of the face bubbles.
#pragma once

#include "assembly/module.hpp"
#include "fields/properties.hpp"
#include "laws/elasticity.hpp"
#include "physics/mechanics/loads.hpp"

#include <memory>

namespace sprekk::physics {

struct InterfaceTractionBalanceParameters {
  fields::Properties<laws::Elasticity> elasticity;  ///< all members as in the bulk: bubbles test every load
  BodyForce body_force = {};
  InitialStress initial_stress = {};
  FluidPressure fluid_pressure = {};
};

/// Creates the module that declares the unknown "side bubble" beta (fracture faces; dim components of side minus, then
/// of side plus; m). In the cell of a side the displacement is u = u_nodes + beta b with the face function b. The
/// module adds the weak form of sigma n = lambda on side minus and -sigma n_h = lambda on side plus, Wollmann (2024),
/// (6), (7). With s = 1 on side plus and s = -1 on side minus:
///   displacement rows  integral sigma(beta b) : grad v + s |f| lambda . mean(v)
///   side bubble rows   integral sigma(u_nodes) : grad(b e_i) + alpha beta_i + s |f| mean(b) lambda_i - integral F_i b
/// lambda is the field "traction" in the frame of the face. alpha = m lambda_max(B) with B_ij = integral sigma(b e_i) :
/// grad(b e_j) and the number m of fracture faces of the cell. It bounds the stiffness of the bubbles from above. Sides
/// are therefore uncoupled, and the balance of a face is isotropic.
///
/// An initial stress adds integral sigma_0 : grad(b e_i) to the side bubble rows. Both kinds of rows also receive
///   s integral (sigma_0 n - mean(sigma_0 n)) . v over the face.
/// An initial equilibrium thus has zero displacement, although lambda is constant on a face. With fluid,
/// lambda - alpha_f p n replaces lambda, see FluidPressure, where p is the mean pressure on the face. Output: "fluid
/// pressure" (fracture faces, Pa).
std::unique_ptr<assembly::Module> make_interface_traction_balance(mesh::Shape shape,
                                                                  InterfaceTractionBalanceParameters parameters);

}  // namespace sprekk::physics
