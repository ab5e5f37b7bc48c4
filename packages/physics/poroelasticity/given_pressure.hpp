// The pressure of a fluid that is known, in rock and in fractures.
#pragma once

#include "assembly/module.hpp"

#include <memory>
#include <vector>

namespace sprekk::physics {

struct GivenPressureParameters {
  std::vector<Real> biot;  ///< [local cell] Biot's coefficient
  bool fractures = false;  ///< there are some
  bool tips = false;       ///< the displacement is enriched around crack tips
};

/// Adds -p_K dV_K/du - p_f dW_f/du to the rows of all displacements, V_K and W_f as PoroelasticCoupling has them: p is
/// what pressures are above those of the initial state. Outputs of the present state: "gained pore volume" V_K (cells,
/// m^3; 2D: m^2) and "widening" W_f/|f| (fracture faces, m).
class GivenPressure : public assembly::Module {
 public:
  /// [local cell], [local fracture face], Pa, from the next step on; zero at first.
  virtual void set(const std::vector<Real>& rock, const std::vector<Real>& fractures) = 0;
};

std::unique_ptr<GivenPressure> make_given_pressure(mesh::Shape shape, GivenPressureParameters parameters);

}  // namespace sprekk::physics
