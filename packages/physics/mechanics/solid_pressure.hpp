// Nearly incompressible rock: the part of its volumetric stress that multigrid of displacements cannot carry.
#pragma once

#include "assembly/module.hpp"
#include "laws/elasticity.hpp"
#include "physics/properties.hpp"

#include <memory>

namespace sprekk::physics {

struct SolidPressureParameters {
  Properties<laws::Elasticity> elasticity;  ///< of cells: what displacements carry by themselves
  Properties<Real> modulus;                 ///< of cells: kappa, Pa, which is to be added to lambda there; 0: none
};

/// Rock so close to incompressible that it needs the module: Poisson's ratio above 0.45 with displacements of order 1,
/// above 0.49 with order 2. Then `elasticity` is that of a ratio of 0.4 with the same shear modulus.
struct VolumetricSplit {
  laws::Elasticity elasticity;
  Real modulus;  ///< kappa = lambda - lambda_0, Pa; 0: none
  VolumetricSplit(const laws::Elasticity& law, int order);
};

/// Declares the unknown "solid pressure" p = -kappa div u (cells, Pa), constant in each cell, and with it what adds
/// kappa tr(eps) I to the stress of displacements, of functions at tips and of bubbles of fracture faces:
///   -p dV_K/du in their rows,   -V_K(u) - |K| p/kappa - sum over neighbours L of (V_f^2/alpha_f) (p_K - p_L) = 0
/// in its own. Displacements of order 1 alone cannot move without changes of volume (they lock), and with pressures
/// constant in cells would let these oscillate. Against that each face f between two cells of a region has a normal
/// bubble, V_f = |f| mean(b), which is eliminated: after Bernardi and Raugel (1985), with a diagonal
///   alpha_f = sum over both cells of the bubble's energy
/// in place of the bubbles' stiffness, as Rodrigo et al. (2018) have it, without their coupling to displacements; on
/// simplices of order 1, which have the fewest displacements for a pressure, of that energy over the number of a cell's
/// faces. docs/model/discretisation.md, Nearly incompressible rock.
std::unique_ptr<assembly::Module> make_solid_pressure(const mesh::Mesh& mesh, SolidPressureParameters parameters);

}  // namespace sprekk::physics
