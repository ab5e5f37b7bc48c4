// The list of modules is the equation system: blocks, sparsity, ghosts and storage follow from what they declare.
#pragma once

#include "assembly/constraints.hpp"
#include "assembly/module.hpp"
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

/// The sum of a field's residuals over what a condition holds: of a displacement, what the supports do to the body.
struct Reaction {
  std::string condition, field;
  std::vector<Real> force;       ///< [component], in the unit of the rows: N; N/m in 2D
  std::array<Real, 3> moment{};  ///< sum x cross f about the origin, N m; in 2D the last alone, N
  int region = -1;               ///< that a condition holds in; -1: on a boundary
  Reactions called = {};
};

class RateErrors;

class System : public fields::BlockProblem, private contact::Equations {
 public:
  /// Declares and binds the modules and assembles the linear ones, once. Collective.
  System(RCP<const mesh::Mesh> mesh, std::vector<std::unique_ptr<Module>> modules,
         const std::vector<DirichletCondition>& conditions, RCP<base::Timers> timers,
         Rates::Scheme scheme = Rates::Scheme::implicit_euler);
  ~System() override;
  System(const System&) = delete;  // modules and stencils know where its parts are
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

  /// Zero but for what modules know of the initial state. [block]
  fields::BlockVector initial() const;
  /// Everything the modules can show of the last committed state x.
  std::vector<OutputField> outputs(const fields::BlockVector& x);
  /// The reactions of the unknowns that each condition holds, [condition], summed up; an unknown held by two conditions
  /// counts for the first. Collective.
  std::vector<Reaction> reactions(const fields::BlockVector& x);
  /// The reactions at the end of the last step, with the rates of storage. Without storage, or before the first step,
  /// those at x. Collective.
  std::vector<Reaction> reactions_of_step(const fields::BlockVector& x);
  /// The same sums of any rows r. Collective.
  std::vector<Reaction> sums_of_held(const fields::BlockVector& r) const;
  /// Those of all modules, summed over the ranks. Collective.
  std::vector<Total> totals(const fields::BlockVector& x);

  /// What the modules keep, as "MODULE: HISTORY", and what was stored in the last step, as "gain of FIELD"; the values,
  /// [owned entity, component], may be written. And the rates that errors of steps are found by.
  std::vector<std::pair<fields::Field, View<Real**>>> histories(bool rates = true) const;
  /// What a system has learnt on its way to the last committed state, besides histories.
  struct Memory {
    Real t = 0, dt = 0;             ///< the time of that state, and of the step to it
    Scales scales;                  ///< of the loads so far
    std::vector<Real> calibration;  ///< see contact::Contact
    std::vector<Real> errors;       ///< what watch_errors() needs
  };
  Memory memory() const;  ///< stored data
  /// Goes on from x and the histories that go with it. Throws like set_time. Collective.
  void resume(const fields::BlockVector& x, const Memory& memory);

  /// Sets unknowns that are prescribed to what they are at t. Collective.
  void prescribe(Real t, fields::BlockVector& x);
  /// What modules pass on to those of a system that goes on from x in this one's place, by the names of histories().
  /// Collective.
  std::vector<std::pair<fields::Field, View<Real**>>> passed_on(const fields::BlockVector& x);
  /// Lets modules take over x and the histories, which come from another system; before resume(). Collective.
  void take_over(const fields::BlockVector& x);
  /// Lets modules know what is out of balance at x after that. Collective.
  void tell_unbalanced(const fields::BlockVector& x);

  /// From now on each commit finds what its step errs in; to be called at the initial state. Collective.
  void watch_errors(Real duration);
  /// Rates count: some modules store something from step to step.
  bool has_rates() const;
  /// Of the steps committed since the last call of this or of resume(), the largest by each name.
  fields::StepErrors take_errors() { return std::exchange(errors_, {}); }
  /// How far loads at x leave, within a step to t of length dt, the straight line between its ends, relative to the
  /// most that they have changed in a step so far; it changes the present time. Collective.
  Real bend_of_loads(const fields::BlockVector& x, Real t, Real dt);
  /// See RateErrors::forget.
  void forget_rates(bool jump);

  /// [owned fracture face]. Collective.
  std::vector<contact::Grip> grips(const fields::BlockVector& x) override;

