// Equation system of a list of modules. Blocks, sparsity, ghosts and storage follow from their declarations.
#pragma once

#include "assembly/bound_module.hpp"
#include "assembly/constraints.hpp"
#include "assembly/rates.hpp"
#include "assembly/relaxation.hpp"
#include "base/timer.hpp"
#include "contact/contact.hpp"
#include "fields/block_problem.hpp"

#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace sprekk::assembly {

/// Sum of the residuals of a field over the unknowns that a condition prescribes. For displacements: force of the
/// supports on the body.
struct Reaction {
  std::string condition, field;
  std::vector<Real> force;       ///< [component], in the unit of the rows, e.g. N (2D: N/m)
  std::array<Real, 3> moment{};  ///< sum x cross f about the origin, N m; in 2D only the last component, N
  int region = -1;               ///< region of the condition; -1: on a boundary
  Reactions called = {};
};

class RateErrors;

class System : public fields::BlockProblem, private contact::Equations {
 public:
  /// Declares and binds the modules and assembles the linear ones, once. Throws an Error on all ranks for inconsistent
  /// declarations. Collective.
  System(RCP<const mesh::Mesh> mesh, std::vector<std::unique_ptr<Module>> modules,
         const std::vector<DirichletCondition>& conditions, RCP<base::Timers> timers,
         Rates::Scheme scheme = Rates::Scheme::implicit_euler);
  ~System() override;
  System(const System&) = delete;  // modules and stencils refer to members
  System& operator=(const System&) = delete;

  RCP<const Comm> comm() const override { return mesh_->comm; }
  const std::vector<fields::Block>& blocks() const override { return blocks_; }
  const std::vector<fields::LocalGroup>& local_groups() const override { return groups_; }
  void set_time(Real t, Real dt) override;
  void commit(const fields::BlockVector& x) override;
  void residual(const fields::BlockVector& x, fields::BlockVector& r) override;
  void raw_residual(const fields::BlockVector& x, fields::BlockVector& r) override;
  void jacobian(const fields::BlockVector& x) override;
  const fields::BlockMatrix& matrix() const override { return matrix_; }
  std::shared_ptr<fields::KeptRows> share(int block, const RCP<const fields::Matrix>& J) override;
  bool stores() const override { return coupled_; }
  bool symmetric() const override { return symmetric_ && !coupled_; }
  bool symmetric_blocks() const override { return symmetric_; }
  ConstView<char*> constrained(int block) const override { return constraints_[block].mask(); }
  std::vector<fields::Measure> measures(const fields::BlockVector& x, const fields::BlockVector& r) override;
  Real merit(const fields::BlockVector& x, const fields::BlockVector& r) override;
  RCP<const fields::Vector> schur(int block) const override { return schur_[block]; }
  Real lag(Lag how, const fields::BlockVector& x) override;
  fields::Globalisation& globalisation() override;

  /// Returns the initial state [block]: zero, except for values set by modules.
  fields::BlockVector initial() const;
  /// Returns all outputs of the modules for the last committed state x. Collective.
  std::vector<OutputField> outputs(const fields::BlockVector& x);
  /// Returns the reactions of each condition, [condition], summed over ranks. An unknown with two conditions counts for
  /// the first. Storage terms are omitted. Collective.
  std::vector<Reaction> reactions(const fields::BlockVector& x);
  /// Returns the reactions at the end of the last step, with the rates of storage. Without storage, or before the first
  /// step, returns reactions(x). Collective.
  std::vector<Reaction> reactions_of_step(const fields::BlockVector& x);
  /// Returns the sums of any rows r over the unknowns of each condition. Collective.
  std::vector<Reaction> sums_of_held(const fields::BlockVector& r) const;
  /// Returns the totals of all modules, summed over the ranks. Collective.
  std::vector<Total> totals(const fields::BlockVector& x);

