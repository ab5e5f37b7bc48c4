// What a change of temperature does to the stress of rock and to the fluid in its pores.
#pragma once

#include "assembly/module.hpp"
#include "base/expression.hpp"
#include "laws/elasticity.hpp"
#include "physics/properties.hpp"

#include <memory>
#include <vector>

namespace sprekk::physics {

/// A temperature that is given, or a rate, of which stresses are expected.
struct GivenTemperature {
  base::Expression value;
  int boundary = -1, region = -1;  ///< where; -1: anywhere
  Real per_rate = 0;               ///< of a flux or a source: the change of temperature for each unit of it; 0: none
};

struct ThermalStressParameters {
  Properties<Real> expansion;                ///< of cells, linear, alpha_T, 1/K
  Properties<laws::Elasticity> elasticity;   ///< drained
  base::Expression initial = 0;              ///< T_0, where nothing is added to the stress, K
  std::vector<GivenTemperature> given = {};  ///< what the typical stress follows from
};

/// Adds to the rows of all displacements -(T_K - T_0) dV_K/du, V_K = integral of 3 K alpha_T div u over a cell: the
/// total stress gets the part -3 K alpha_T (T - T_0) I, K the bulk modulus, 3 K = 3 lambda + 2 G; in 2D of plane
/// strain. Output: "thermal stress", that part (cells, Pa).
std::unique_ptr<assembly::Module> make_thermal_stress(const mesh::Mesh& mesh, ThermalStressParameters parameters);

struct PoreExpansionParameters {
  Properties<Real> expansion;  ///< of cells, beta = porosity beta_fluid + (Biot coefficient - porosity) 3 alpha_T, 1/K
  base::Expression initial = 0;  ///< temperature at the start, K
};

/// Adds -V beta (T - T_old)/dt to the rows of "pressure": as much fluid more than the pores of a cell have room for.
std::unique_ptr<assembly::Module> make_pore_expansion(PoreExpansionParameters parameters);

}  // namespace sprekk::physics
