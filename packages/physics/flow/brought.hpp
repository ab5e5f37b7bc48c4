// What wells bring of a quantity that their fluid carries, row by row.
#pragma once

#include "assembly/module.hpp"
#include "laws/fluid.hpp"
#include "physics/flow/present_conduits.hpp"
#include "physics/fluid_change.hpp"

#include <vector>

namespace sprekk::physics {

/// Where a well puts in q > 0 of fluid that has the value v of what is carried, adds c q (u - v) to the row of u, which
/// is a difference as in make_advection(); where it takes out, nothing. q is given, or W (p_w - p), of a compressible
/// fluid W (e_w - e)/c_f, of a fracture face that widens with W times its present transmissivity.
class Brought {
 public:
  /// Adds a connection in a row; those that other ranks own are dropped. `face`: owned, needed with conduits.
  void add(LocalIndex row, Real index, bool by_pressure, LocalIndex face);
  /// Once all are added. Blocks of pressures and of u in the same entities; `conduits` and `change` as in
  /// Exchange::bind().
  void bind(const assembly::Context& context, int pressure, int carried, const laws::Fluid& fluid, Real capacity,
            const std::vector<laws::Conduit>& conduits, const std::optional<FluidChange>& change);
  /// Of one connection in a step.
  struct Control {
    Real driver;  ///< q, or the pressure in the well
    Real value;   ///< v
    bool brings;  ///< else v is what is there
  };
  /// In the order in which they were added.
  void set(const std::vector<Control>& controls);
  void add_residual(const assembly::State& state, const assembly::Rows& r) const;
  void add_jacobian(const assembly::State& state, fields::BlockMatrix& J) const;

  struct Kernel;  ///< device code

 private:
  Kernel kernel(const assembly::State& state) const;

  int pressure_ = -1, carried_ = -1, widening_ = -1, changing_ = -1;
  laws::Fluid fluid_;
  laws::FluidResponse response_;
  Real capacity_ = 0;
  std::vector<LocalIndex> rows_, faces_;
  std::vector<Real> indices_;
  std::vector<char> by_pressure_, kept_;
  ConstView<LocalIndex*> row_, face_;
  ConstView<char*> held_, brings_;
  ConstView<Real*> index_, driver_, value_;
  ConstView<laws::Conduit*> conduit_;
};

}  // namespace sprekk::physics