  /// Returns the histories "MODULE: HISTORY", and the storage increases of the last step, "gain of FIELD". The values
  /// [owned entity, component] may be overwritten. With `rates`, the rates for step errors are included.
  std::vector<std::pair<fields::Field, View<Real**>>> histories(bool rates = true) const;
  /// Data besides histories that describe the way to the last committed state.
  struct Memory {
    Real t = 0, dt = 0;             ///< time of the committed state, length of the step to it
    Scales scales;                  ///< scales of the loads so far
    std::vector<Real> calibration;  ///< see contact::Contact
    std::vector<Real> errors;       ///< data of watch_errors()
  };
  Memory memory() const;  ///< Returns this data for a checkpoint. Local.
  /// Continues from x and the histories, which belong to x. Throws an Error for missing scales, and like set_time.
  /// Collective.
  void resume(const fields::BlockVector& x, const Memory& memory);

  /// Sets prescribed unknowns to their values at t. Throws an Error on all ranks, see Constraints::evaluate.
  /// Collective.
  void prescribe(Real t, fields::BlockVector& x);
  /// Returns the histories for a system that continues from x, with the names of histories(). See Transfer::pass_on.
  /// Collective.
  std::vector<std::pair<fields::Field, View<Real**>>> passed_on(const fields::BlockVector& x);
  /// Lets modules take over x and the histories of another system. Call before resume(). Collective.
  void take_over(const fields::BlockVector& x);
  /// Passes the unbalanced residual at x to the modules, after resume(). Collective.
  void tell_unbalanced(const fields::BlockVector& x);

  /// Enables step error estimates in each commit. Call at the initial state. Collective.
  void watch_errors(Real duration);
  /// Returns whether a module stores a quantity, so that the step length matters.
  bool has_rates() const;
  /// Returns and clears the step errors since the last call or resume(): the largest error of each name.
  fields::StepErrors take_errors() { return std::exchange(errors_, {}); }
  /// Returns the deviation of the loads at x from a linear path in the step of length dt to t. The deviation is
  /// relative to the largest change of the loads in a step so far. Changes the present time. Collective.
  Real bend_of_loads(const fields::BlockVector& x, Real t, Real dt);
  /// Restarts the rate errors, see RateErrors::forget.
  void forget_rates(bool jump);

  /// Returns the contact constraints, [owned fracture face]. Collective.
  std::vector<contact::Grip> grips(const fields::BlockVector& x) override;

  const mesh::Mesh& mesh() const { return *mesh_; }
  const std::vector<BoundModule>& modules() const { return modules_; }
  const std::vector<fields::Layout>& layouts() const { return layouts_; }
  const Scales& scales() const { return scales_; }
  /// Returns whether a module reads ghosts of the block. Such blocks are exchanged once per residual.
  bool exchanged(int block) const { return needs_ghosts_[block]; }
  /// Returns a zero matrix with all declared blocks, as filled by jacobian(). Collective.
  fields::BlockMatrix create_matrix() const;
  /// Computes the residual or Jacobian of one module, for comparison with finite differences. Collective.
  void module_residual(int module, const fields::BlockVector& x, fields::BlockVector& r);
  void module_jacobian(int module, const fields::BlockVector& x, fields::BlockMatrix& J);

  const Rates& rates() const { return rates_; }
  /// Returns the increase of the storage from x to x + dx for small dx, without the factor of the rates, minus
  /// artificially_stored(x). Collective.
  fields::BlockVector stored(const fields::BlockVector& x, const fields::BlockVector& dx);
  /// Returns the stabilising storage at x, see ArtificialStorage. Collective.
  fields::BlockVector artificially_stored(const fields::BlockVector& x);

