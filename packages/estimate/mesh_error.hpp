// Interface of an a-posteriori spatial error estimator.
#pragma once

#include "assembly/module.hpp"

#include <string>
#include <vector>

namespace sprekk::assembly {
struct Reaction;
class System;
}  // namespace sprekk::assembly

namespace sprekk::estimate {

/// Type of quantity with an error estimate.
struct QuantityKind {
  std::string name;  ///< Functional::what
  std::string unit, unit_in_2d;
  std::string text;            ///< description in the reference documentation
  bool is_norm = false;        ///< energy norm of the whole domain; `name` is that of the MeshError
  bool has_component = false;  ///< see Functional::component
};

/// Quantity of interest of a state.
struct Functional {
  std::string what = "";                    ///< QuantityKind::name of a physics
  std::string boundary = "", well = "";     ///< location of the quantity
  std::string component = "x";              ///< direction of a vector
  std::vector<std::string> fractures = {};  ///< fractures included; empty: all
};

/// State of a system at a time t, s.
struct State {
  const fields::BlockVector& x;
  Real t;
  const std::vector<assembly::OutputField>& outputs;
};

/// Estimated errors of a state, exact minus computed.
struct Correction {
  fields::BlockVector dx;
  std::vector<assembly::OutputField> outputs;  ///< outputs of x + dx
  std::vector<assembly::Reaction> reactions;   ///< errors of System::reactions()
};

/// Error e by cells. The sum of the energies is |e|^2, the square of the energy norm.
struct CellErrors {
  struct Component {
    LocalIndex cell;
    Real value;
  };
  std::vector<Real> energy = {};           ///< [owned cell]
  std::vector<Component> components = {};  ///< components that enter functionals only, not the norm
};

struct StateError : CellErrors {
  std::vector<Real> density = {};  ///< [owned cell] energy per volume
  Real error = 0, whole = 0;       ///< energy norms of the error and of the whole state
  Real relative = 0;               ///< error / whole; 0 if both are round-off
};

/// Error of an output on fracture faces.
struct OutputError {
  Real norm = 0, relative = 0;  ///< L2 norm over the faces, and relative to the output
  assembly::OutputField field;  ///< exact minus computed values
};

/// Value of a quantity, and its error due to the mesh, exact minus computed, or a bound of its absolute value;
/// infinite: unknown.
struct Estimate {
  Real value = 0, error = 0;
};

/// Errors of quantities of interest: capability of a MeshError. All members are collective unless they return stored
/// data.
class GoalErrors {
 public:
  virtual ~GoalErrors() = default;

  /// Returns whether the estimator supports functionals of this type. Stored data.
  virtual bool knows(const std::string& what) const = 0;
  /// Returns whether the error of J depends on all states of a run. Stored data.
  virtual bool has_history(const Functional& J) const { return false; }
  /// Adds a state to the history. Returns whether the derivatives of functionals with history have changed considerably
  /// since the last call that returned true. `correction`: null if unknown.
  virtual bool follow(const State& state, const Correction* correction) { return false; }
  virtual Estimate evaluate(const Functional& J, const State& state, const Correction* correction) = 0;

  /// Adds the right side of the adjoint problem for J. Its solution z is the weight of each row in J. The problem must
  /// be symmetric. Rows of prescribed unknowns receive the values of z. Returns false if J has no such problem.
  virtual bool add_derivative(const Functional& J, const State& state, fields::BlockVector& right_side) = 0;
  /// Error of the solution z of the problem linearised at x, with the components of MeshError::of_state().
  virtual CellErrors of_adjoint(const fields::BlockVector& x, const fields::BlockVector& z) = 0;
};

/// Spatial error of the equations of a physics. The error of the unknowns solves the linearised problem with the right
/// side of add_residual() and add_prescribed(). All members are collective unless they return stored data.
class MeshError {
 public:
  struct Names {
    std::string name, unit;   ///< of the norm squared, the energy
    std::string density;      ///< name of the output of the energy per volume
    std::string output = "";  ///< name of the output on fracture faces with an error, see of_output(); empty: none
    /// The equations are balances: storage transfers errors to later steps.
    bool is_balance = false;
  };

  virtual ~MeshError() = default;

  virtual const Names& names() const = 0;  ///< stored data
  virtual StateError of_state(const fields::BlockVector& x, Real t) = 0;
  /// Adds the residual of the rows at the exact solution to a right side. Refers to the last state of of_state().
  virtual void add_residual(const fields::BlockVector& x, fields::BlockVector& right_side) = 0;
  /// Adds the errors of prescribed values at time t to the rows of prescribed unknowns. Throws an Error on all ranks if
  /// there is no such value.
  virtual void add_prescribed(Real t, fields::BlockVector& right_side) const = 0;
  /// [owned cell] further energy of the error dx: of transport by flows with errors; empty: none.
  virtual std::vector<Real> carried(const fields::BlockVector& dx) const { return {}; }
  /// Error of the output Names::output.
  virtual OutputError of_output(const State& state, const Correction& correction) const { return {}; }
  /// Errors of quantities of interest; null: none. Stored data.
  virtual GoalErrors* goals() { return nullptr; }
};

/// Sets the rows of all prescribed unknowns of a right side to zero. Not collective.
void zero_constrained_rows(const assembly::System& system, fields::BlockVector& right_side);

}  // namespace sprekk::estimate
