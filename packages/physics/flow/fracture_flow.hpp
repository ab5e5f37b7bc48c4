// Mass balance of a fluid in fractures: flow along them, through where they meet, and to and from the rock.
#pragma once

#include "assembly/module.hpp"
#include "base/expression.hpp"
#include "laws/conduit.hpp"
#include "physics/fluid_change.hpp"
#include "physics/hybrid_cell.hpp"
#include "physics/outflow.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace sprekk::physics {

struct FractureFlowParameters {
  /// Of one fracture face.
  struct Face {
    laws::Conduit along;
    Real exchange;  ///< of each side, 2 k_n/(a mu), m/(Pa s); infinite: nothing resists
  };
  std::vector<Face> faces = {};  ///< [local fracture face]
  std::vector<std::vector<int>> cut_by =
      {};  ///< [fracture] those whose filling lies between its parts; none if it widens
  std::vector<base::Expression> source = {};  ///< [fracture] volume of fluid per area and time, m/s
  FluxScheme scheme = FluxScheme::rt0;        ///< as in the rock
  laws::Fluid fluid = {};
  std::optional<FluidChange> change = {};  ///< flows are those of ChangedFlow
  std::array<Real, 3> weight{};            ///< rho_0 g, N/m^3
  OutflowNames outflow = {};
  std::vector<FluxCondition> conditions = {};  ///< those with a fracture
  Real softness = 0;                           ///< of those that widen by "widening" of PoroelasticCoupling, which T
                                               ///< then depends on: by about how much under a pressure, m/Pa
};

/// Adds to the rows of "face pressure", for a fracture face F with ridges i,
///   sum_i q_i - integral_F source   on F itself, where the cells beside add -q,   and   -q_i + what leaves   on ridges
/// with q_i as in HybridDiffusion, T its hybrid form on the face, with the transmissivity
/// for the mobility. All faces that end in a ridge have its pressure, so what flows into an intersection flows out of
/// it. Between a face and its ridge in a fracture that cuts it lies half of the width of that, which T gets as a
/// resistance 1/(exchange of that x aperture x length of the ridge). Outputs: "fracture pressure" p_F, "fluid flux"
/// sum_i q_i d_i / (A e_F), Darcy velocity times aperture (faces, m^2/s), and "hydraulic aperture".
std::unique_ptr<assembly::Module> make_fracture_flow(mesh::Shape shape, FractureFlowParameters parameters);

}  // namespace sprekk::physics
