// Accepted iterates of a solve by Newton's method: merits, step lengths and contact states.
#pragma once

#include <algorithm>
#include <cstddef>
#include <map>
#include <vector>

#include "base/view.hpp"

namespace sprekk::solve {

/// History of one solve. Merits are comparable from the last restart on. Local data; state patterns, merits and thus
/// the results are the same on all ranks, except swinging(), swings(), changed_lately() and n_changes(), which
/// belong to the entities of this rank.
class Iterates {
 public:
  struct Iterate {
    std::vector<char> states;  ///< see Globalisation::states()
    std::size_t pattern;       ///< hash of the states of all ranks
    Real merit, step;
    bool lagged;      ///< coefficients of fluxes are fixed
    bool of_other_f;  ///< f has changed: earlier merits are discarded, and the search restarts
  };
  void accept(const Iterate& iterate);
  /// Restarts the search: the next step is full. Earlier merits are not comparable, since f was different or the
  /// iterate is distant from the others.
  void restart();

  bool empty() const { return merits_.empty(); }
  Real last_merit() const { return merits_.back(); }
  std::size_t pattern() const { return pattern_; }
  /// Upper bound of the next merit: infinite after a restart; the last merit if the iteration is in a cycle or
  /// `lagged`; otherwise the largest of the last three merits.
  Real limit(bool lagged) const;
  /// Returns [as states()] 0.3 for entities with a change of state that also changed in one of the two previous
  /// iterates, otherwise 0.
  const std::vector<Real>& swinging() const { return swinging_; }
  bool swings() const;
  /// Returns [as states()] 1 for entities with a change of state in the last five iterates, otherwise 0.
  std::vector<char> changed_lately() const;

  /// Returns whether the last n steps did not halve the merit. False if there are fewer.
  bool not_halved_in(std::size_t n) const {
    return merits_.size() > n && merits_.back() > 0.5 * merits_[merits_.size() - 1 - n];
  }
  /// Returns whether none of the last five merits is below half of the best earlier merit, from the tenth iterate on,
  /// or, with `storage`, whether the last four step lengths sum to less than 0.5.
  bool stagnate(bool storage) const;
  /// Returns the largest number of changes of state of an entity of this rank.
  int n_changes() const { return n_changes_.empty() ? 0 : *std::max_element(n_changes_.begin(), n_changes_.end()); }
  /// Returns whether, in ten iterates without lag, no state changed and no merit was below half of the best earlier
  /// merit.
  bool stagnate_without_lag() const;

 private:
  void compare(const std::vector<char>& states);
  void note_progress(bool lagged);

  std::vector<Real> merits_, steps_;
  std::size_t since_ = 0;         // index of the first merit that belongs to the present f
  std::size_t progress_ = 0;      // number of merits at the last change of state, or reduction by half
  Real best_ = 0;                 // smallest merit so far
  std::vector<char> states_;      // of the last iterate
  std::vector<int> last_change_;  // [as states()] number of the last iterate with a change of state
  std::vector<int> n_changes_;    // [as states()] number of changes of state
  std::vector<Real> swinging_;
  std::size_t pattern_ = 0;
  bool changed_ = false;                 // the pattern changed in the last iterate
  std::map<std::size_t, Real> visited_;  // merit at the last visit of a pattern
  bool cycle_ = false;                   // a pattern recurred without a better merit
};

}  // namespace sprekk::solve
