// Interface between physics and solvers: all that a solver knows of a problem.
#pragma once

#include "fields/block_matrix.hpp"
#include "fields/evaluation.hpp"
#include "fields/globalisation.hpp"

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace sprekk::fields {

/// Near-null-space vectors of a matrix, [owned unknown, mode], computed on demand. make() is collective if n() > 0.
class Modes {
 public:
  Modes() = default;
  Modes(int n, std::function<RCP<const MultiVector>()> make) : n_(n), make_(std::move(make)) {}

  int n() const { return n_; }  ///< number of vectors
  RCP<const MultiVector> make() const { return n_ > 0 ? make_() : Teuchos::null; }

 private:
  int n_ = 0;
  std::function<RCP<const MultiVector>()> make_;
};

/// Block of unknowns. The unknowns of one entity (node, fracture face) are adjacent: entity * n_components + component,
/// in local and in global numbering.
struct Block {
  std::string name;
  RCP<const Map> map;                  ///< owned unknowns
  int n_components;                    ///< unknowns per entity
  Real kinematic_scale;                ///< typical size of an unknown under the present loads
  Real residual_scale;                 ///< typical size of a row under the present loads
  RCP<const MultiVector> coordinates;  ///< [owned entity, dim], m; null if not used by multigrid
  Modes near_null_space;               ///< empty if not used by multigrid
  /// Interpolation from the unknowns of a first coarse space to those of the block: from order 1 to order 2, or from
  /// corners to facets. Multigrid then starts from the coarse space, and coordinates and near_null_space are those of
  /// its unknowns. Null: multigrid starts from the block.
  RCP<const CrsMatrix> interpolation = {};
  /// Disjoint sets of owned unknowns with strong couplings that multigrid does not represent. With an interpolation
  /// and one component, the smoother of the block solves for each set exactly.
  std::vector<std::vector<LocalIndex>> patches = {};
  std::string enriches = "";        ///< block enriched by this one; multigrid smooths both together
  std::string condensed_into = "";  ///< its matrix is nearly diagonal: preconditioners eliminate it into this block
  bool advected = false;            ///< advected by a flow: its matrix may be far from symmetric
  bool balance = false;             ///< its rows are rate balances, which may differ by many orders of magnitude
  std::string quantity = "";        ///< quantity of these balances; blocks with the same one exchange it
};

/// Blocks with couplings among themselves within one entity only, eliminated entity by entity. The i-th owned entity
/// has the unknowns i * n_components(b) ... of every block b of the group.
struct LocalGroup {
  std::string name;
  std::vector<int> blocks;
};

/// Measure of convergence, relative to the loads. The solution has converged if no value exceeds the tolerance.
struct Measure {
  std::string name;
  Real value;
};

/// Nonlinear problem f(x; committed state, t) = 0. residual() and jacobian() depend on x without side effects on the
/// state. Only set_time() and commit() change the state. All members are collective unless they return stored data.
class BlockProblem {
 public:
  virtual ~BlockProblem() = default;

  virtual RCP<const Comm> comm() const = 0;
  virtual const std::vector<Block>& blocks() const = 0;
  virtual const std::vector<LocalGroup>& local_groups() const = 0;

  /// Sets the end t and the length dt of the next time step, in s.
  virtual void set_time(Real t, Real dt) = 0;
  /// Accepts x as the state at the current time and updates the history variables. Before this call the state is
  /// unchanged, so a failed step can restart from the last accepted x.
  virtual void commit(const Evaluation& x) = 0;

  /// Computes r = f(x). The row of a constrained unknown is x - x_D(t).
  virtual void residual(const Evaluation& x, BlockVector& r) = 0;
  /// Computes r without constraints. The rows of constrained unknowns are the reactions.
  virtual void raw_residual(const Evaluation& x, BlockVector& r) = 0;
  /// Assembles matrix() = df/dx at x, without constraints: rows and columns of constrained unknowns are included.
  virtual void jacobian(const Evaluation& x) = 0;
  virtual const BlockMatrix& matrix() const = 0;
  /// Stores a constant diagonal block of matrix() in J to save memory. The local columns of J must begin with those of
  /// the block. J must contain the values of the block and zeros elsewhere. Returns the object that saves values of the
  /// block before J is changed. If the block is already shared, its saved values are restored in J. Returns null if the
  /// block is not constant; it then remains in matrix().
  virtual std::shared_ptr<SavedRows> share(int block, const RCP<const Matrix>& J) { return nullptr; }
  /// True if f depends on the length of the time step, by storage or by other rates. Shorter steps are then easier to
  /// solve. Otherwise only the loads depend on the step.
  virtual bool stores() const { return false; }
  /// True if the present matrix() is symmetric after elimination of the local groups.
  virtual bool symmetric() const = 0;
  /// True if the diagonal blocks of the present matrix() are symmetric.
  virtual bool symmetric_blocks() const { return symmetric(); }
  /// Flags of the unknowns with prescribed values: 1, else 0. [owned unknown]
  virtual ConstView<char*> constrained(int block) const = 0;

  /// Measures of convergence of x with r = residual(x), at least one for each unit.
  virtual std::vector<Measure> measures(const Evaluation& x, const BlockVector& r) = 0;
  /// Squared energy norm of r, for line searches.
  virtual Real merit(const Evaluation& x, const BlockVector& r) = 0;
  /// Estimate of the contribution of all other blocks to the diagonal of a block, if they were eliminated. [owned
  /// unknown], for the Jacobian of the last jacobian(), for preconditioners. Null if there is no contribution.
  virtual RCP<const Vector> schur(int block) const { return Teuchos::null; }
  enum class Lag { none, follow, widest };
  /// Fixes the flux coefficients of f from now on. They may depend on x by high powers, which misleads Newton's method
  /// far from a solution.
  /// * none: the coefficients depend on x again.
  /// * follow: at the first call, the values at x; in later calls, values closer to those at x.
  /// * widest: the largest values possible under the present loads.
  /// Returns the largest |ln| of the ratio of the values at x to the previous fixed ones. Returns a negative number if
  /// there are no such coefficients; f is then unchanged. Collective.
  virtual Real lag(Lag how, const Evaluation& x) { return -1; }
  /// Globalisation of Newton's method, for f that is not smooth.
  virtual Globalisation& globalisation() { return smooth_; }

 private:
  Globalisation smooth_;
};

}  // namespace sprekk::fields
