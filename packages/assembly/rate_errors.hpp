// Errors of time steps, estimated from changes of the rates between steps.
#pragma once

#include "assembly/rates.hpp"
#include "fields/layout.hpp"
#include "fields/step_error.hpp"

#include <utility>
#include <vector>

namespace sprekk::assembly {

/// Step errors of the unknowns x of balances, block by block. Rates r = (x - x_old)/dt of the last steps, latest first,
/// have the step lengths dt, dt_1, dt_2. The error of a single step is
///   Euler: 1/2 dt^2 |x''|, with x'' = 2 f_2, f_2 = (r - r_1)/(dt + dt_1)
///   BDF2: (1 + w)^2/(6 w (1 + 2w)) dt^3 |x'''|, with x''' = 6 (f_2 - f_2 of the step before)/(dt + dt_1 + dt_2),
///   w = dt/dt_1
/// Step errors e accumulate to E while perturbations persist. The present rates have lasted for the time tau:
///   E = s E_1 + e,  tau = min(s, |r_1|/|r|) tau_1 + dt,  s = min(1, |r|/|r_1|)
/// Steps with the present accuracy would accumulate e tau/dt. The estimate is the geometric mean of E and e tau/dt.
/// |.| is the root mean square over the block, divided by the largest change c of an unknown since the start. While c
/// grows like t^p, its extrapolation c min(10, T/t)^min(p, 1/2) is used, with the end T. Otherwise, unknowns that start
/// at zero would require too small steps.
class RateErrors {
 public:
  RateErrors(RCP<const Comm> comm, const std::vector<fields::Layout>& layouts, const std::vector<char>& balances,
             Rates::Scheme scheme, const fields::BlockVector& start, Real duration);

  /// Sets the state x at which the next step begins.
  void begin(const fields::BlockVector& x);
  /// Returns the errors of a step to x. `second_order`: the step was made by BDF2. The errors are unknown while earlier
  /// rates are missing. Changes below `minimum` [block] are treated as zero. Collective.
  fields::StepErrors of_step(const fields::BlockVector& x, Real dt, bool second_order,
                             const std::vector<Real>& minimum);
  /// Restarts the estimate where loads change their course. The persistence time starts again at zero. If `abrupt`, the
  /// state may be discontinuous at the start of the first step, and the rate of this step is unknown.
  void forget(bool abrupt);

  /// Returns the rates, [entity, component], with their names.
  std::vector<std::pair<fields::Field, View<Real**>>> histories() const;
  /// Return and restore the numbers for a checkpoint. Numbers of other blocks restart the estimate. Local.
  std::vector<Real> memory() const;
  void resume(const std::vector<Real>& memory);

 private:
  struct BlockRates {  // data of a block
    int block;
    fields::Field field;
    View<Real**> start, old, rate, rate_before;       // [owned entity, component]
    Real n = 0;                                       // unknowns on all ranks
    Real largest = 0, lasts = 0, speed = 0, sum = 0;  // change since the start; tau; |r|; E
  };
  RCP<const Comm> comm_;
  std::vector<BlockRates> blocks_;
  bool second_order_;
  Real duration_, elapsed_ = 0;  // length of the run, time of all steps so far
  int n_rates_ = -1;             // number of known rates; -1: the first step gives none
  Real dt_ = 0, dt_before_ = 0;  // lengths of the last steps
};

}  // namespace sprekk::assembly
