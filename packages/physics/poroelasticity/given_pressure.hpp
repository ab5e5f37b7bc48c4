// The pressure of a fluid that is known, in rock and in fractures.
#pragma once

#include "assembly/system.hpp"
#include "physics/properties.hpp"

#include <memory>
#include <vector>

namespace sprekk::physics {

struct GivenPressureParameters {
  Properties<Real> biot;  ///< of cells, Biot's coefficient
  Real initial = 0;       ///< pressure of the initial state, Pa
};

/// Adds -p_K dV_K/du - p_f dW_f/du to the rows of all displacements, V_K and W_f as PoroelasticCoupling has them: p is
/// what pressures are above those of the initial state. Outputs of the present state: "gained pore volume" V_K (cells,
/// m^3; 2D: m^2) and "widening" W_f/|f| (fracture faces, m).
class GivenPressure : public assembly::Module {
 public:
  virtual Real initial() const = 0;
  /// Less initial(), [local cell], [local fracture face], Pa, from the next step on; zero at first.
  virtual void set(const std::vector<Real>& rock, const std::vector<Real>& fractures) = 0;
};

std::unique_ptr<GivenPressure> make_given_pressure(const mesh::Mesh& mesh, GivenPressureParameters parameters);

/// Of a scene whose `host_fluid` is given: the pressures of the fluid in owned cells and fracture faces, Pa, in the
/// order of model::FieldView, from the next step on. The outputs "gained pore volume" and "widening" say what room it
/// makes. No part of what Model::save() keeps: to be given again after restore(). Collective.
void set_fluid_pressure(assembly::System& system, const std::vector<Real>& rock, const std::vector<Real>& fractures);

}  // namespace sprekk::physics
