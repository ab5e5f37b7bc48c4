// Operations of a non-smooth problem that help Newton's method to converge from a distant start.
#pragma once

#include "fields/evaluation.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace sprekk::fields {

/// Globalisation of a piecewise smooth f. Discrete states of entities distinguish the pieces. In some states, bodies
/// may be free to move. All members are collective unless they return stored data. This base class is for smooth f
/// without free bodies.
class Globalisation {
 public:
  virtual ~Globalisation() = default;

  /// Discrete states of x on this rank, one for each owned entity with states, in a fixed order.
  virtual std::vector<char> states(const Evaluation& x) { return {}; }
  /// Hash of the states of all ranks: the same on every rank and for any partition.
  virtual std::size_t state_hash(const std::vector<char>& states) { return 0; }
  /// True if the resistance decreases with the motion, so that a full Newton step may diverge. Collective.
  virtual bool weakens(const Evaluation& x) { return false; }
  /// Description of the location of flagged entities (order of states()) for messages; empty if none is flagged on any
  /// rank.
  virtual std::string where(const std::vector<char>& flagged) { return ""; }

  /// Positive diagonal of a block [owned unknown] that linear solves add to the Jacobian of the last jacobian(). It
  /// makes the Jacobian regular if bodies are free to move. Null if not needed. Solutions do not depend on it.
  virtual RCP<const Vector> proximal(int block) const { return Teuchos::null; }
  /// Replaces the component of a step dx along unresisted motions, whose length is arbitrary, by a step after which the
  /// motion is resisted. dx starts from the x of the last jacobian(). `end`: evaluation at x + dx, before and after the
  /// call; empty: none. Returns an empty text, or a description of the body whose motion meets no resistance.
  virtual std::string balance(const Evaluation& x, BlockVector& dx, Evaluation& end) { return ""; }
  /// Description of a floating body in the state of the last jacobian() or commit(); empty if there is none. Stored
  /// data.
  virtual std::string floating() const { return ""; }
  /// Adds stiffness to the Jacobian for entities free to slide or open, so that steps are shorter. The relative
  /// stiffness is the larger of `everywhere` and `here` [as states(); empty: zero]; 1 is about the stiffness of the
  /// surrounding rock. Zero gives the derivative of f. Solutions do not depend on it. Local.
  virtual void damp(Real everywhere, const std::vector<Real>& here) {}
  /// Adds springs to f that pull contacts towards their state at x. They constrain every body and reduce the influence
  /// of the earlier state. `stiffness` is relative; 1 is about the stiffness of the surrounding rock, 0 removes the
  /// springs. Returns false if there is no contact; f is then unchanged.
  virtual bool set_proximal_term(Real stiffness, const Evaluation& x) { return false; }
  /// May change constants that affect f but not its zeros, from the difference of two iterates. Call it for the
  /// iterates of one solve that satisfy the linear part of f, in their order, with `first` for the first one. Returns
  /// true if f has changed. The result is the same on every rank.
  virtual bool calibrate(const Evaluation& x, bool first) { return false; }
  /// If the position of a body is not determined by f, replaces the zero x of f by the one nearest to the last accepted
  /// x. Returns true if x moved by more than round-off. x may then be a zero of lower accuracy.
  virtual bool place_at_minimum_norm(Evaluation& x) { return false; }
};

}  // namespace sprekk::fields
