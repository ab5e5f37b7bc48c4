// Optional interfaces of modules. A module class inherits those that it implements, besides Module.
#pragma once

#include "assembly/module.hpp"

#include <optional>
#include <utility>
#include <vector>

namespace sprekk::assembly {

/// Loads: terms that do not vanish at x = 0, and their sizes.
class Loads {
 public:
  virtual ~Loads() = default;
  /// Returns the sizes of prescribed or initial quantities at time t on this rank, by the name of their scale.
  virtual Scales loads(Real t) const { return {}; }
  /// Returns whether the residual at x = 0 is the same at all times.
  virtual bool constant_load() const { return true; }
  /// Prepares a step that ends at t. Called before any residual of the step.
  virtual void set_time(Real t, const Scales& scales) {}
};

/// Initial values other than zero.
class InitialValues {
 public:
  virtual ~InitialValues() = default;
  /// Sets the non-zero initial unknowns [field](owned unknown).
  virtual void initial(const Rows& x) const {}
  /// Sets the non-zero initial histories [number](entity, component).
  virtual void initial_history(const std::vector<View<Real**>>& history) const {}
};

/// Data that change from step to step.
class Steps {
 public:
  virtual ~Steps() = default;
  /// Prepares a step, with the histories at its start. Called after Loads::set_time(). Collective: errors of single
  /// ranks must be thrown last.
  virtual void start_step(const State& state) {}
  /// Updates the histories to `state`, which has converged.
  virtual void commit(State& state) const {}
};

/// Transfer of a state between two systems.
class Transfer {
 public:
  virtual ~Transfer() = default;
  /// Appends histories on owned entities for the module of this name in a succeeding system. They replace the histories
  /// of the same names.
  virtual void pass_on(const State& state, std::vector<std::pair<History, View<Real**>>>& histories) const {}
  /// Adapts the module to a state and histories taken over from another system.
  virtual void take_over(State& state) const {}
  /// Replaces histories on cells by those whose integrals, or sums of amounts, a transfer to a changed mesh preserves.
  virtual void to_conserved(State& state) const {}
  /// Restores the histories from those of to_conserved(), on the changed mesh.
  virtual void from_conserved(State& state) const {}
  /// Receives the unbalanced residual after take_over(), [field](owned row), zero in rows of prescribed unknowns.
  virtual void take_unbalanced(State& state, const Rows& residual) const {}
};

/// Forces that may support bodies that boundary conditions leave free. Free bodies are an error without such forces.
class Supporting {
 public:
  virtual ~Supporting() = default;
  /// Returns whether the forces of the module may support bodies.
  virtual bool constrains_bodies() const = 0;
  /// Returns the supported unknowns at local nodes. No value: unknown; floating blocks of rock are then not detected.
  virtual std::optional<std::vector<contact::Support>> supports() const { return std::nullopt; }
};

/// Contact of fracture faces.
class ContactFaces {
 public:
  virtual ~ContactFaces() = default;
  /// Sets the contact states of owned fracture faces, [face].
  virtual void states(const State& state, std::vector<char>& states) const = 0;
  /// Adds the contact constraints of the module at `state`, [owned fracture face].
  virtual void add_contact_constraints(const State& state,
                                       std::vector<contact::Constraint>& contact_constraints) const = 0;
};

/// Flux coefficients that an iteration may fix, see BlockProblem::lag().
class LaggedCoefficients {
 public:
  virtual ~LaggedCoefficients() = default;
  /// Sets the base of flux coefficients that are powers of a function of the unknowns, >= 0, [local fracture face]. The
  /// base is that of the state or, if `widest`, the largest plausible one under the present loads. residual() and
  /// jacobian() use State::coefficients instead, if given. Local.
  virtual void coefficients(const State& state, bool widest, std::vector<Real>& values) const = 0;
};

/// Diagonals and weights of rows for preconditioners and line searches.
class RowWeights {
 public:
  virtual ~RowWeights() = default;
  /// Adds approximate Schur complements, from the elimination of all other fields, to the diagonals of the fields of
  /// Declaration::schur, [field](owned row). Preconditioners and row sizes use them.
  virtual void add_schur(const State& state, const Rows& diagonals) const {}
  /// Adds weights w of the merit sum(w r^2), an energy, for the module's own rows. Default: 1/|diagonal|.
  virtual void merit_weights(const Rows& weights) const {}
};

/// Storage that stabilises the discretisation. It is not part of the equations, prevents oscillations, and vanishes
/// with the cell size.
class ArtificialStorage {
 public:
  virtual ~ArtificialStorage() = default;
  /// Adds this storage to the rows. The residual contains State::rate times its increase in the step. Local.
  virtual void artificial(const State& state, const Rows& rows) const = 0;
};

/// Errors beyond the residual.
class Errors {
 public:
  virtual ~Errors() = default;
  /// Appends measures of convergence for errors that |residual| does not show, as maxima over this rank.
  virtual void measure(const State& state, const Scales& scales, std::vector<fields::Measure>& measures) const {}
  /// Appends the errors of the step from `begin` (owned unknowns only, old histories) to `end`. The errors are the same
  /// on all ranks. Collective.
  virtual void step_errors(const State& begin, const State& end, fields::StepErrors& errors) const {}
};

/// Numbers that describe a state.
class Totals {
 public:
  virtual ~Totals() = default;
  /// Appends this rank's parts of totals: the same totals in the same order on all ranks. Local.
  virtual void totals(const State& state, std::vector<Total>& totals) const = 0;
};

}  // namespace sprekk::assembly
