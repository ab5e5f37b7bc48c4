// Exchange with the exterior of the mesh, row by row.
#pragma once

#include "assembly/module.hpp"
#include "laws/fluid.hpp"
#include "transport/fluid_change.hpp"
#include "transport/present_conduits.hpp"

#include <vector>

namespace sprekk::transport {

/// Adds c (p - p_outside) to rows of a pressure field; for a compressible fluid c (e - e_outside)/c_f. With conduits, c
/// is the coefficient times the present transmissivity of a fracture face.
class Exchange {
 public:
  /// Adds an exchange to a row. Ignores rows of other ranks. `face`: owned fracture face, required with conduits.
  void add(LocalIndex row, Real coefficient, LocalIndex face = -1);
  /// Completes the set-up after all exchanges have been added. `block`: block of the field. `conduits`: [local fracture
  /// face], with apertures that depend on "widening". `change`: multiplies the coefficient by FlowFactor of a field on
  /// the same entities.
  void bind(const assembly::Context& context, int block, const laws::Fluid& fluid,
            const std::vector<laws::Conduit>& conduits = {}, const std::optional<FluidChange>& change = {});
  /// Sets the exterior pressures, Pa, in the order of add().
  void set_outside(const std::vector<Real>& pressures);
  void add_residual(const assembly::State& state, const assembly::Rows& r) const;
  void add_jacobian(const assembly::State& state, fields::BlockMatrix& J) const;

  struct Coefficient;  ///< device code

 private:
  Coefficient coefficient(const assembly::State& state) const;

  int block_ = -1, widening_ = -1, carried_ = -1;
  laws::Fluid fluid_;
  laws::FluidResponse response_;
  std::vector<LocalIndex> rows_, faces_;
  std::vector<Real> coefficients_;
  std::vector<char> owned_;  // [exchange in the order of add()] row is owned
  ConstView<LocalIndex*> row_, face_;
  ConstView<Real*> coefficient_, outside_;
  ConstView<laws::Conduit*> conduit_;
};

}  // namespace sprekk::transport
