// Interface of a physics module: names, declarations, and contributions to residuals and Jacobian blocks.
#pragma once

#include "assembly/geometry.hpp"
#include "assembly/loop.hpp"
#include "contact/constraint.hpp"
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

/// Typical sizes by name. Solvers and convergence tests are relative to them. They grow with the loads and never
/// shrink.
using Scales = std::map<std::string, Real>;

/// Inequality scale(larger) >= factor scale(than).
struct ScaleRelation {
  std::string larger;
  Real factor;
  std::string than;
};

/// Term factor * scale, divided by the length of the time step if `per_step`.
struct SizeTerm {
  std::string scale;
  Real factor = 1;
  bool per_step = false;
};

/// Typical size of a row, as a sum of terms.
using Size = std::vector<SizeTerm>;

/// Near-null space of the block's matrix, for multigrid. none: the block is unsuitable for multigrid.
enum class NearNullSpace { none, rigid_motions, constants };

/// Names in results.json for the sums of residuals over the unknowns that a condition prescribes. `name` is the entry
/// of boundaries. Empty: no output.
struct Reactions {
  std::string name = "";
  std::string moments = "";    ///< for forces: sum x cross f
  std::string regions = "";    ///< entry for conditions in regions
  std::string unit = "";       ///< unit of the sums
  std::string fractures = "";  ///< entry for conditions on fractures
};

/// Field that a module adds to the problem. It becomes a block of the same name.
struct Unknown {
  fields::Field field;
  std::string scale;  ///< typical size of its values; prescribed values count as loads of this scale
  Size row;           ///< typical size of its rows; other modules may add terms, see Declaration::sizes
  NearNullSpace near_null_space = NearNullSpace::none;
  std::string local_group = "";     ///< group of fields eliminated together, entity by entity; "": not eliminated
  std::string enriches = "";        ///< field that this one enriches; zero where that field is prescribed
  std::string condensed_into = "";  ///< field from which preconditioners eliminate this weakly self-coupled one
  /// The rows are balances of rates: fluxes plus State::rate times the storage. Sizes may differ by orders of
  /// magnitude. Therefore each row is measured by its diagonal, updated in each step.
  bool balance = false;
  /// Values may exceed their scale by orders of magnitude. Their round-off counts in the rows of other fields.
  bool unbounded = false;
  /// For contact forces on faces: scale of the differences of both sides in their rows. The rows contain these
  /// differences times contact::Constraint::augmentation.
  std::string augmented_by = "";
  Reactions reactions = {};
};

/// Rows to which the module adds in a loop, and the fields on which these contributions depend.
struct Coupling {
  Loop loop;
  std::string row;
  std::vector<std::string> columns;
};

/// History variable of a module on owned entities. It changes at commit only.
struct History {
  std::string name;
  fields::Entity entity;
  int n_components;
  bool is_amount = false;      ///< see fields::Field
  bool is_transferred = true;  ///< false: has no values on a bisected mesh, e.g. numbers of the faces of a cell
};

/// Number derived from the components of a mean or integral over a fracture; no value: undefined.
struct Derived {
  std::string name, unit;
  std::function<std::optional<Real>(const std::vector<Real>&)> of;
};

/// Events of an integral: intervals in which it changes, listed in events.csv with the change of a mean and a number
/// derived from the change of the integral.
struct Events {
  std::string mean;  ///< name of a Summary with a mean
  Derived derived;
};

/// Entry of an output on fracture faces in results.json, for each fracture.
/// - mean, mean_and_max: area mean "mean_NAME" (vectors: in the named frame), and the largest value "max_NAME"
/// - fractions: area "area_CLASS" and area fraction "fraction_CLASS" of the faces in state 0, 1, ...
/// - integral: integral over the area, "NAME"; the output is not written to result files
/// - error_bound: largest bound of the relative error of NAME, "error_of_NAME"; once more for all fractures at the
///   run's end
struct Summary {
  enum Kind { none, mean, mean_and_max, fractions, integral, error_bound };
  Kind kind = none;
  std::string name = "";                  ///< spaces become underscores
  std::string frame = "";                 ///< for vectors
  std::vector<std::string> classes = {};  ///< for fractions; an empty name has no entry
  std::string unit = "";                  ///< for an integral
  std::vector<Derived> derived = {};      ///< from the mean or integral
  std::optional<Events> events = {};      ///< for an integral
};

/// Output array on owned cells or faces, or on all local nodes: [entity * n_components + component]. Global
/// coordinates, unless the name contains "local".
struct OutputField {
  std::string name, unit;
  fields::Entity entity;
  int n_components;
  Summary summary = {};
  std::vector<Real> values = {};
};

struct State;

