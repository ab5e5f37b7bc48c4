// Injection of transported quantities through wells, row by row.
#pragma once

#include "assembly/module.hpp"
#include "laws/fluid.hpp"
#include "transport/fluid_change.hpp"
#include "transport/present_conduits.hpp"

#include <vector>

namespace sprekk::transport {

/// Adds c q (u - v) to the row of u at each connection with an inflow q > 0. v is the value of u in the injected fluid.
/// This is a difference as in make_advection(). Connections with outflow add nothing. q is prescribed, or W (p_w - p);
/// for a compressible fluid W (e_w - e)/c_f. On faces with conduits W is the index times the present transmissivity.
class InjectedQuantity {
 public:
  /// Adds a connection to a row. Ignores rows of other ranks. `face`: owned fracture face, required with conduits.
  void add(LocalIndex row, Real index, bool by_pressure, LocalIndex face);
  /// Completes the set-up after all connections have been added. `pressure`, `carried`: blocks of p and u on the same
  /// entities. `conduits`, `change`: as in Exchange::bind().
  void bind(const assembly::Context& context, int pressure, int carried, const laws::Fluid& fluid, Real capacity,
            const std::vector<laws::Conduit>& conduits, const std::optional<FluidChange>& change);
  /// Control of one connection in a step.
  struct Control {
    Real driver;      ///< q, m^3/s, or the pressure in the well, Pa
    Real value;       ///< v
    bool prescribes;  ///< false: the injected fluid has the u of its surroundings
  };
  /// Sets the controls, in the order of add().
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
  std::vector<char> by_pressure_, owned_;
  ConstView<LocalIndex*> row_, face_;
  ConstView<char*> constrained_, prescribes_;
  ConstView<Real*> index_, driver_, value_;
  ConstView<laws::Conduit*> conduit_;
};

}  // namespace sprekk::transport
