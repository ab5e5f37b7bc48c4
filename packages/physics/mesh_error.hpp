// What a physics knows of the error that the mesh makes in a state.
#pragma once

#include "fields/types.hpp"

#include <string>
#include <vector>

namespace sprekk::physics {

/// A number of a state that a run may be asked for.
struct Functional {
  std::string what = "";                    ///< of the physics' own words
  std::string boundary = "", well = "";     ///< of which it is
  std::vector<std::string> fractures = {};  ///< over which it is taken; none: all
};

/// The error as a vector e of components, each of an owned cell, whose square is that of the error in the norm of the
/// energy. If e is of a state and e_z of the linearised problem's answer to the derivative of a functional J, J of the
/// state lacks +-e . e_z. All members are collective unless they return stored data.
class MeshError {
 public:
  struct Parts {
    std::vector<Real> error, whole;  ///< [component] e; the same of the fluxes themselves
  };

  virtual ~MeshError() = default;

  /// [component] the owned cell for which it counts. Stored data.
  virtual const std::vector<LocalIndex>& cells() const = 0;
  /// The energy is that of the first so many components; others are of functionals alone.
  virtual std::size_t n_of_energy() const = 0;
  virtual Parts of_state(const fields::BlockVector& x, Real t) = 0;
  /// Of an answer dx of the problem linearised at x.
  virtual Parts of_answer(const fields::BlockVector& x, const fields::BlockVector& dx) = 0;

  /// Whether it knows functionals of this kind. Stored data.
  virtual bool knows(const std::string& what) const = 0;
  virtual Real value(const Functional& J, const fields::BlockVector& x) = 0;
  /// Adds to a right side what the problem answers to with z; in rows of prescribed unknowns their values.
  virtual void add_derivative(const Functional& J, const fields::BlockVector& x, fields::BlockVector& right_side) = 0;
};

}  // namespace sprekk::physics
