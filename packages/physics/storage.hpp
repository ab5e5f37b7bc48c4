// What cells and fracture faces store under what flows through them.
#pragma once

#include "assembly/module.hpp"
#include "base/expression.hpp"
#include "laws/fluid.hpp"
#include "physics/fluid_change.hpp"
#include "physics/properties.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sprekk::physics {

/// Per volume (of fractures: per area), where u has gained g since the start: (room + growth g) e(u), with the density
/// e of a fluid over that at reference conditions.
struct Capacity {
  Real room;    ///< of a fluid the porosity phi_0 (of fractures the aperture, m); of energy 0
  Real growth;  ///< of a fluid c_phi, 1/Pa: the porosity is phi_0 + c_phi g; of energy rho c, J/(m^3 K)
};

struct StorageParameters {
  std::string name;                        ///< of the module
  std::string field;                       ///< u, on cells
  Properties<Capacity> capacity = {};      ///< of cells
  laws::Fluid fluid = {};                  ///< of energy: the default, whose density is 1
  base::Expression initial = 0;            ///< u at the start
  std::optional<FluidChange> change = {};  ///< densities are times that of its response
};

/// Adds V (s - s_old)/dt to the rows of u (implicit Euler), with s as Capacity says: what the cell gains in a step. It
/// keeps what u has gained since the start. For a constant density that is V growth (u - u_old)/dt.
std::unique_ptr<assembly::Module> make_storage(StorageParameters parameters);

struct FractureStorageParameters {
  std::vector<Real> aperture = {};  ///< [local fracture face] a_0, m
  std::vector<Real> least = {};     ///< [local fracture face] of the aperture, m
  laws::Fluid fluid = {};
  base::Expression initial = 0;  ///< pressure at the start, Pa
  bool widens = false;           ///< the aperture grows by "widening" of PoroelasticCoupling
  std::optional<FluidChange> change = {};
};

/// The same for "face pressure" on fracture faces, of which all is space for fluid: area for V, aperture for the room.
std::unique_ptr<assembly::Module> make_fracture_storage(FractureStorageParameters parameters);

}  // namespace sprekk::physics
