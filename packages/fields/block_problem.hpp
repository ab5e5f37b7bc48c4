// What a solver needs to know of a problem, and all that it may know: the meeting point of physics and solve.
#pragma once

#include "fields/block_matrix.hpp"
#include "fields/globalisation.hpp"

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace sprekk::fields {

/// Vectors that a matrix makes small, [owned unknown, mode], which are made when they are asked for. make() is
/// collective where there are any.
class Modes {
 public:
  Modes() = default;
  Modes(int n, std::function<RCP<const MultiVector>()> make) : n_(n), make_(std::move(make)) {}

  int n() const { return n_; }  ///< 0: there are none
  RCP<const MultiVector> make() const { return n_ > 0 ? make_() : Teuchos::null; }

 private:
  int n_ = 0;
  std::function<RCP<const MultiVector>()> make_;
};

/// A block of unknowns. The unknowns of one entity (node, fracture face) are adjacent: entity * n_components +
/// component, in local and in global numbering.
struct Block {
  std::string name;
  RCP<const Map> map;                  ///< owned unknowns
  int n_components;                    ///< unknowns per entity
  Real kinematic_scale;                ///< typical size of an unknown of this block under the present loads
  Real residual_scale;                 ///< typical size of a row of this block under the present loads
  RCP<const MultiVector> coordinates;  ///< [owned entity, dim], metre; null where multigrid has no use for it
  Modes near_null_space;               ///< none likewise
  /// Of order 2: from the unknowns of order 1 that multigrid starts from, and that coordinates and near_null_space
  /// belong to, to those of the block. Null: multigrid starts from the block itself.
  RCP<const CrsMatrix> interpolation = {};
  std::string enriches = "";        ///< the block whose functions it adds to: multigrid smooths it with that one
  std::string condensed_into = "";  ///< its own matrix is about diagonal: preconditioners eliminate it from this block
  bool advected = false;            ///< a flow carries it: its own matrix may be far from symmetric
  bool balance = false;             ///< its rows are balances of rates: they may differ by many orders of magnitude
};

/// Blocks whose unknowns couple only within one entity among themselves, so that they can be eliminated entity by
/// entity. The i-th owned entity holds the unknowns i * n_components(b) ... of every block b of the group.
struct LocalGroup {
  std::string name;
  std::vector<int> blocks;
};

/// One measure of convergence, relative to the loads: converged when every value is at or below the tolerance.
struct Measure {
  std::string name;
  Real value;
};

/// f(x; committed state, t) = 0. residual and jacobian are pure in x: state changes only by set_time and commit.
/// All members are collective unless they return stored data.
class BlockProblem {
 public:
  virtual ~BlockProblem() = default;

  virtual RCP<const Comm> comm() const = 0;
  virtual const std::vector<Block>& blocks() const = 0;
  virtual const std::vector<LocalGroup>& local_groups() const = 0;

  /// Where the loads of the next solve stand: the end t of the step and its length dt.
  virtual void set_time(Real t, Real dt) = 0;
  /// Accepts x as the state at the current time: histories move on. Until then nothing changes, so a step that failed
  /// is undone by starting again from the last accepted x.
  virtual void commit(const BlockVector& x) = 0;

  /// r = f(x). The row of a constrained unknown is x - x_D(t).
  virtual void residual(const BlockVector& x, BlockVector& r) = 0;
  /// r without the constraints: in the rows of constrained unknowns stand the reactions.
  virtual void raw_residual(const BlockVector& x, BlockVector& r) = 0;
  /// Fills matrix() with df/dx at x, without the constraints (rows and columns of constrained unknowns are there).
  virtual void jacobian(const BlockVector& x) = 0;
  virtual const BlockMatrix& matrix() const = 0;
  /// A block on the diagonal of matrix() that never changes: is asked to be stored in J from now on, a matrix whose
  /// local columns begin with those of the block, with its values as they are and zeros elsewhere. Returns where
  /// numbers are to be kept before J is changed, and gives J those that already are; null if the block stays where it
  /// is.
  virtual std::shared_ptr<KeptRows> share(int block, const RCP<const Matrix>& J) { return nullptr; }
  /// What is stored over a time step enters f, so that shorter steps are easier to solve; else only their loads count.
  virtual bool stores() const { return false; }
  /// The present matrix() is symmetric after elimination of the local groups.
  virtual bool symmetric() const = 0;
  /// Its blocks on the diagonal are.
  virtual bool symmetric_blocks() const { return symmetric(); }
  /// The owned unknowns of a block whose value is prescribed: 1, else 0. [owned unknown]
  virtual ConstView<char*> constrained(int block) const = 0;

  /// How far x, with r = residual(x), is from a solution, in every unit that matters.
  virtual std::vector<Measure> measures(const BlockVector& x, const BlockVector& r) = 0;
  /// A squared energy norm of r, for line searches.
  virtual Real merit(const BlockVector& x, const BlockVector& r) = 0;
  /// About what elimination of all other blocks adds to the diagonal of a block [owned unknown] in the Jacobian of the
  /// last jacobian(), for preconditioners; null where that is nothing.
  virtual RCP<const Vector> schur(int block) const { return Teuchos::null; }
  enum class Lag { none, follow, widest };
  /// Coefficients of fluxes may depend on x by high powers, which misleads Newton's method far from a solution. From
  /// now on f takes them as given: `follow`, first those of x, then nearer to those of x with each call; `widest`, as
  /// large as they may become under the present loads. none: f is as it is. Returns the largest |ln| of the ratio of
  /// those of x to those that were given before; below zero where there are none, and f stays as it is. Collective.
  virtual Real lag(Lag how, const BlockVector& x) { return -1; }
  /// What it offers where f is not smooth.
  virtual Globalisation& globalisation() { return smooth_; }

 private:
  Globalisation smooth_;
};

}  // namespace sprekk::fields
