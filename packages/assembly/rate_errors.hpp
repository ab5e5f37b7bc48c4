// Errors of time steps, from how much the rates at which unknowns change differ from step to step.
#pragma once

#include "assembly/rates.hpp"
#include "fields/layout.hpp"
#include "fields/step_error.hpp"

#include <string>
#include <utility>
#include <vector>

namespace sprekk::assembly {

/// Unknowns x of balances of rates, block by block. With the rates r = (x - x_old)/dt of the last steps, the latest
/// first, and their lengths dt, dt_1, dt_2, a step by itself errs by
///   Euler: 1/2 dt^2 |x''|, with x'' = 2 f_2, f_2 = (r - r_1)/(dt + dt_1)
///   BDF2: (1 + w)^2/(6 w (1 + 2w)) dt^3 |x'''|, with x''' = 6 (f_2 - f_2 of the step before)/(dt + dt_1 + dt_2),
///   w = dt/dt_1
/// What steps err in, e, adds up to E as long as a difference of two states lasts, tau:
///   E = s E_1 + e,  tau = s tau_1 + dt,  s = min(1, |r|/|r_1|)
/// Steps that all err at the rate of this one would come to e tau/dt. The error is the geometric mean of both: one that
/// errs more than others does it once. |.| is the root mean square over the block, relative to the largest
/// change of an unknown since the start. At time t that is c and grows like t^p; the one to come soon is taken, c
/// min(10, T/t)^min(p, 1/2) with T the end: else what begins at zero would be resolved as finely as if it stayed small.
class RateErrors {
 public:
  RateErrors(RCP<const Comm> comm, const std::vector<fields::Layout>& layouts, const std::vector<char>& balances,
             Rates::Scheme scheme, const fields::BlockVector& start, Real duration);

  /// x is where the next step begins.
  void begin(const fields::BlockVector& x);
  /// The errors of a step to x, `second_order`: made by BDF2; unknown ones as long as rates before are missing. Changes
  /// below `least` [block] are none. Collective.
  fields::StepErrors of_step(const fields::BlockVector& x, Real dt, bool second_order, const std::vector<Real>& least);
  /// Loads change their course here: what follows has another rate, and where `jump` one that is unknown in the first
  /// step, at the start of which the state may jump. How long it lasts is found anew.
  void forget(bool jump);

  /// Rates, [entity, component], by names.
  std::vector<std::pair<fields::Field, View<Real**>>> histories() const;
  std::vector<Real> memory() const;
  void resume(const std::vector<Real>& memory);

 private:
  struct Kept {  // of a block
    int block;
    fields::Field field;
    View<Real**> start, old, rate, rate_before;       // [owned entity, component]
    Real n = 0;                                       // unknowns on all ranks
    Real largest = 0, lasts = 0, speed = 0, sum = 0;  // change since the start; tau; |r|; E
  };
  RCP<const Comm> comm_;
  std::vector<Kept> blocks_;
  bool second_order_;
  Real duration_, elapsed_ = 0;  // of all steps, and of those so far
  int n_rates_ = -1;             // that are known
  Real dt_ = 0, dt_before_ = 0;  // of the last steps
};

}  // namespace sprekk::assembly
