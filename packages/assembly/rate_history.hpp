// Time steps of an equation system: rates of storage, and the storage increases of the last step.
#pragma once

#include "assembly/rates.hpp"
#include "assembly/structure.hpp"

#include <utility>
#include <vector>

namespace sprekk::assembly {

class RateHistory {
 public:
  RateHistory(const Structure& structure, Rates::Scheme scheme);

  /// Starts a step of length dt to t; dt = 0: no step yet.
  void begin(Real t, Real dt);
  /// Subtracts the rates of the previous step from the rows: r -= before * storage increase.
  void subtract_before(Real before, const Rows& r) const;
  /// Saves the residual without constraints at the end of the step, and the storage increases at `state`. Call before
  /// the histories of modules change.
  void commit(const fields::BlockVector& residual, const State& state);
  /// Continues after a step of length dt to t. Residuals of another run are forgotten.
  void resume(Real t, Real dt);

  Rates::Scheme scheme() const { return scheme_; }
  const Rates& rates() const { return rates_; }
  Real t() const { return t_; }
  Real dt() const { return dt_; }
  Real committed_t() const { return committed_t_; }
  Real committed_dt() const { return committed_dt_; }  ///< 0 before the first step
  /// Returns the residual without constraints at the end of the last step; empty: no storage or no step.
  const fields::BlockVector& at_end() const { return at_end_; }
  /// Returns the same residual, zero in rows of prescribed unknowns; see State::unbalanced.
  std::vector<ConstView<Real*>> unbalanced() const;
  /// Returns the storage increases of the last step, "gain of FIELD", [owned entity, component].
  std::vector<std::pair<fields::Field, View<Real**>>> histories() const;

 private:
  void find_gains(const State& state);

  const Structure& structure_;
  Rates::Scheme scheme_;
  Rates rates_;
  Real t_ = 0, dt_ = 0, committed_t_ = 0, committed_dt_ = 0;
  std::vector<View<Real**>> gains_;  // [block](owned entity, component); empty: not stored
  fields::BlockVector at_end_, unbalanced_;
};

}  // namespace sprekk::assembly
