// Thermal stress in rock and thermal expansion of pore fluid.
#pragma once

#include "assembly/module.hpp"
#include "base/expression.hpp"
#include "fields/properties.hpp"
#include "laws/elasticity.hpp"

#include <memory>
#include <vector>

namespace sprekk::physics {

/// Prescribed temperature or heat rate, for the scale of thermal stresses.
struct GivenTemperature {
  base::Expression value;
  int boundary = -1, region = -1;  ///< location; -1: anywhere
  Real per_rate = 0;               ///< temperature change per unit of a flux or source; 0: the value is a temperature
};

struct ThermalStressParameters {
  fields::Properties<Real> expansion;               ///< [cell] linear expansion coefficient alpha_T, 1/K
  fields::Properties<laws::Elasticity> elasticity;  ///< drained
  base::Expression initial = 0;                     ///< T_0 of zero thermal stress, K
  std::vector<GivenTemperature> given = {};         ///< determines the stress scale
};

/// Creates the module of thermal stress. It adds -(T_K - T_0) dV_K/du to the rows of all displacements, where V_K is
/// the integral of 3 K alpha_T div u over a cell. The total stress receives -3 K alpha_T (T - T_0) I with the bulk
/// modulus K, 3 K = 3 lambda + 2 G; in 2D for plane strain. Output: "thermal stress", this part (cells, Pa).
std::unique_ptr<assembly::Module> make_thermal_stress(ThermalStressParameters parameters);

struct PoreExpansionParameters {
  fields::Properties<Real>
      expansion;                 ///< [cell] beta = porosity beta_fluid + (Biot coefficient - porosity) 3 alpha_T, 1/K
  base::Expression initial = 0;  ///< initial temperature, K
};

/// Creates the module of pore expansion. It adds -V beta (T - T_old)/dt to the rows of "pressure". V beta is the excess
/// of fluid expansion over pore expansion in a cell.
std::unique_ptr<assembly::Module> make_pore_expansion(PoreExpansionParameters parameters);

}  // namespace sprekk::physics
