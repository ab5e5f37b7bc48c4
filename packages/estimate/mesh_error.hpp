// Interface of an a-posteriori spatial error estimator.
#pragma once

#include "fields/types.hpp"

#include <string>
#include <vector>

namespace sprekk::assembly {
struct Reaction;
}

namespace sprekk::estimate {

/// Type of quantity with an error estimate.
struct QuantityKind {
  std::string name;  ///< Functional::what
  std::string unit, unit_in_2d;
  std::string text;  ///< description in the reference documentation
};

/// Quantity of interest of a state.
struct Functional {
  std::string what = "";                    ///< QuantityKind::name of a physics
  std::string boundary = "", well = "";     ///< location of the quantity
  std::vector<std::string> fractures = {};  ///< fractures included; empty: all
};

/// Spatial error of a balance equation. The error of the unknowns is the solution of the linearised problem with the
/// right side of add_truncation(). The error of the fluxes is a vector e of components. Each component belongs to an
/// owned cell. The sum of e^2 is the squared error in the energy norm. All members are collective unless they return
/// stored data.
class MeshError {
 public:
  struct Parts {
    std::vector<Real> error, whole;  ///< [component] e; the same for the total fluxes
  };

  virtual ~MeshError() = default;

  /// Name of the transported quantity, and unit of the energy.
  virtual const std::string& name() const = 0;
  virtual const std::string& unit() const = 0;
  /// [component] owned cell to which the component belongs. Stored data.
  virtual const std::vector<LocalIndex>& cells() const = 0;
  /// Number of leading components that contribute to the energy. The others contribute to functionals only.
  virtual std::size_t n_of_energy() const = 0;
  virtual Parts of_state(const fields::BlockVector& x, Real t) = 0;

  /// Adds the residual of the rows at the exact solution to a right side. Refers to the last state of of_state().
  virtual void add_truncation(const fields::BlockVector& x, fields::BlockVector& right_side) = 0;
  /// Adds the errors of the prescribed values to the rows of prescribed unknowns.
  virtual void add_prescribed(Real t, fields::BlockVector& right_side) const = 0;
  /// [owned cell] energy contribution of advective transport for the error dx.
  virtual std::vector<Real> carried(const fields::BlockVector& dx) const = 0;

  /// Returns whether the estimator supports functionals of this type. Stored data.
  virtual bool knows(const std::string& what) const = 0;
  /// Value of J at x; `reactions`: those of System::reactions().
  virtual Real value(const Functional& J, const fields::BlockVector& x,
                     const std::vector<assembly::Reaction>& reactions) = 0;

  /// Components for a solution dx of the problem linearised at x. Requires a symmetric problem.
  virtual Parts of_answer(const fields::BlockVector& x, const fields::BlockVector& dx) = 0;
  /// Adds the right side of the adjoint problem for J. Its solution is the weight of each row in J. The problem must be
  /// symmetric. Rows of prescribed unknowns receive the values of the adjoint solution.
  virtual void add_derivative(const Functional& J, const fields::BlockVector& x, fields::BlockVector& right_side) = 0;
};

}  // namespace sprekk::estimate
