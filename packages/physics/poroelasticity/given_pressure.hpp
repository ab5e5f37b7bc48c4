// Prescribed fluid pressure in rock and fractures.
#pragma once

#include "assembly/system.hpp"
#include "fields/properties.hpp"

#include <memory>
#include <vector>

namespace sprekk::physics {

struct GivenPressureParameters {
  fields::Properties<Real> biot;  ///< [cell] Biot's coefficient
  std::vector<Real> of_fillings;  ///< [local fracture face] Biot's coefficient
  Real initial = 0;               ///< pressure of the initial state, Pa
};

/// Module of a prescribed pressure. It adds -p_K dV_K/du - alpha_f p_f dW_f/du to the rows of all displacements, with
/// V_K of PoroelasticCoupling, and alpha_f and W_f of FractureOpening. p is the pressure minus that of the initial
/// state. Outputs of the present state: "gained pore volume" V_K (cells, m^3; 2D: m^2) and "widening" W_f/|f| (fracture
/// faces, m).
class GivenPressure : public assembly::Module {
 public:
  /// Pressure of the initial state, Pa.
  virtual Real initial() const = 0;
  /// Sets the pressures minus initial(), [local cell], [local fracture face], Pa, from the next step on. Default: zero.
  virtual void set(const std::vector<Real>& rock, const std::vector<Real>& fractures) = 0;
};

std::unique_ptr<GivenPressure> make_given_pressure(const mesh::Mesh& mesh, GivenPressureParameters parameters);

/// Sets the fluid pressures of a scene with `host_fluid`, in owned cells and fracture faces, Pa, in the order of
/// model::FieldView, from the next step on. The outputs "gained pore volume" and "widening" give the resulting volume
/// changes. Model::save() does not save the pressures: set them again after restore(). Throws an Error if the scene has
/// no prescribed pressure, if a size is wrong, or if a value is not finite. Collective.
void set_fluid_pressure(assembly::System& system, const std::vector<Real>& rock, const std::vector<Real>& fractures);

}  // namespace sprekk::physics