  const mesh::Mesh& mesh() const { return *mesh_; }
  const std::vector<std::unique_ptr<Module>>& modules() const { return modules_; }
  const std::vector<fields::Layout>& layouts() const { return layouts_; }
  const Scales& scales() const { return scales_; }
  /// True for a block whose ghosts some module reads, and which is therefore exchanged, once, for every residual.
  bool exchanged(int block) const { return needs_ghosts_[block]; }
  /// A matrix with all declared blocks, zero; what jacobian() fills. Collective.
  fields::BlockMatrix create_matrix() const;
  /// The residual and the Jacobian of one module alone, for checks against finite differences. Collective.
  void module_residual(int module, const fields::BlockVector& x, fields::BlockVector& r);
  void module_jacobian(int module, const fields::BlockVector& x, fields::BlockMatrix& J);

  const Rates& rates() const { return rates_; }
  /// By how much more is stored at x + dx than at x, for small dx, without the factor of the rates, less what modules
  /// store at x that belongs to no equation (Module::artificial). Collective.
  fields::BlockVector stored(const fields::BlockVector& x, const fields::BlockVector& dx);
  /// The latter alone. Collective.
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
  State state(int module) const;
  bool keeps_gains() const { return scheme_ != Rates::Scheme::implicit_euler; }
  void declare_gains();
  void find_gains();
  void find_unbalanced(const fields::BlockVector& x);
  void find_errors(const fields::BlockVector& x);
  void resume_errors(const fields::BlockVector& x, const std::vector<Real>& memory);
  fields::BlockVector loads(const fields::BlockVector& x, Real t, Real dt);
  fields::Field history_field(std::size_t module, const History& history) const;
  std::string history_name(std::size_t module, const History& history) const;
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
  std::vector<std::unique_ptr<Module>> modules_;
  std::vector<Declaration> declarations_;  // [module]
  std::vector<Unknown> unknowns_;          // [block]
  std::vector<fields::Layout> layouts_;    // [block]
  std::shared_ptr<Stencils> stencils_;
  std::vector<fields::Block> blocks_;
  std::vector<fields::LocalGroup> groups_;
  std::vector<Constraints> constraints_;            // [block]
  std::vector<std::vector<View<Real**>>> history_;  // [module][number](owned entity, component)
  std::vector<View<Real**>> gains_;  // [block](owned entity, component) what was stored more in the last step, or empty
  std::vector<char> needs_ghosts_;   // [block]
  fields::BlockVector ghosted_;      // [block] unknowns with ghosts
  fields::BlockVector weights_;      // [block] of merit(); null: 1/|diagonal|
  fields::BlockVector diagonals_;    // [block] of linear_; of balances that couple to other rows: of matrix_
  fields::BlockVector present_;      // [block] the same of the last jacobian()
  fields::BlockVector schur_;        // [block] of the last jacobian(); null: none
  fields::BlockVector at_end_;       // [block] residual at the end of the last step; empty: nothing stored, or none
  fields::BlockVector unbalanced_;   // [block] the same, zero in rows of prescribed unknowns
  fields::BlockVector load_;         // [block] residual of the linear modules at x = 0, time t_
  contact::Blocks contact_blocks_;   // without a displacement where modules hold bodies
  std::unique_ptr<contact::Contact> contact_;  // null where nothing touches and all is held
  fields::BlockMatrix linear_;                 // what the linear modules write
  fields::BlockMatrix matrix_;                 // df/dx; shares the blocks that only linear modules write
  std::vector<ScaleRelation> relations_;
  Scales scales_;
  ConstView<Real*> coefficients_;  // [local fracture face] of lag(), empty: those of x
  Relaxation lagged_;              // [local fracture face] of the logarithms of coefficients_
  RCP<base::Timers> timers_;
  std::unique_ptr<RateErrors> rate_errors_;  // if errors of steps are watched
  fields::BlockVector committed_x_;          // likewise
  std::vector<Real> load_change_;  // likewise, of [block] loads and [block] prescribed values, the most of a step
  fields::StepErrors errors_;      // of the last steps
  Rates::Scheme scheme_;
  Real extent_;  // largest of the domain, m
  Rates rates_;
  Real committed_t_ = 0, committed_dt_ = 0;  // of the last committed step; 0 before the first
  Real t_ = 0, dt_ = 0;
  bool symmetric_ = true, loaded_ = false;
  bool coupled_ = false;       // balances of rates and other rows depend on each other's fields
  std::vector<char> carried_;  // [block] see Declaration::carries
  bool changing_ = false;      // the diagonals of balances are found anew in each step
  bool sized_ = false;         // diagonals_ of balances are those of this step's first Jacobian, with schur_
};

}  // namespace sprekk::assembly
