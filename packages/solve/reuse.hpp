// Reuse of a preconditioner for later systems, and checks of new ones.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/over_ranks.hpp"
#include "solve/linear_solver.hpp"

namespace sprekk::solve {

/// Returns whether more than one of `few` flags differs, of those of all ranks; additional flags differ.
/// Collective.
inline bool differ(const Comm& comm, const std::vector<bool>& before, const std::vector<bool>& now, GlobalIndex few) {
  std::array<GlobalIndex, 2> count{0, static_cast<GlobalIndex>(now.size())};
  for (std::size_t k = 0; k < now.size(); ++k) count[0] += k >= before.size() || now[k] != before[k];
  const auto all = base::sum_over_ranks(comm, count);
  return few * all[0] > all[1];
}

/// State of the preconditioner of a Krylov method from system to system, based on the iterations of solves. Calls must
/// follow the order of events. The state is the same on all ranks. Stored data.
class Reuse {
 public:
  enum class State {
    none,       ///< no preconditioner
    unchecked,  ///< of the present system, cycles not tried
    checked,    ///< of the present system, cycles tried
    reused,     ///< of an earlier system
    worn        ///< of an earlier system; the last solve was slow, so the next system gets a new one
  };
  static constexpr int max_unchecked = 40;  ///< iterations until a new one is made with a trial of its cycles
  static constexpr int max_more = 4;        ///< additional iterations that one of an earlier system may take

  State state() const { return state_; }
  bool is_of_earlier_system() const { return state_ == State::reused || state_ == State::worn; }
  /// Returns whether the next system may use the present preconditioner.
  bool may_keep() const { return state_ != State::none && state_ != State::worn; }
  /// Returns whether cycles must be tried at each set-up, because a solve without this check was slow.
  bool is_careful() const { return careful_; }

  void keep() { state_ = State::reused; }
  void make(bool checks) { state_ = checks ? State::checked : State::unchecked; }
  void lose() { state_ = State::none; }

  /// Returns the number of iterations after which a solve is repeated with a new preconditioner; 0: no limit.
  int max_iterations(Real tolerance) const {
    return is_of_earlier_system() ? expected(tolerance) + max_more : state_ == State::unchecked ? max_unchecked : 0;
  }
  /// Returns whether a new preconditioner with checks is needed after a solve. `reached`: the solve met its tolerance.
  bool gives_up(int iterations, bool reached) {
    const bool too_long = state_ == State::unchecked && iterations >= max_unchecked;
    if (reached || !(is_of_earlier_system() || too_long)) return false;
    careful_ = careful_ || too_long;
    return true;
  }
  /// Updates the expected number of iterations after an accepted solve. factor: reduction of the residual; wanted:
  /// required reduction.
  void learn(int iterations, Real factor, Real wanted) {
    if (is_of_earlier_system())
      state_ = iterations > expected(wanted) + max_more / 2 ? State::worn : State::reused;
    else if (const Real gained = std::max(factor, wanted); gained < 0.1)
      pace_ = -iterations / std::log10(gained);
  }

 private:
  int expected(Real tolerance) const { return static_cast<int>(std::ceil(-pace_ * std::log10(tolerance))); }

  State state_ = State::none;
  bool careful_ = false;
  Real pace_ = 0;  // iterations per digit with a new preconditioner
};

}  // namespace sprekk::solve