/// Output without values, and the function that computes the values from a committed state. The function is local.
struct Output {
  OutputField field;
  std::function<std::vector<Real>(const State&)> values;
};

/// Number that describes a state: sum over the ranks. Its names are the path in results.json. Totals with equal names
/// are added.
struct Total {
  std::vector<std::string> names;
  Real value;
  std::string unit = "";
};

/// Declaration from which the framework derives sparsity, ghost exchange, storage and output.
struct Declaration {
  std::vector<Unknown> unknowns;
  std::vector<Coupling> couplings;
  std::vector<History> history;
  std::vector<Output> outputs;
  Scales scales;  ///< values without loads, > 0; several modules may declare the same scale
  std::vector<ScaleRelation> relations;
  std::vector<std::pair<std::string, SizeTerm>> sizes;  ///< (field, term added to the size of its rows)
  std::vector<std::string> schur;                       ///< fields to which RowWeights::add_schur() adds
  std::vector<std::string> carries;  ///< balances with advection by another flow; the flow may begin within a step, so
                                     ///< the present Jacobian's diagonal measures their rows
  bool stores = false;               ///< its balances contain State::rate times the storage
  bool evolves = false;              ///< its rows contain State::dt; shorter steps are easier to solve
  bool linear = false;               ///< constant, symmetric Jacobian: assembled once; the residual is K x + r(0, t)
};

/// Mesh and stencils to which modules are bound once.
class Context {
 public:
  Context(RCP<const mesh::Mesh> mesh, const Geometry& geometry, const std::vector<fields::Layout>& layouts,
          std::shared_ptr<Stencils> stencils)
      : mesh_(mesh), geometry_(geometry), layouts_(&layouts), stencils_(std::move(stencils)) {}
  RCP<const mesh::Mesh> mesh() const { return mesh_; }
  const Geometry& geometry() const { return geometry_; }
  int field(const std::string& name) const;  ///< block number of the field; throws an Error for unknown names
  const fields::Layout& layout(int field) const { return (*layouts_)[field]; }
  const Stencil& stencil(Loop loop, int field) const { return stencils_->of(loop, field); }

 private:
  RCP<const mesh::Mesh> mesh_;
  Geometry geometry_;
  const std::vector<fields::Layout>* layouts_;
  std::shared_ptr<Stencils> stencils_;
};

/// State at which a residual is evaluated: unknowns with ghosts [field](unknown), histories of the module
/// [number](entity, component).
struct State {
  Real t = 0;
  Real rate = 0;    ///< factor of the storage increase in the step, 1/s: Rates::now
  Real before = 0;  ///< Rates::before; the framework subtracts the storage increase of the previous step
  Real dt = 0;      ///< length of the step, s; 0 outside of a step
  contact::Regularisation contact = {};
  ConstView<Real*> coefficients = {};  ///< [local fracture face] see BlockProblem::lag(); empty: computed from x
  std::vector<ConstView<Real*>> x;
  std::vector<View<Real**>> history;
  /// Residual at the end of the last step, for Totals only: [field](owned row), zero in rows of prescribed unknowns. A
  /// flow is the product of a large conductance and a small difference. Adding the residual removes its round-off.
  /// Empty: no module stores anything.
  std::vector<ConstView<Real*>> unbalanced = {};
};

/// Owned rows, [field](row).
using Rows = std::vector<View<Real*>>;

/// Part of an equation system. Classes of modules also inherit the optional interfaces of capabilities.hpp that they
/// implement.
class Module {
 public:
  virtual ~Module() = default;
  virtual std::string name() const = 0;
  /// Returns the parameters that, besides the scene, must be equal when a checkpoint is restored; the same on all
  /// ranks.
  virtual std::string fingerprint() const { return {}; }
  /// Informs the module of the fields of all modules. declare() is called before and after. The first call provides the
  /// unknowns, which must not depend on other modules. The second call is final.
  virtual void set_fields(const std::set<std::string>& fields) {}
  /// Returns the declaration. Collective.
  virtual Declaration declare(const mesh::Mesh& mesh) const = 0;
  /// Builds the module's tables and constant operators. Called once. Collective: errors of single ranks must be thrown
  /// last.
  virtual void bind(const Context& context) = 0;

  /// Adds the module's part of the residual, including loads at state.t. Local: no communication.
  virtual void residual(const State& state, const Rows& r) const = 0;
  /// Adds the derivative of residual() to the blocks of owned rows. Local: no communication.
  virtual void jacobian(const State& state, fields::BlockMatrix& J) const = 0;

  /// Returns whether the diagonal blocks of this rank's Jacobian at `state` are symmetric after local elimination.
  virtual bool symmetric(const State& state) const { return true; }
};

}  // namespace sprekk::assembly
