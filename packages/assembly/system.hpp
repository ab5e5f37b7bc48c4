// Equation system of a list of modules. Blocks, sparsity, ghosts and storage follow from their declarations.
#pragma once

#include "assembly/energy.hpp"
#include "assembly/flux_lag.hpp"
#include "assembly/ghosts.hpp"
#include "assembly/jacobian.hpp"
#include "assembly/rate_history.hpp"
#include "assembly/reactions.hpp"
#include "assembly/row_sizes.hpp"
#include "assembly/scaling.hpp"
#include "assembly/step_accuracy.hpp"
#include "assembly/structure.hpp"
#include "contact/contact.hpp"

#include <memory>
#include <utility>
#include <vector>

namespace sprekk::assembly {

class System : public fields::BlockProblem, private contact::Equations {
 public:
  /// Declares and binds the modules and assembles the linear ones, once. Throws an Error on all ranks for inconsistent
  /// declarations. Collective.
  System(RCP<const mesh::Mesh> mesh, std::vector<std::unique_ptr<Module>> modules,
         const std::vector<DirichletCondition>& conditions, RCP<base::Timers> timers,
         Rates::Scheme scheme = Rates::Scheme::implicit_euler);

  RCP<const Comm> comm() const override { return structure_.mesh->comm; }
  const std::vector<fields::Block>& blocks() const override { return structure_.blocks; }
  const std::vector<fields::LocalGroup>& local_groups() const override { return structure_.groups; }
  void set_time(Real t, Real dt) override;
  void commit(const fields::Evaluation& x) override;
  void residual(const fields::Evaluation& x, fields::BlockVector& r) override;
  void raw_residual(const fields::Evaluation& x, fields::BlockVector& r) override;
  void jacobian(const fields::Evaluation& x) override;
  const fields::BlockMatrix& matrix() const override { return jacobian_.matrix(); }
  std::shared_ptr<fields::SavedRows> share(int block, const RCP<const fields::Matrix>& J) override {
    return jacobian_.share(block, J);
  }
  bool stores() const override { return structure_.coupled || structure_.evolves(); }
  bool symmetric() const override { return jacobian_.symmetric() && !structure_.coupled; }
  bool symmetric_blocks() const override { return jacobian_.symmetric(); }
  ConstView<char*> constrained(int block) const override { return structure_.constraints[block].mask(); }
  std::vector<fields::Measure> measures(const fields::Evaluation& x, const fields::BlockVector& r) override;
  Real merit(const fields::Evaluation& x, const fields::BlockVector& r) override;
  RCP<const fields::Vector> schur(int block) const override { return row_sizes_->schur(block); }
  Real lag(Lag how, const fields::Evaluation& x) override;
  fields::Globalisation& globalisation() override;

  /// Returns the initial state [block]: zero, except for values set by modules.
  fields::BlockVector initial() const;
  /// Returns all outputs of the modules for the last committed state x. Collective.
  std::vector<OutputField> outputs(const fields::BlockVector& x);
  /// Returns the reactions of each condition, [condition], summed over ranks. An unknown with two conditions counts for
  /// the first. Storage terms are omitted. Collective.
  std::vector<Reaction> reactions(const fields::Evaluation& x);
  /// Returns the reactions at the end of the last step, with the rates of storage. Without storage, or before the first
  /// step, returns reactions(x). Collective.
  std::vector<Reaction> reactions_of_step(const fields::BlockVector& x);
  /// Returns the sums of any rows r over the unknowns of each condition. Collective.
  std::vector<Reaction> sums_of_constrained(const fields::BlockVector& r) const {
    return sum_prescribed(structure_, r);
  }
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
    Energy::Sums energy = {};       ///< sums of watch_energy()
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
  void take_over(const fields::BlockVector& x) { convert(x, &Transfer::take_over); }
  /// Converts histories before and after their transfer to a changed mesh, see Transfer::to_conserved. Afterwards, the
  /// system before the change is invalid. Call from_conserved() before resume(). Collective.
  void to_conserved(const fields::BlockVector& x) { convert(x, &Transfer::to_conserved); }
  void from_conserved(const fields::BlockVector& x) { convert(x, &Transfer::from_conserved); }
  /// Passes the unbalanced residual at x to the modules, after resume(). Collective.
  void pass_unbalanced(const fields::Evaluation& x);

