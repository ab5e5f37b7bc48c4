// When a preconditioner of an earlier system serves, and how carefully a new one is made.
#pragma once

#include <algorithm>
#include <cmath>

#include "solve/linear_solver.hpp"

namespace sprekk::solve {

/// What becomes of the preconditioner of Krylov's method from one system to the next, by what solves have taken. Calls
/// come in the order in which things happen; the same on every rank. Stored data.
class Reuse {
 public:
  enum class State {
    none,       ///< there is no preconditioner
    unchecked,  ///< of the present system, whose cycles were not tried
    checked,    ///< of the present system
    kept,       ///< of an earlier system
    worn        ///< of an earlier system, and the last solve took so long that the next system gets a new one
  };
  static constexpr int most_unchecked = 40;  ///< iterations, after which a new one is made and its cycles are tried
  static constexpr int most_more = 4;        ///< iterations that one of an earlier system may take more than a new one

  State state() const { return state_; }
  bool is_of_earlier_system() const { return state_ == State::kept || state_ == State::worn; }
  /// Whether the next system may do with what there is.
  bool may_keep() const { return state_ != State::none && state_ != State::worn; }
  /// Whether cycles have to be tried at every set-up, since once they were not and a solve was long.
  bool is_careful() const { return careful_; }

  void keep() { state_ = State::kept; }
  void make(bool checks) { state_ = checks ? State::checked : State::unchecked; }
  void lose() { state_ = State::none; }

  /// After so many iterations a solve is given up for a new preconditioner; 0: never.
  int most_iterations(Real tolerance) const {
    return is_of_earlier_system() ? expected(tolerance) + most_more : state_ == State::unchecked ? most_unchecked : 0;
  }
  /// Of a solve that took so many iterations, and did not reach its tolerance or did: whether a new preconditioner is
  /// called for, made carefully.
  bool gives_up(int iterations, bool reached) {
    const bool too_long = state_ == State::unchecked && iterations >= most_unchecked;
    if (reached || !(is_of_earlier_system() || too_long)) return false;
    careful_ = careful_ || too_long;
    return true;
  }
  /// After a solve that was not given up; of a new preconditioner, which made the residual smaller by `factor`, where
  /// `wanted` was asked for, it is learnt how many iterations to expect.
  void learn(int iterations, Real factor, Real wanted) {
    if (is_of_earlier_system())
      state_ = iterations > expected(wanted) + most_more / 2 ? State::worn : State::kept;
    else if (const Real gained = std::max(factor, wanted); gained < 0.1)
      pace_ = -iterations / std::log10(gained);
  }

 private:
  int expected(Real tolerance) const { return static_cast<int>(std::ceil(-pace_ * std::log10(tolerance))); }

  State state_ = State::none;
  bool careful_ = false;
  Real pace_ = 0;  // iterations for a digit, with a new preconditioner
};

}  // namespace sprekk::solve
