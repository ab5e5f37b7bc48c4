// Energy balance of fractures: what they conduct along themselves and store.
#pragma once

#include "assembly/module.hpp"
#include "base/expression.hpp"
#include "laws/fluid.hpp"
#include "physics/fluid_change.hpp"
#include "physics/flux_scheme.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace sprekk::physics {

struct FractureHeatParameters {
  /// Of one fracture face.
  struct Face {
    Real aperture;      ///< a_0, m
    Real least;         ///< of the aperture, m
    Real conductivity;  ///< of what fills it, W/(m K)
    Real capacity;      ///< rho c of that at reference conditions, J/(m^3 K)
    Real at_start() const { return aperture > least ? aperture : least; }
  };
  std::vector<Face> faces = {};  ///< [local fracture face]
  FluxScheme scheme = FluxScheme::rt0;
  base::Expression initial = 0;            ///< temperature at the start, K
  std::optional<laws::Fluid> fluid = {};   ///< what fills it flows, with "face pressure"
  base::Expression initial_pressure = 0;   ///< with a fluid, Pa
  Real expansion = 0;                      ///< volumetric, of a fluid whose flow does not change, 1/K
  std::optional<FluidChange> change = {};  ///< what T does to the fluid
  bool widens = false;                     ///< the aperture grows by "widening" of PoroelasticCoupling
};

/// Adds to the rows of "face temperature", for a fracture face F with ridges i, of area A,
///   sum_i q_i + A c m_old (T - T_old)/dt   and   -q_i on ridges
/// where q_i is conducted, as in the hybrid form on the face, with a_0 times the conductivity, and m = a e is the
/// volume of what fills it, at reference conditions, per area, e times the density of FluidResponse; that of the start
/// of a step counts, as is exact where what flows in brings differences of temperature, see make_advection(). To the
/// rows of "face pressure" of a fluid with the expansion beta it adds -A beta m_old (T - T_old)/dt. Output: "fracture
/// temperature" (faces, K).
std::unique_ptr<assembly::Module> make_fracture_heat(mesh::Shape shape, FractureHeatParameters parameters);

}  // namespace sprekk::physics
