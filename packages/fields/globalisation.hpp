// What a problem that is not smooth offers beside its residual, so that Newton's method finds a zero from afar.
#pragma once

#include "fields/types.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace sprekk::fields {

/// f has pieces, told apart by discrete states of entities; bodies may be free to move in some of them. All members are
/// collective unless they return stored data. As it is here: f is smooth, and holds every body.
class Globalisation {
 public:
  virtual ~Globalisation() = default;

  /// The discrete states of x on this rank, one of each owned entity that has one, in a fixed order.
  virtual std::vector<char> states(const BlockVector& x) { return {}; }
  /// A hash of them, the same on every rank and for any partition.
  virtual std::size_t state_hash(const std::vector<char>& states) { return 0; }
  /// The resistance of joints may decrease with slip, so that a full Newton step may diverge. Collective.
  virtual bool weakens(const BlockVector& x) { return false; }
  /// Where the entities are that are flagged, in the order of states(), in words; empty if none is on any rank.
  virtual std::string where(const std::vector<char>& flagged) { return ""; }

  /// A positive diagonal of a block [owned unknown] that linear solves add to the Jacobian of the last jacobian(), so
  /// that it is regular also where bodies are free to move; null where none is needed. Solutions do not depend on it.
  virtual RCP<const Vector> proximal(int block) const { return Teuchos::null; }
  /// For a step dx from the x of the last jacobian(): replaces its share of motions that nothing resists, whose length
  /// means nothing, by one after which something does. Empty, or which body finds no resistance wherever it goes.
  virtual std::string balance(const BlockVector& x, BlockVector& dx) { return ""; }
  /// What nothing holds in the state of the last jacobian() or commit(), in words; empty if all is held. Stored data.
  virtual std::string loose() const { return ""; }
  /// From now on jacobian() makes what is free to slide or part resist it, so that steps are shorter: by the larger of
  /// `everywhere` and `here` [as states()] (1: about as much as the rock around it does; empty: zero). Zero is the
  /// derivative of f. Solutions do not depend on it. Local.
  virtual void damp(Real everywhere, const std::vector<Real>& here) {}
  /// From now on f is that of bodies whose contact resists any motion away from x, like a spring of `stiffness` (1:
  /// about as much as the rock around it does): so every body is held, and what it did before decides little. Zero is f
  /// as it is. False where there is no contact, and f stays as it is.
  virtual bool tether(Real stiffness, const BlockVector& x) { return false; }
  /// To be called for the iterates of one solve that balance the linear part of f, in their order, `first` for the
  /// first. From what lies between two of them, constants that f has but its zeros do not may be set anew: then true,
  /// and f is another function. The same on every rank.
  virtual bool calibrate(const BlockVector& x, bool first) { return false; }
  /// Where f leaves it open where a body is, replaces the zero x of f by the one nearest to the last accepted x, and
  /// returns true if x moved farther than rounding. x may then be a zero to a lesser accuracy.
  virtual bool settle(BlockVector& x) { return false; }
};

}  // namespace sprekk::fields
