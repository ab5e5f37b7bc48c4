// Exchange with what lies outside of the mesh, row by row.
#pragma once

#include "assembly/module.hpp"
#include "laws/fluid.hpp"
#include "physics/flow/present_conduits.hpp"
#include "physics/fluid_change.hpp"

#include <vector>

namespace sprekk::physics {

/// Exchanges c (p - p_outside) in rows of a field of pressures, of a compressible fluid c (e - e_outside)/c_f. With
/// conduits c is the coefficient times the present transmissivity of a fracture face.
class Exchange {
 public:
  /// Adds one with a coefficient to a row; those that other ranks own are dropped. `face`: owned, needed with conduits.
  void add(LocalIndex row, Real coefficient, LocalIndex face = -1);
  /// Once all are added. `block`: that of the field. `conduits`: [local fracture face], which "widening" widens.
  /// `change`: the coefficient is times FlowFactor, its field being one on the same entities.
  void bind(const assembly::Context& context, int block, const laws::Fluid& fluid,
            const std::vector<laws::Conduit>& conduits = {}, const std::optional<FluidChange>& change = {});
  /// The pressures outside, in the order in which exchanges were added.
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
  std::vector<char> kept_;  // [exchange as added]
  ConstView<LocalIndex*> row_, face_;
  ConstView<Real*> coefficient_, outside_;
  ConstView<laws::Conduit*> conduit_;
};

}  // namespace sprekk::physics
