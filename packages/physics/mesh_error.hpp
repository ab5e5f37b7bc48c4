// What a physics knows of the error that the mesh makes in a state.
#pragma once

#include "fields/types.hpp"

#include <string>
#include <vector>

namespace sprekk::assembly {
struct Reaction;
}

namespace sprekk::physics {

/// A kind of numbers that a run may be asked for.
struct QuantityKind {
  std::string name;  ///< Functional::what
  std::string unit, unit_in_2d;
  std::string text;  ///< for the reference
};

/// A number of a state that a run may be asked for.
struct Functional {
  std::string what = "";                    ///< of the physics' own words
  std::string boundary = "", well = "";     ///< of which it is
  std::vector<std::string> fractures = {};  ///< over which it is taken; none: all
};

/// The error of a balance. What it makes of the unknowns is what the linearised problem answers to add_truncation()
/// with. Its fluxes' error is a vector e of components, each of an owned cell, whose square is that of the error in the
/// norm of the energy. All members are collective unless they return stored data.
class MeshError {
 public:
  struct Parts {
    std::vector<Real> error, whole;  ///< [component] e; the same of the fluxes themselves
  };

  virtual ~MeshError() = default;

  /// Of what flows, and the unit of the energy.
  virtual const std::string& name() const = 0;
  virtual const std::string& unit() const = 0;
  /// [component] the owned cell for which it counts. Stored data.
  virtual const std::vector<LocalIndex>& cells() const = 0;
  /// The energy is that of the first so many components; others are of functionals alone.
  virtual std::size_t n_of_energy() const = 0;
  virtual Parts of_state(const fields::BlockVector& x, Real t) = 0;

  /// Of the state that of_state() was asked for last: adds to a right side what the rows leave over where unknowns are
  /// those of the exact solution.
  virtual void add_truncation(const fields::BlockVector& x, fields::BlockVector& right_side) = 0;
  /// Adds in rows of prescribed unknowns what their values lack.
  virtual void add_prescribed(Real t, fields::BlockVector& right_side) const = 0;
  /// [owned cell] What a flow that carries something adds to the energy of the error dx.
  virtual std::vector<Real> carried(const fields::BlockVector& dx) const = 0;

  /// Whether it knows functionals of this kind. Stored data.
  virtual bool knows(const std::string& what) const = 0;
  /// At x, where these are System::reactions().
  virtual Real value(const Functional& J, const fields::BlockVector& x,
                     const std::vector<assembly::Reaction>& reactions) = 0;

  /// Of an answer dx of the problem linearised at x, where that is symmetric.
  virtual Parts of_answer(const fields::BlockVector& x, const fields::BlockVector& dx) = 0;
  /// Adds to a right side what a symmetric problem answers to with the weight of each row in J; in rows of prescribed
  /// unknowns their values.
  virtual void add_derivative(const Functional& J, const fields::BlockVector& x, fields::BlockVector& right_side) = 0;
};

}  // namespace sprekk::physics
