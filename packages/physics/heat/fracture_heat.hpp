// Energy balance of fractures: conduction along them and heat storage.
#pragma once

#include "assembly/module.hpp"
#include "base/expression.hpp"
#include "laws/fluid.hpp"
#include "transport/fluid_change.hpp"
#include "transport/flux_scheme.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace sprekk::physics {

struct FractureHeatParameters {
  /// Thermal data of one fracture face.
  struct Face {
    Real aperture;      ///< initial aperture a_0, m
    Real minimum;       ///< residual aperture, m
    Real conductivity;  ///< of the filling, W/(m K)
    Real capacity;      ///< rho c of the filling at reference conditions, J/(m^3 K)
    Real at_start() const { return aperture > minimum ? aperture : minimum; }
  };
  std::vector<Face> faces = {};  ///< [local fracture face]
  transport::FluxScheme scheme = transport::FluxScheme::rt0;
  base::Expression initial = 0;                       ///< initial temperature, K
  std::optional<laws::Fluid> fluid = {};              ///< flowing filling, with "face pressure"
  base::Expression initial_pressure = 0;              ///< initial pressure with a fluid, Pa
  Real expansion = 0;                                 ///< volumetric, 1/K, of a fluid whose flow does not depend on T
  std::optional<transport::FluidChange> change = {};  ///< effect of T on the fluid
  bool widens = false;                                ///< adds "widening" of FractureOpening to the aperture
};

/// Creates the module. For a fracture face F of area A, and for each of its ridges i, the rows of "face temperature"
/// are
///   sum_i q_i + A c m_old (T - T_old)/dt   and   -q_i.
/// q_i is conduction in the hybrid form on the face, with the initial aperture times the conductivity. m = a e is the
/// volume of the filling at reference conditions per area, with e multiplied by the density of FluidResponse. Using m
/// of the start of the step is exact, because advection transports temperature differences, see make_advection().
///
/// With a fluid of expansion beta, the rows of "face pressure" receive -A beta m_old (T - T_old)/dt. Output: "fracture
/// temperature" (faces, K).
std::unique_ptr<assembly::Module> make_fracture_heat(mesh::Shape shape, FractureHeatParameters parameters);

}  // namespace sprekk::physics
