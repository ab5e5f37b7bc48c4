// Quantities of interest along the states of a run: values, errors, and the cells that cause the errors.
#pragma once

#include "estimate/error_estimate.hpp"

#include <map>

namespace sprekk::estimate {

/// Quantities of interest, by user-defined names. Refers to the estimator. All members are collective unless they
/// return stored data.
class Goals {
 public:
  Goals(ErrorEstimator& estimator, std::map<std::string, Functional> quantities);

  /// Returns true if the state must be added: the last one, or every one if a quantity has a history or the system has
  /// storage. Stored data.
  bool need(bool last) const;
  /// Adds a state. Without norms in the estimate, only quantities other than norms are evaluated. `last`: no other
  /// state follows.
  void add(const State& state, const ErrorEstimate& estimate, bool last);
  /// Adds the contributions of cells to error bounds, for the state added last.
  void weigh(const State& state, const ErrorEstimate& estimate, bool last);

  /// Returns true if errors of balances exist; their rate does not increase with the order of the cells. Stored data.
  bool any_balance() const;
  /// Values and absolute errors in the last state, by the names of the quantities.
  const std::map<std::string, Estimate>& estimates() const { return estimates_; }

  /// [owned cell] maximum over the quantities of weight * contribution of the cell to the error bound.
  std::vector<Real> indicators(const std::map<std::string, Real>& weights) const;

 private:
  /// Error that contains a quantity: its number, and whether the quantity is its norm.
  struct Owner {
    std::size_t error;
    bool is_norm;
  };
  Owner owner_of(const Functional& J) const;
  MeshError& error(std::size_t k) const { return *estimator_.errors()[k]; }
  bool is_balance(std::size_t k) const { return error(k).names().is_balance; }
  bool is_alone() const { return estimator_.errors().size() == 1 && is_balance(0); }
  std::vector<Real> contributions(const Functional& J, const Owner& owner, const State& state);
  std::vector<Real> with_balances(const std::vector<Real>& energies) const;

  ErrorEstimator& estimator_;
  std::map<std::string, Functional> quantities_;
  std::map<std::string, Owner> owners_;
  std::vector<std::vector<CellErrors>> steps_;  // [error][step] of balances; only the last step of other errors
  std::vector<char> have_changed_;              // [error] see GoalErrors::follow()
  std::map<std::string, Estimate> estimates_;
  std::map<std::string, std::vector<Real>> bounds_;  // [quantity][owned cell]
};

/// Returns the smallest set of cells with at least the share `theta` of the sum of indicators, largest first.
/// Indicators within a factor of 2^(1/8) are selected together, so the choice does not depend on the rounding of sums
/// over ranks. Collective.
std::vector<LocalIndex> mark_cells(const Comm& comm, const std::vector<Real>& indicators, Real theta);

}  // namespace sprekk::estimate
