// Pressure of nearly incompressible rock: the volumetric stress for which multigrid of displacements is not suitable.
#pragma once

#include "assembly/module.hpp"
#include "fields/properties.hpp"
#include "laws/elasticity.hpp"

#include <memory>

namespace sprekk::physics {

struct SolidPressureParameters {
  fields::Properties<laws::Elasticity> elasticity;  ///< [cell] part treated by displacements alone
  fields::Properties<Real> modulus;                 ///< [cell] kappa, Pa, the remaining part of lambda; 0: none
};

/// Split of the elasticity of nearly incompressible rock. It applies if Poisson's ratio exceeds 0.45 with displacements
/// of order 1, or 0.49 with order 2. `elasticity` then has the ratio 0.4 and the same shear modulus.
struct VolumetricSplit {
  laws::Elasticity elasticity;
  Real modulus;  ///< kappa = lambda - lambda_0, Pa; 0: none
  VolumetricSplit(const laws::Elasticity& law, int order);
};

/// Creates the module that declares the unknown "solid pressure" p = -kappa div u (cells, Pa), constant in each cell.
/// It adds the stress kappa tr(eps) I for displacements, tip functions and face bubbles:
///   -p dV_K/du in their rows,   -V_K(u) - |K| p/kappa - sum over neighbours L of (V_f^2/alpha_f) (p_K - p_L) = 0
/// in its own rows. Displacements of order 1 alone lock, and with a constant pressure per cell the pressures would
/// oscillate. As a remedy each face f between two cells of a region has a normal bubble, V_f = |f| mean(b), which is
/// eliminated (Bernardi and Raugel 1985). Instead of the stiffness of the bubbles, the diagonal
///   alpha_f = sum over both cells of the energy of the bubble
/// is used (Rodrigo et al. 2018), without coupling to displacements. On simplices of order 1, which have the fewest
/// displacements per pressure, this energy is divided by the number of faces of a cell. See
/// docs/model/discretisation.md, Nearly incompressible rock.
std::unique_ptr<assembly::Module> make_solid_pressure(SolidPressureParameters parameters);

}  // namespace sprekk::physics
