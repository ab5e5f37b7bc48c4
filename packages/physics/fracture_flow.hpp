// Mass balance of a fluid in fractures: flow along them, through where they meet, and to and from the rock.
#pragma once

#include "assembly/module.hpp"
#include "base/expression.hpp"
#include "physics/darcy_flow.hpp"

#include <memory>
#include <vector>

namespace sprekk::physics {

struct FractureFlowParameters {
  std::vector<laws::Conduit> faces;      ///< [local fracture face]
  std::vector<base::Expression> source;  ///< [fracture] volume of fluid per area and time, m/s
  FluxScheme scheme = FluxScheme::rt0;   ///< as in the rock
  laws::Fluid fluid = {};
  std::array<Real, 3> weight{};                 ///< rho_0 g, N/m^3
  std::vector<FluidCondition> conditions = {};  ///< those with a fracture
  bool widens = false;                          ///< by "widening" of PoroelasticCoupling, which T then depends on
};

/// Adds to the rows of "face pressure", for a fracture face F with ridges i,
///   sum_i q_i - integral_F source   on F itself, where the cells beside add -q,   and   -q_i + what leaves   on ridges
/// with q_i as in DarcyFlow, T the hybrid form of DarcyFlow on the face, with the transmissivity
/// for the mobility. All faces that end in a ridge have its pressure, so what flows into an intersection flows out of
/// it. Outputs: "fracture pressure" p_F, and "fluid flux" sum_i q_i d_i / (A e_F), Darcy velocity times aperture
/// (faces, m^2/s).
std::unique_ptr<assembly::Module> make_fracture_flow(mesh::Shape shape, FractureFlowParameters parameters);

}  // namespace sprekk::physics
