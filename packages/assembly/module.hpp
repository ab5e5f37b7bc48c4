// A physics module: names, declarations, and additions to residuals and Jacobian blocks.
#pragma once

#include "assembly/geometry.hpp"
#include "assembly/loop.hpp"
#include "assembly/loose_pieces.hpp"
#include "fields/block_matrix.hpp"
#include "fields/block_problem.hpp"
#include "fields/layout.hpp"
#include "mesh/mesh.hpp"

#include <memory>
#include <string>
#include <vector>

namespace sprekk::assembly {

/// What a number measures; from it follow its scale under the present loads and thereby scaling and convergence.
enum class Quantity {
  length,    ///< displacement scale, m
  stress,    ///< traction scale, Pa
  force,     ///< traction scale times the area of a typical face, N
  volume,    ///< displacement scale times that area, m^3
  pressure,  ///< of a fluid, Pa
  flow       ///< pressure scale times mobility over length, times that area, m^3/s
};

/// Functions that a block's matrix takes to almost nothing, which multigrid is told of; none: it has no use for
/// multigrid.
enum class NearNullSpace { none, rigid_motions, constants };

/// A field that a module adds to the problem. It becomes a block of the same name.
struct Unknown {
  fields::Field field;
  Quantity value, row;  ///< what the unknown and its equation are measured in
  NearNullSpace near_null_space = NearNullSpace::none;
  std::string local_group = "";     ///< fields with one group name are eliminated together, entity by entity; "" stays
  std::string enriches = "";        ///< the field that a field on enriched nodes adds to: zero where that is prescribed
  std::string condensed_into = "";  ///< of a field whose unknowns hardly couple among themselves: the one that they
                                    ///< couple to, from which preconditioners eliminate it
};

/// Rows that the module adds to in a loop, and the fields that those rows then depend on.
struct Coupling {
  Loop loop;
  std::string row;
  std::vector<std::string> columns;
};

/// A quantity that a module keeps from step to step, on owned entities; it changes at commit only.
struct History {
  std::string name;
  fields::Entity entity;
  int n_components;
};

/// An output array on owned cells or faces, or on all local nodes: [entity * n_components + component], in global
/// coordinates unless the name says "local".
struct OutputField {
  std::string name, unit;
  fields::Entity entity;
  int n_components;
  std::vector<Real> values = {};
};

/// A number that describes a state, the sum of what ranks say; its names lead to it in results.json, where totals of
/// the same names are added up.
struct Total {
  std::vector<std::string> names;
  Real value;
};

/// All that the framework needs to know to derive sparsity, ghost exchange, storage and output.
struct Declaration {
  std::vector<Unknown> unknowns;
  std::vector<Coupling> couplings;
  std::vector<History> history;
  std::vector<OutputField> outputs;  ///< without values
  std::vector<std::string> schur;    ///< the fields that add_schur() adds to
  bool stores = false;               ///< its rows of flow contain State::rate times what it stores
  bool linear =
      false;  ///< the Jacobian is constant and symmetric: it is assembled once, and the residual is K x + r(0, t)
};

/// What modules are bound to once: the mesh, and the stencil of every field they named. Unknown names throw.
class Context {
 public:
  Context(RCP<const mesh::Mesh> mesh, const Geometry& geometry, const std::vector<fields::Layout>& layouts,
          std::shared_ptr<Stencils> stencils)
      : mesh_(mesh), geometry_(geometry), layouts_(&layouts), stencils_(std::move(stencils)) {}
  RCP<const mesh::Mesh> mesh() const { return mesh_; }
  const Geometry& geometry() const { return geometry_; }
  int field(const std::string& name) const;  ///< number of the field's block
  const fields::Layout& layout(int field) const { return (*layouts_)[field]; }
  const Stencil& stencil(Loop loop, int field) const { return stencils_->of(loop, field); }