  /// Enables step error estimates in each commit. Call at the initial state. Collective.
  void watch_errors(Real duration);
  /// Enables sums of work in each commit, which totals() then contains. They start at the next resume(). Local.
  void watch_energy();
  /// Returns whether a module stores a quantity or evolves with time, so that the step length matters.
  bool has_rates() const { return structure_.has_rates() || evolves(); }
  bool evolves() const { return structure_.evolves(); }  ///< see Declaration::evolves
  /// Returns and clears the step errors since the last call or resume(): the largest error of each name.
  fields::StepErrors take_errors() { return accuracy_ ? accuracy_->take() : fields::StepErrors(); }
  /// Returns the deviation of the loads at x from a linear path in the step of length dt to t. The deviation is
  /// relative to the largest change of the loads in a step so far. Changes the present time. Collective.
  Real bend_of_loads(const fields::Evaluation& x, Real t, Real dt);
  /// Restarts the rate errors, see RateErrors::forget.
  void forget_rates(bool abrupt) { accuracy_->forget(abrupt); }

  /// Returns the contact constraints, [owned fracture face]. Collective.
  std::vector<contact::Constraint> contact_constraints(const fields::Evaluation& x) override;

  const mesh::Mesh& mesh() const { return *structure_.mesh; }
  const std::vector<BoundModule>& modules() const { return structure_.modules; }
  const std::vector<fields::Layout>& layouts() const { return structure_.layouts; }
  const Scales& scales() const { return scaling_.values(); }
  /// Returns whether a module reads ghosts of the block. Such blocks are exchanged once per evaluation.
  bool exchanged(int block) const { return structure_.exchanged[block]; }
  /// Returns a zero matrix with all declared blocks, as filled by jacobian(). Collective.
  fields::BlockMatrix create_matrix() const { return structure_.create_matrix(); }
  /// Computes the residual or Jacobian of one module, for comparison with finite differences. Collective.
  void module_residual(int module, const fields::BlockVector& x, fields::BlockVector& r);
  void module_jacobian(int module, const fields::BlockVector& x, fields::BlockMatrix& J);

  /// Returns the numbers of exchanges of ghosts since the last call. Collective.
  fields::Exchanges take_exchanges() { return ghosts_.take(); }

  const Rates& rates() const { return rate_history_.rates(); }
  /// Returns the increase of the storage from x to x + dx for small dx, without the factor of the rates, minus
  /// artificially_stored(x). Collective.
  fields::BlockVector stored(const fields::Evaluation& x, const fields::BlockVector& dx);
  /// Returns the stabilising storage at x, see ArtificialStorage. Collective.
  fields::BlockVector artificially_stored(const fields::Evaluation& x);

 private:
  State state(const fields::BlockVector& with_ghosts) const;
  const fields::BlockVector& with_ghosts(const fields::Evaluation& x, Ghosts::Which which = Ghosts::Which::read);
  State at(const fields::Evaluation& x, Ghosts::Which which = Ghosts::Which::read);
  void residual_at(const fields::Evaluation& x, const State& state, fields::BlockVector& r);
  void assemble(const BoundModule& module, const State& state, fields::BlockMatrix& J) const;
  fields::BlockVector loads(const fields::Evaluation& x, Real t, Real dt);
  void convert(const fields::BlockVector& x, void (Transfer::*how)(State&) const);
  void watch_contact();
  std::vector<contact::Support> supports_of(int block) const;
  bool linear_part_is_invariant() const;
  std::vector<contact::Constraint> contact_constraints_at(const State& state) const;
  std::vector<char> states(const fields::Evaluation& x) override;
  contact::Sizes sizes() const override;
  void restart_row_sizes() override { row_sizes_->begin_solve(); }

  Structure structure_;
  Scaling scaling_;
  RateHistory rate_history_;
  Jacobian jacobian_;
  Ghosts ghosts_;
  FluxLag flux_lag_;
  std::unique_ptr<RowSizes> row_sizes_;
  std::unique_ptr<StepAccuracy> accuracy_;  // null: errors of steps are not estimated
  std::unique_ptr<Energy> energy_;          // null: works are not summed
  fields::BlockVector load_;                // [block] residual of the linear modules at x = 0 and the present time
  bool loaded_ = false;                     // load_ has been computed
  Real extent_;                             // largest extent of the domain, m
  contact::Blocks contact_blocks_;
  std::unique_ptr<contact::Contact> contact_;  // null without contact and floating blocks
};

}  // namespace sprekk::assembly
