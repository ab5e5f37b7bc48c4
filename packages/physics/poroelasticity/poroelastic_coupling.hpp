// Coupling of fluid pressure and rock deformation.
#pragma once

#include "assembly/module.hpp"
#include "fields/properties.hpp"
#include "transport/stabilisation.hpp"

#include <memory>

namespace sprekk::physics {

struct PoroelasticCouplingParameters {
  /// Data of cells. Total stress (Biot 1941): sigma(u) + sigma_0 - biot (p - p_0) I.
  fields::Properties<Real> biot;           ///< Biot's coefficient alpha in [0, 1]
  transport::Stabilisation stabilisation;  ///< includes p_0
};

/// Creates the module that couples "displacement" (with "side bubble" and "tip displacement" if present) to "pressure"
/// of HybridDiffusion. V_K(u) is the integral of alpha div u over a cell K. Rows:
///   momentum      -(p_K - p_0) dV_K/du
///   "pressure"    (V_K(u) - V_K(u_old))/dt              implicit Euler, m^3/s (2D: m^2/s)
/// The rows of pressures also receive the flow of Stabilisation. make_fracture_opening() adds the coupling in
/// fractures.
std::unique_ptr<assembly::Module> make_poroelastic_coupling(PoroelasticCouplingParameters parameters);

}  // namespace sprekk::physics