 private:
  RCP<const mesh::Mesh> mesh_;
  Geometry geometry_;
  const std::vector<fields::Layout>* layouts_;
  std::shared_ptr<Stencils> stencils_;
};

/// Where a residual is evaluated: unknowns with ghosts [field](unknown), the module's histories [number](entity,
/// component).
struct State {
  Real t = 0;
  Real rate = 0;  ///< what rates are times what a module stores more than at the start of the step, 1/s: see Rates
  ConstView<Real*> damping = {};       ///< [owned fracture face], see BlockProblem::damp(); empty: zero
  ConstView<Real*> augmentation = {};  ///< [owned fracture face] factor, see BlockProblem::calibrate(); empty: 1
  Real tether = 0;                     ///< see BlockProblem::tether()
  ConstView<Real**> anchor = {};       ///< [owned fracture face, 2 dim] jump that it pulls to, traction there; global
  ConstView<Real*> coefficients = {};  ///< [local fracture face] see BlockProblem::lag(); empty: those of x
  std::vector<ConstView<Real*>> x;
  std::vector<View<Real**>> history;
};

/// Owned rows, [field](row).
using Rows = std::vector<View<Real*>>;

/// Sizes that solvers and tests of convergence are relative to: they grow with the loads met so far and never shrink.
struct Scales {
  Real stress = 0, length = 0, pressure = 0;  ///< Pa, m, Pa
};

class Module {
 public:
  virtual ~Module() = default;
  virtual std::string name() const = 0;
  /// What of it, besides the scene, must be the same where a checkpoint is restored: its parameters, on every rank.
  virtual std::string fingerprint() const { return {}; }
  virtual Declaration declare() const = 0;
  /// Builds the module's tables and constant operators. Called once. Collective; what can throw on one rank comes last.
  virtual void bind(const Context& context) = 0;

  /// Adds this module's part to the residual (loads at state.t included). Local: sends nothing.
  virtual void residual(const State& state, const Rows& r) const = 0;
  /// Adds the derivative of residual() to the blocks of owned rows. Local: sends nothing.
  virtual void jacobian(const State& state, fields::BlockMatrix& J) const = 0;

  /// Its forces may hold bodies that boundary conditions leave free to move, which is an error without it.
  virtual bool holds_bodies() const { return false; }
  /// The largest prescribed stress at time t, Pa, on this rank: boundary traction, weight of the domain.
  virtual Real load(Real t) const { return 0; }
  /// The largest pressure of a fluid that it starts with, or that its sources and gravity make at time t, Pa, on this
  /// rank.
  virtual Real fluid_load(Real t) const { return 0; }
  /// The residual at x = 0 is the same at all times.
  virtual bool constant_load() const { return true; }
  /// Sets unknowns [field](owned unknown) of the initial state that are known to differ from zero.
  virtual void initial(const Rows& x) const {}
  /// Sets histories [number](entity, component) of the initial state that differ from zero.
  virtual void initial_history(const std::vector<View<Real**>>& history) const {}
  /// Called at the start of a step, before any residual at its end t.
  virtual void set_time(Real t, const Scales& scales) {}
  /// Called after set_time(), with the histories at the start of the step. Collective.
  virtual void start_step(const State& state) {}
  /// Moves the histories on to `state`.
  virtual void commit(State& state) const {}
  /// Adds to the diagonals of fields' own blocks [field](owned row) about what eliminating all other fields would: a
  /// Schur complement, for preconditioners and for sizes of rows.
  virtual void add_schur(const State& state, const Rows& diagonals) const {}
  /// Sets, of faces where a flux has a coefficient that depends on unknowns, what it is a power of, not below zero
  /// [local fracture face]: those of the state, or `widest`, the largest that it may well have under the present loads.
  /// Where State::coefficients is given, residual() and jacobian() take that. Local.
  virtual void coefficients(const State& state, bool widest, std::vector<Real>& values) const {}
  /// Appends measures that see what |residual| cannot, as maxima over this rank.
  virtual void measure(const State& state, const Scales& scales, std::vector<fields::Measure>& measures) const {}
  /// Adds weights w of the merit sum(w r^2), an energy, for the module's own rows; without them 1/|diagonal| is taken.
  virtual void merit_weights(const Rows& weights) const {}
  /// Sets the discrete states of owned fracture faces, [face].
  virtual void states(const State& state, std::vector<char>& states) const {}
  /// Adds to the grips [owned fracture face] how the module makes the sides of faces hold each other at `state`.
  virtual void grip(const State& state, std::vector<Grip>& grips) const {}
  /// After elimination of the local groups, blocks on the diagonal of the Jacobian at `state` are symmetric as far as
  /// this rank's part goes.
  virtual bool symmetric(const State& state) const { return true; }
  /// Appends this rank's parts of totals, the same ones on all ranks in the same order. Local.
  virtual void totals(const State& state, std::vector<Total>& totals) const {}
  /// Fills the values of the declared outputs, in their order, from a committed state. Local.
  virtual void output(const State& state, std::vector<OutputField>& fields) const {}
};

}  // namespace sprekk::assembly
