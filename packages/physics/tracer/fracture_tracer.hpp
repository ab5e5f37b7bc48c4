// Mass balance of a tracer in fractures: diffusion along them, storage, sorption and decay.
#pragma once

#include "assembly/module.hpp"
#include "base/expression.hpp"
#include "laws/fluid.hpp"
#include "transport/flux_scheme.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace sprekk::physics {

struct FractureTracerParameters {
  /// Data of one fracture face.
  struct Face {
    Real aperture;     ///< initial aperture a_0, m
    Real minimum;      ///< residual aperture, m
    Real diffusion;    ///< D of the filling, m^2/s
    Real retardation;  ///< R
    Real at_start() const { return aperture > minimum ? aperture : minimum; }
  };
  std::vector<Face> faces = {};  ///< [local fracture face]
  transport::FluxScheme scheme = transport::FluxScheme::rt0;
  base::Expression initial = 0;           ///< initial concentration, kg/m^3
  Real decay = 0;                         ///< decay constant, 1/s
  std::optional<laws::Fluid> fluid = {};  ///< flowing filling, with "face pressure"
  base::Expression initial_pressure = 0;  ///< initial pressure with a fluid, Pa
  bool widens = false;                    ///< adds "widening" of FractureOpening to the aperture
};

/// Creates the module. For a fracture face of area A, and for each of its ridges i, the rows of "face concentration"
/// are
///   sum_i q_i + A m_old (c - c_old)/dt + decay A m_old c   and   -q_i,   m = a e + (R - 1) a_0.
/// q_i is diffusion in the hybrid form on the face, with the initial aperture times D, and e is the relative density of
/// the fluid. Using m of the start of the step is exact for storage, because advection transports differences of the
/// concentration, see make_advection().
///
/// Output: "fracture concentration" (faces, kg/m^3). Totals "tracer": mass "in fractures", and "decay", mass per time.
std::unique_ptr<assembly::Module> make_fracture_tracer(mesh::Shape shape, FractureTracerParameters parameters);

}  // namespace sprekk::physics
