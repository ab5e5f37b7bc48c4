// What a fluid's pressure stores of it: rows of the pressure in rock and in fractures.
#pragma once

#include "assembly/module.hpp"
#include "base/expression.hpp"
#include "laws/fluid.hpp"

#include <memory>
#include <vector>

namespace sprekk::physics {

/// Space for fluid, per volume (of fractures: per area, m) of which it is a part.
struct Pores {
  Real porosity;  ///< phi_0 at the start
  Real growth;    ///< c_phi: phi = phi_0 + c_phi (p - p at the start), 1/Pa
};

struct FluidStorageParameters {
  std::vector<Pores> pores;        ///< different ones
  std::vector<int> pores_of_cell;  ///< [local cell] which of them; empty: the number of the cell's region
  laws::Fluid fluid = {};
  base::Expression initial = 0;  ///< pressure at the start, Pa
};

/// Adds V (phi e - phi_old e_old)/dt to the rows of "pressure" (implicit Euler), with the fluid's density e over that
/// at reference conditions: what the pores of the cell gain in a step. It keeps what the pressure has gained since the
/// start. For a constant density that is V c_phi (p - p_old)/dt.
std::unique_ptr<assembly::Module> make_fluid_storage(FluidStorageParameters parameters);

struct FractureStorageParameters {
  std::vector<Real> aperture;  ///< [local fracture face] m
  laws::Fluid fluid = {};
  base::Expression initial = 0;  ///< pressure at the start, Pa
  bool widens = false;           ///< the aperture grows by "widening" of PoroelasticCoupling
};

/// The same for "face pressure" on fracture faces, of which all is space for fluid: area for V, aperture for phi.
std::unique_ptr<assembly::Module> make_fracture_storage(FractureStorageParameters parameters);

}  // namespace sprekk::physics
