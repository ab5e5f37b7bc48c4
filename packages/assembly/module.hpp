// A physics module: names, declarations, and additions to residuals and Jacobian blocks.
#pragma once

#include "assembly/geometry.hpp"
#include "assembly/loop.hpp"
#include "contact/grip.hpp"
#include "fields/block_matrix.hpp"
#include "fields/block_problem.hpp"
#include "fields/layout.hpp"
#include "fields/step_error.hpp"
#include "mesh/mesh.hpp"

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace sprekk::assembly {

/// Typical sizes that solvers and tests of convergence are relative to, by their names. They grow with the loads met so
/// far and never shrink.
using Scales = std::map<std::string, Real>;

/// scale(larger) >= factor scale(than).
struct ScaleRelation {
  std::string larger;
  Real factor;
  std::string than;
};

/// factor times a scale; `per_step`: over the length of the time step.
struct SizeTerm {
  std::string scale;
  Real factor = 1;
  bool per_step = false;
};

/// The typical size of a row, a sum.
using Size = std::vector<SizeTerm>;

/// Functions that a block's matrix takes to almost nothing, which multigrid is told of; none: it has no use for
/// multigrid.
enum class NearNullSpace { none, rigid_motions, constants };

/// How results.json calls the sums of a field's residuals over what a condition holds, by boundaries; empty: not there.
struct Reactions {
  std::string name = "";
  std::string moments = "";  ///< of forces: sum x cross f
  std::string regions = "";  ///< those of conditions in regions, by regions
  std::string unit = "";     ///< of the sums
};

/// A field that a module adds to the problem. It becomes a block of the same name.
struct Unknown {
  fields::Field field;
  std::string scale;  ///< the typical size of its values; prescribed values count as loads of it
  Size row;           ///< that of its rows, to which other modules may add, see Declaration::sizes
  NearNullSpace near_null_space = NearNullSpace::none;
  std::string local_group = "";     ///< fields with one group name are eliminated together, entity by entity; "" stays
  std::string enriches = "";        ///< the field that a field on enriched nodes adds to: zero where that is prescribed
  std::string condensed_into = "";  ///< of a field whose unknowns hardly couple among themselves: the one that they
                                    ///< couple to, from which preconditioners eliminate it
  /// Its rows are balances of rates: of fluxes, and State::rate times what is stored. They may differ by orders of
  /// magnitude, so each is measured by its diagonal, anew in each step.
  bool balance = false;
  /// Its values may be orders of magnitude above their scale: their rounding counts in the rows of others.
  bool unbounded = false;
  /// Of tractions of contact: the scale of the jumps that their rows have in them, times contact::Grip::augmentation.
  std::string augmented_by = "";
  Reactions reactions = {};
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

/// A number of a fracture that follows from the components of a mean or an integral over it; none: it has no meaning.
struct Derived {
  std::string name, unit;
  std::function<std::optional<Real>(const std::vector<Real>&)> of;
};

/// What results.json tells of an output on fracture faces, of each fracture: its mean over the area, "mean_NAME", of
/// vectors in it by the name of the frame; the largest value, "max_NAME"; its integral over the area, "NAME", of an
/// output that is no array of files; or of a state the area, and its shares, in which it is 0, 1, ..., "area_CLASS" and
/// "fraction_CLASS". A bound of the relative error of NAME is told as its largest value, "error_of_NAME", and once more
/// for all fractures at the end of the run.
struct Summary {
  enum Kind { none, mean, mean_and_max, fractions, integral, error_bound };
  Kind kind = none;
  std::string name = "";                  ///< spaces become underscores
  std::string frame = "";                 ///< of vectors
  std::vector<std::string> classes = {};  ///< of fractions
  std::string unit = "";                  ///< of an integral
  std::vector<Derived> derived = {};      ///< from the mean or the integral
};

/// An output array on owned cells or faces, or on all local nodes: [entity * n_components + component], in global
/// coordinates unless the name says "local".
struct OutputField {
  std::string name, unit;
  fields::Entity entity;
  int n_components;
  Summary summary = {};
  std::vector<Real> values = {};
};

struct State;

/// An output, without values, and how these follow from a committed state. Local.
struct Output {
  OutputField field;
  std::function<std::vector<Real>(const State&)> values;
};

/// A number that describes a state, the sum of what ranks say; its names lead to it in results.json, where totals of
/// the same names are added up.
struct Total {
  std::vector<std::string> names;
  Real value;
  std::string unit = "";
};

/// All that the framework needs to know to derive sparsity, ghost exchange, storage and output.
struct Declaration {
  std::vector<Unknown> unknowns;
  std::vector<Coupling> couplings;
  std::vector<History> history;
  std::vector<Output> outputs;
  Scales scales;  ///< what they are without loads, above zero; several modules may declare the same ones
  std::vector<ScaleRelation> relations;
  std::vector<std::pair<std::string, SizeTerm>> sizes;  ///< (field, what is added to the size of its rows)
  std::vector<std::string> schur;                       ///< the fields that add_schur() adds to
  std::vector<std::string> carries;  ///< balances of what it lets flow along with something else: such a flow may begin
                                     ///< within a step, so their rows are measured by the present Jacobian's diagonal
  bool stores = false;               ///< its balances of rates contain State::rate times what it stores
  bool linear = false;  ///< its Jacobian is constant and symmetric: it is assembled once; the residual is K x + r(0, t)
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
  Real rate = 0;    ///< what rates are times what a module stores more than at the start of the step, 1/s: Rates::now
  Real before = 0;  ///< Rates::before; what the step before stored is subtracted by the framework
  contact::Regularisation contact = {};
  ConstView<Real*> coefficients = {};  ///< [local fracture face] see BlockProblem::lag(); empty: those of x
  std::vector<ConstView<Real*>> x;
  std::vector<View<Real**>> history;
  /// In totals(): [field](owned row) the residual at the end of the last step, zero in rows of prescribed unknowns.
  /// Added to the product of a large conductance and a small drop it gives the flow without rounding. Empty: nothing is
  /// stored.
  std::vector<ConstView<Real*>> unbalanced = {};
};

/// Owned rows, [field](row).
using Rows = std::vector<View<Real*>>;

class Module {
 public:
  virtual ~Module() = default;
  virtual std::string name() const = 0;
  /// What of it, besides the scene, must be the same where a checkpoint is restored: its parameters, on every rank.
  virtual std::string fingerprint() const { return {}; }
  /// What it does may depend on which fields other modules add: a first declare() tells the unknowns of each module,
  /// which must not depend on that, then comes this, with all of them, then a second declare(), which counts.
  virtual void set_fields(const std::set<std::string>& fields) {}
  /// Collective.
  virtual Declaration declare(const mesh::Mesh& mesh) const = 0;
  /// Builds the module's tables and constant operators. Called once. Collective; what can throw on one rank comes last.
  virtual void bind(const Context& context) = 0;

  /// Adds this module's part to the residual (loads at state.t included). Local: sends nothing.
  virtual void residual(const State& state, const Rows& r) const = 0;
  /// Adds the derivative of residual() to the blocks of owned rows. Local: sends nothing.
  virtual void jacobian(const State& state, fields::BlockMatrix& J) const = 0;

  /// Its forces may hold bodies that boundary conditions leave free to move, which is an error without it.
  virtual bool holds_bodies() const { return false; }
  /// What of it they hold, of nodes that are local; nothing: that is not known, and nobody looks for loose pieces of
  /// rock.
  virtual std::optional<std::vector<contact::Support>> supports() const { return std::nullopt; }
  /// The sizes of what it prescribes at time t, or starts with, by the scales that they count for, on this rank.
  virtual Scales loads(Real t) const { return {}; }
  /// The residual at x = 0 is the same at all times.
  virtual bool constant_load() const { return true; }
  /// Sets unknowns [field](owned unknown) of the initial state that are known to differ from zero.
  virtual void initial(const Rows& x) const {}
  /// Sets histories [number](entity, component) of the initial state that differ from zero.
  virtual void initial_history(const std::vector<View<Real**>>& history) const {}
  /// Called at the start of a step, before any residual at its end t.
  virtual void set_time(Real t, const Scales& scales) {}
  /// Called after set_time(), with the histories at the start of the step. Collective; what can throw on one rank comes
  /// last.
  virtual void start_step(const State& state) {}
  /// Moves the histories on to `state`.
  virtual void commit(State& state) const {}
  /// Appends histories, of owned entities, that the module of this name in another system goes on from where that takes
  /// over `state`, in place of this one's own of the same names.
  virtual void pass_on(const State& state, std::vector<std::pair<History, View<Real**>>>& histories) const {}
  /// Called where a system has taken over the state and the histories of another one.
  virtual void take_over(State& state) const {}
  /// Called after that, with what is out of balance there, [field](owned row),
  /// zero in rows of prescribed unknowns.
  virtual void take_unbalanced(State& state, const Rows& residual) const {}
  /// Adds to the diagonals of fields' own blocks [field](owned row) about what eliminating all other fields would: a
  /// Schur complement, for preconditioners and for sizes of rows.
  virtual void add_schur(const State& state, const Rows& diagonals) const {}
  /// Adds to the rows that store what of that belongs to no equation but keeps a scheme from oscillating, and vanishes
  /// as cells become smaller: State::rate times it is in the residual, less what it was. Local.
  virtual void artificial(const State& state, const Rows& rows) const {}
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
  virtual void grip(const State& state, std::vector<contact::Grip>& grips) const {}
  /// After elimination of the local groups, blocks on the diagonal of the Jacobian at `state` are symmetric as far as
  /// this rank's part goes.
  virtual bool symmetric(const State& state) const { return true; }
  /// Appends what the step from `begin`, with owned unknowns alone and old histories, to `end` errs in; the same on all
  /// ranks. Collective.
  virtual void step_errors(const State& begin, const State& end, fields::StepErrors& errors) const {}
  /// Appends this rank's parts of totals, the same ones on all ranks in the same order. Local.
  virtual void totals(const State& state, std::vector<Total>& totals) const {}
};

}  // namespace sprekk::assembly
