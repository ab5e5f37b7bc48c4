// Loads of a state that enter the interaction integrals of crack fronts.
#pragma once

#include "assembly/module.hpp"
#include "mesh/facets.hpp"
#include "physics/mechanics/loads.hpp"
#include "physics/physics.hpp"

#include <string>
#include <vector>

namespace sprekk::physics::front {

/// Values of an output; null without this output.
const std::vector<Real>* values_of(const std::vector<assembly::OutputField>& outputs, const std::string& name);

/// Loads on owned cells and fracture faces.
struct Loads {
  /// [owned cell] isotropic stress of expansion and pores, Pa: -3 K alpha_T (T - T_0) - alpha (p - p_0); empty: zero
  std::vector<Real> isotropic;
  /// [owned fracture face] traction on side minus, minus that of the initial stress, Pa, global components
  std::vector<mesh::Vector> traction;
};

/// Computes Loads from the outputs of states. Refers to the scene and the mesh.
class LoadsOfStates {
 public:
  LoadsOfStates(const Setting& setting, InitialStress initial);
  Loads operator()(const std::vector<assembly::OutputField>& outputs) const;

 private:
  const Scene& scene_;
  const mesh::Mesh& mesh_;
  InitialStress initial_;
  std::vector<Real> filling_, biot_, initial_pressure_;  // [fracture face]; [owned cell], empty without fluid
};

}  // namespace sprekk::physics::front
