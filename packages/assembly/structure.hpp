// Structure of an equation system: modules, and the blocks that follow from their declarations.
#pragma once

#include "assembly/bound_module.hpp"
#include "assembly/constraints.hpp"
#include "base/timer.hpp"
#include "fields/block_problem.hpp"

#include <memory>
#include <vector>

namespace sprekk::assembly {

/// Bound modules, and the blocks, couplings and constraints of the system that they form.
struct Structure {
  /// Declares and binds the modules. Throws an Error on all ranks for inconsistent declarations. Collective.
  Structure(RCP<const mesh::Mesh> mesh, std::vector<std::unique_ptr<Module>> modules,
            const std::vector<DirichletCondition>& conditions, RCP<base::Timers> timers);
  Structure(const Structure&) = delete;  // modules and stencils refer to members
  Structure& operator=(const Structure&) = delete;

  const Comm& comm() const { return *mesh->comm; }
  int n_blocks() const { return static_cast<int>(blocks.size()); }
  Context context() const { return {mesh, geometry, layouts, stencils}; }
  /// Returns whether a module stores a quantity.
  bool has_rates() const;
  /// Returns whether rows of a module contain the step length otherwise.
  bool evolves() const;
  /// Returns zero vectors, [block].
  fields::BlockVector create_vector() const;
  /// Returns a zero matrix with all declared blocks. Collective.
  fields::BlockMatrix create_matrix() const;
  /// Sets the rows of prescribed unknowns to zero, [block](owned row).
  void zero_prescribed(const Rows& rows) const;
  /// Sets prescribed unknowns to their values at the last evaluated time, [block](owned unknown).
  void prescribe(const Rows& x) const;

  RCP<const mesh::Mesh> mesh;
  RCP<base::Timers> timers;
  Geometry geometry;
  std::vector<BoundModule> modules;
  std::vector<Unknown> unknowns;        ///< [block]
  std::vector<fields::Layout> layouts;  ///< [block]
  std::shared_ptr<Stencils> stencils;
  std::vector<fields::Block> blocks;
  std::vector<fields::LocalGroup> groups;
  std::vector<Constraints> constraints;  ///< [block]
  std::vector<char> exchanged;           ///< [block] a module reads ghosts
  bool coupled = false;                  ///< balances and other rows depend on each other's fields

 private:
  void declare_fields();
  void declare_groups();
  void add_block(const Unknown& unknown, const fields::Layout& layout);
  std::vector<DirichletCondition> conditions_on(std::size_t block,
                                                const std::vector<DirichletCondition>& conditions) const;
  void bind_modules();
  void find_exchanges();
  bool couples_balances() const;
};

}  // namespace sprekk::assembly
