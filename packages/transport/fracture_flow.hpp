// Mass balance of a fluid in fractures: flow along them, through intersections, and exchange with the rock.
#pragma once

#include "assembly/module.hpp"
#include "base/expression.hpp"
#include "laws/conduit.hpp"
#include "transport/fluid_change.hpp"
#include "transport/hybrid_cell.hpp"
#include "transport/outflow.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace sprekk::transport {

/// Pressure in fractures of impermeable rock.
struct FracturePressure {
  std::optional<base::Expression> initial;  ///< pressure at the start; none: undefined
  assembly::Size row = {};                  ///< further terms of the typical size of rows
};

struct FractureFlowParameters {
  /// Hydraulic data of one fracture face.
  struct Face {
    laws::Conduit along;
    Real exchange;      ///< per side, 2 k_n/(a mu), m/(Pa s); infinite: no resistance
    Real leak_off = 0;  ///< coefficient of each side, m/s^0.5; see make_leak_off()
  };
  std::vector<Face> faces = {};               ///< [local fracture face]
  std::vector<std::vector<int>> cut_by = {};  ///< [fracture] fractures whose filling divides it; empty with widening
  std::vector<base::Expression> source = {};  ///< [fracture] volume of fluid per area and time, m/s
  FluxScheme scheme = FluxScheme::rt0;        ///< rt0, mimetic: p_F is the mean over the face
  laws::Fluid fluid = {};
  std::optional<FluidChange> change = {};  ///< use the flows of ChangedFlow
  std::array<Real, 3> weight{};            ///< rho_0 g, N/m^3
  OutflowNames outflow = {};
  std::vector<FluxCondition> conditions = {};  ///< only those of fractures
  std::optional<FracturePressure> alone = {};  ///< rock without flow: the module declares "face pressure"
  Real softness = 0;                           ///< estimated widening per pressure, m/Pa, of fractures with "widening"
                                               ///< of FractureOpening, on which T depends
};

/// Creates the module of the flow in fractures. For a face F, and for each of its ridges i, the rows of "face pressure"
/// are
///   sum_i q_i - integral_F source   and   -q_i + prescribed outflow.
/// The adjacent cells add -q to the row of F. q_i is the hybrid form of HybridDiffusion on the face, with the
/// transmissivity as mobility. All faces that end in a ridge share its pressure, so flow through intersections is
/// conservative.
///
/// Without flow in the rock, the faces and ridges of fractures are the only facets, and the sides of fractures are
/// impermeable.
///
/// If another fracture cuts F, half of its width separates F from the common ridge. This adds the resistance
/// 1/(exchange of the cutting fracture x aperture of F x length of the ridge) to T.
///
/// Outputs: "fracture pressure" p_F, "hydraulic aperture", and "fluid flux" sum_i q_i d_i / (A e_F), the Darcy velocity
/// times the aperture (faces, m^2/s, global components). Integral "fluid volume" of the mechanical aperture.
std::unique_ptr<assembly::Module> make_fracture_flow(mesh::Shape shape, FractureFlowParameters parameters);

}  // namespace sprekk::transport