 private:
  Context context() const { return {mesh_, geometry_, layouts_, stencils_}; }
  void declare_fields();
  void declare_scales();
  bool couples_balances() const;
  std::vector<DirichletCondition> conditions_on(std::size_t block,
                                                const std::vector<DirichletCondition>& conditions) const;
  void set_multigrid(const Unknown& unknown, const fields::Layout& layout, fields::Block& block) const;
  void declare_groups();
  void bind_modules();
  void create_matrices();
  void assemble_linear();
  void start_matrix();
  void assemble_balances();
  void set_merit_weights();
  void find_exchanges();
  std::vector<contact::Support> supports_of(int displacement) const;
  void watch_contact();
  State state(const BoundModule& module) const;
  bool keeps_gains() const { return scheme_ != Rates::Scheme::implicit_euler; }
  void declare_gains();
  void find_gains();
  void find_unbalanced(const fields::BlockVector& x);
  void find_errors(const fields::BlockVector& x);
  void resume_errors(const fields::BlockVector& x, const std::vector<Real>& memory);
  fields::BlockVector loads(const fields::BlockVector& x, Real t, Real dt);
  void refresh_ghosts(const fields::BlockVector& x, bool all);
  Rows rows(fields::BlockVector& r) const;
  Real rounding(const fields::BlockVector& x, const std::string& scale) const;
  View<Real*> rounding_of_others(int b, const fields::BlockVector& x) const;
  void update_scales(Real t);
  void find_schur();
  std::vector<contact::Grip> evaluate(const fields::BlockVector& x, fields::BlockVector& r) override;
  std::vector<contact::Grip> present_grips();
  std::vector<char> states(const fields::BlockVector& x) override;
  contact::Sizes sizes() const override;
  void begin_anew() override { present_.clear(); }
  bool linear_part_is_invariant() const;

  RCP<const mesh::Mesh> mesh_;
  Geometry geometry_;
  std::vector<BoundModule> modules_;
  std::vector<Unknown> unknowns_;        // [block]
  std::vector<fields::Layout> layouts_;  // [block]
  std::shared_ptr<Stencils> stencils_;
  std::vector<fields::Block> blocks_;
  std::vector<fields::LocalGroup> groups_;
  std::vector<Constraints> constraints_;  // [block]
  std::vector<View<Real**>> gains_;  // [block](owned entity, component) storage increase of the last step, or empty
  std::vector<char> needs_ghosts_;   // [block]
  fields::BlockVector ghosted_;      // [block] unknowns with ghosts
  fields::BlockVector weights_;      // [block] weights of merit(); null: 1/|diagonal|
  fields::BlockVector diagonals_;    // [block] of linear_; coupled balances: of matrix_
  fields::BlockVector present_;      // [block] diagonals of the last jacobian()
  fields::BlockVector schur_;        // [block] Schur complements of the last jacobian(); null: none
  fields::BlockVector at_end_;       // [block] residual at the end of the last step; empty: no storage or no step
  fields::BlockVector unbalanced_;   // [block] at_end_, zero in rows of prescribed unknowns
  fields::BlockVector load_;         // [block] residual of the linear modules at x = 0 and time t_
  contact::Blocks contact_blocks_;   // without displacement if modules support bodies
  std::unique_ptr<contact::Contact> contact_;  // null without contact and floating blocks
  fields::BlockMatrix linear_;                 // part of the linear modules
  fields::BlockMatrix matrix_;                 // df/dx; shares the blocks of linear modules alone
  std::vector<ScaleRelation> relations_;
  Scales scales_;
  ConstView<Real*> coefficients_;  // [local fracture face] of lag(); empty: computed from x
  Relaxation lagged_;              // [local fracture face] logarithms of coefficients_
  RCP<base::Timers> timers_;
  std::unique_ptr<RateErrors> rate_errors_;  // null: errors of steps are not estimated
  fields::BlockVector committed_x_;          // likewise
  std::vector<Real> load_change_;  // likewise; [block] loads, then [block] prescribed values: largest change in a step
  fields::StepErrors errors_;      // of the steps since take_errors()
  Rates::Scheme scheme_;
  Real extent_;  // largest extent of the domain, m
  Rates rates_;
  Real committed_t_ = 0, committed_dt_ = 0;  // last committed step; 0 before the first
  Real t_ = 0, dt_ = 0;
  bool symmetric_ = true, loaded_ = false;
  bool coupled_ = false;       // balances and other rows depend on each other's fields
  std::vector<char> carried_;  // [block] see Declaration::carries
  bool changing_ = false;      // diagonals of balances are updated in each step
  bool sized_ = false;         // diagonals_ of balances are those of this step's first Jacobian, with schur_
};

}  // namespace sprekk::assembly
