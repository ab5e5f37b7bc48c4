// Preconditioners: trees whose leaves are methods for a block or a group of blocks. Inner nodes combine or refine them.
#pragma once

#include "base/check.hpp"
#include "solve/linear_system.hpp"
#include "solve/preconditioner_options.hpp"
#include "solve/solver_cost.hpp"

namespace sprekk::solve {

/// Preconditioner of blocks, created once and set up for each system. Graphs must not change. All members are
/// collective unless they return stored data.
class Preconditioner {
 public:
  /// `method`: name of the method, for the group of blocks that begins with `block`.
  Preconditioner(const std::string& method, const std::string& block);
  virtual ~Preconditioner() = default;

  /// Prepares the preconditioner for these values. `keeps`: multigrid hierarchies of an earlier system remain, and only
  /// the parts above them are renewed. Throws an Error with the name of the block on all ranks, or a RefusedList if a
  /// library with a parameter list of the scene fails.
  void setup(const LinearSystem& system, bool keeps = false);
  /// Returns an approximation of (S A S)^-1 for the last system, with the scales S of its blocks. Each set-up may
  /// return another object.
  RCP<const fields::Operator> inverse() const { return counted(made()); }

  /// Returns the matrix S A S if the last set-up has formed it, else null.
  virtual RCP<const fields::Operator> matrix() const { return Teuchos::null; }

  /// Returns whether it is symmetric for symmetric systems.
  virtual bool is_symmetric() const { return true; }
  /// Returns whether it remains useful if the system changes little.
  virtual bool can_be_reused() const { return true; }
  /// Returns whether it is a cycle of Sprekk's multigrid, which can be tried at set-up.
  virtual bool has_cycles() const { return false; }
  /// Returns the largest number of unknowns for which a direct solver replaces it; 0: none.
  virtual int coarse_size() const { return 0; }
  /// Returns its costs and those of its parts.
  virtual std::vector<SolverCost> costs() const { return {*cost_}; }
  /// Adds the tree to the Blocks sections by name, in the form of a scene, with all parameters of libraries.
  virtual void describe(Teuchos::ParameterList& blocks) const = 0;

 protected:
  const std::string& block() const { return block_; }
  /// Returns the name of the scene's list that a library receives, e.g. "MueLu"; empty: none.
  virtual std::string given_list() const { return {}; }

  virtual void prepare(const LinearSystem& system, SolverCost& cost) = 0;
  /// Renews the parts above a hierarchy that remains. Returns whether there are such parts.
  virtual bool renew(const LinearSystem& system) { return false; }
  virtual RCP<const fields::Operator> made() const = 0;
  virtual RCP<const fields::Operator> counted(const RCP<const fields::Operator>& inverse) const;

 private:
  std::string block_;
  std::shared_ptr<SolverCost> cost_;
};

/// Returns the preconditioner for all blocks: a sweep over groups, each with the method of its options. The group of a
/// block follows from its options, or is that of the block which it enriches or into which it is condensed. Throws an
/// Error with the entry and the allowed values. `by_cost`: type "auto" of a group selects factors if they are cheaper,
/// see factors_are_cheaper().
std::unique_ptr<Preconditioner> make_preconditioner(const PreconditionerOptions& options,
                                                    const std::vector<Block>& blocks, bool by_cost = false);

/// Number of coordinates of the entities of a block.
int dimension(const Block& block);

/// Returns whether MueLu replaces Sprekk's multigrid for a block: as requested, and for node sizes without compiled
/// code. Throws an Error if the requested type is not available.
bool takes_muelu(const BlockOptions& options, const Block& first);
/// Returns whether a block has incomplete factors in the order of a flow: as requested, or by default if the block is
/// advected and has no options of multigrid.
bool takes_flow_order(const BlockOptions& options, const Block& first);
/// Returns multigrid for the first block, by its coordinates and near-null space, and for blocks that enrich it. MueLu
/// solves for one block only.
std::unique_ptr<Preconditioner> make_multigrid(const BlockOptions& options, const std::vector<Block>& blocks);
/// Returns the same, below a FineLevel if the blocks need one, or make_advected() if requested.
std::unique_ptr<Preconditioner> make_cycle(const BlockOptions& options, const std::vector<Block>& blocks);

/// Return methods for the matrix of one block, or of several joined blocks.
std::unique_ptr<Preconditioner> make_muelu(const Teuchos::ParameterList& given, const std::vector<Block>& blocks);
std::unique_ptr<Preconditioner> make_ifpack2(const Teuchos::ParameterList& given, const std::vector<Block>& blocks);
std::unique_ptr<Preconditioner> make_gauss_seidel(const std::vector<Block>& blocks);
std::unique_ptr<Preconditioner> make_direct(const std::vector<Block>& blocks);
/// Returns incomplete factors in the order of a flow, see FlowFactors, for the group that begins with `block`, in a few
/// steps of MinimalResidual.
std::unique_ptr<Preconditioner> make_advected(const std::string& block);

/// Matrix of a whole system, for methods that require one.
class WholeMatrix {
 public:
  /// Copies the present values. Throws an Error if the first block has no matrix. Collective.
  void update(const LinearSystem& system);
  const RCP<const Matrix>& matrix() const { return matrix_; }
  RCP<CrsMatrix> crs() const { return matrix_->crs(); }

 private:
  std::unique_ptr<JoinedMatrix> joined_;  // for several blocks
  RCP<const Matrix> matrix_;
};

/// Adds to the diagonal of a matrix, whose graph must contain it. Local.
void add_to_diagonal(CrsMatrix& A, const Vector& added);

/// Returns the cause from the text of a library's exception, without source locations.
std::string gist(const std::string& text);

/// Error for a list of the scene that a library rejects, or with which set-up fails. At the first set-up it ends the
/// run, because shorter steps would not help.
class RefusedList : public Error {
 public:
  using Error::Error;
};

/// Throws a RefusedList with the entry if `given` contains a name that is not in `allowed`, the lists of the library.
/// `place` is the path of the list in the scene.
void check_names(const std::string& place, const Teuchos::ParameterList& given,
                 const std::vector<Teuchos::ParameterList>& allowed);

/// Throws a RefusedList if this method of Ifpack2 rejects or ignores an entry. `known`: other permitted names. The
/// method is tried on a 1 x 1 matrix. Collective.
void check_ifpack2(const std::string& place, const std::string& method, const Teuchos::ParameterList& given,
                   const RCP<const Comm>& comm, const std::vector<std::string>& known = {});

}  // namespace sprekk::solve
