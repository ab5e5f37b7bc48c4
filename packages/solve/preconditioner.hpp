// About the inverse of a linear system: a tree, whose leaves are methods for a block or a group of blocks, and whose
// nodes join or refine them.
#pragma once

#include "base/check.hpp"
#include "solve/linear_system.hpp"
#include "solve/preconditioner_options.hpp"
#include "solve/solver_cost.hpp"

namespace sprekk::solve {

/// Made once for blocks, and set up for each of their systems; graphs stay as they are. All members are collective
/// unless they return stored data.
class Preconditioner {
 public:
  /// `method` of the group of blocks that begins with `block`, in words.
  Preconditioner(const std::string& method, const std::string& block);
  virtual ~Preconditioner() = default;

  /// Makes ready for these values. `keeps`: hierarchies of multigrid stay those of an earlier system, and what is above
  /// them is renewed. Throws an Error that names the block, on every rank; a RefusedList where a library fails that was
  /// given a list by the scene.
  void setup(const LinearSystem& system, bool keeps = false);
  /// About (S A S)^-1 of the last set-up, S the scales of its blocks. The object may change at every set-up.
  RCP<const fields::Operator> inverse() const { return counted(made()); }

  /// The matrix S A S of the last set-up where it has made one; or null.
  virtual RCP<const fields::Operator> matrix() const { return Teuchos::null; }

  /// Whether it is symmetric for symmetric systems.
  virtual bool is_symmetric() const { return true; }
  /// Whether the one of an earlier system serves as long as little has changed.
  virtual bool can_be_kept() const { return true; }
  /// Whether it is cycles of Sprekk's own multigrid, which can be tried at a set-up.
  virtual bool has_cycles() const { return false; }
  /// As many unknowns or fewer are for a direct solver; 0: none.
  virtual int coarse_size() const { return 0; }
  /// Its own and those of what it uses.
  virtual std::vector<SolverCost> costs() const { return {*cost_}; }
  /// The tree as a scene would ask for it, with all that is handed to libraries: adds to Blocks' sections by name.
  virtual void describe(Teuchos::ParameterList& blocks) const = 0;

 protected:
  const std::string& block() const { return block_; }
  /// The scene's list that a library gets untouched, as "MueLu"; empty: there is none.
  virtual std::string given_list() const { return {}; }

  virtual void prepare(const LinearSystem& system, SolverCost& cost) = 0;
  /// What is above a hierarchy that is kept; whether there is anything.
  virtual bool renew(const LinearSystem& system) { return false; }
  virtual RCP<const fields::Operator> made() const = 0;
  virtual RCP<const fields::Operator> counted(const RCP<const fields::Operator>& inverse) const;

 private:
  std::string block_;
  std::shared_ptr<SolverCost> cost_;
};

/// For all these blocks: of each group what its options ask for, and a sweep over the groups. A block's group is that
/// which its options say, or that of the block which it enriches or is condensed into. Throws an Error that names the
/// entry and what is allowed.
std::unique_ptr<Preconditioner> make_preconditioner(const PreconditionerOptions& options,
                                                    const std::vector<Block>& blocks);

/// Multigrid on what the first block's coordinates and near null space belong to, and on blocks that enrich it:
/// Sprekk's own, or MueLu's where it is asked for or there is no other; MueLu's is for one block.
bool takes_muelu(const BlockOptions& options, const Block& first);
std::unique_ptr<Preconditioner> make_multigrid(const BlockOptions& options, const std::vector<Block>& blocks);

/// Methods for the matrix of one block or of several joined.
std::unique_ptr<Preconditioner> make_muelu(const Teuchos::ParameterList& given, const std::vector<Block>& blocks);
std::unique_ptr<Preconditioner> make_ifpack2(const Teuchos::ParameterList& given, const std::vector<Block>& blocks);
std::unique_ptr<Preconditioner> make_gauss_seidel(const std::vector<Block>& blocks);
std::unique_ptr<Preconditioner> make_direct(const std::vector<Block>& blocks);

/// The matrix of a whole system, for methods that need one.
class WholeMatrix {
 public:
  /// Takes over the present values. Throws where there is no matrix. Collective.
  void update(const LinearSystem& system);
  const RCP<const Matrix>& matrix() const { return matrix_; }
  RCP<CrsMatrix> crs() const { return matrix_->crs(); }

 private:
  std::unique_ptr<JoinedMatrix> joined_;  // of several blocks
  RCP<const Matrix> matrix_;
};

/// To a matrix whose diagonal has places. Local.
void add_to_diagonal(CrsMatrix& A, const Vector& added);

/// Of the text of a library's exception: what went wrong, without the place in its sources.
std::string gist(const std::string& text);

/// A scene's list that a library refused, or with which it cannot be set up. At the first set-up this ends the run: no
/// shorter step mends it.
class RefusedList : public Error {
 public:
  using Error::Error;
};

/// Throws a RefusedList that names the entry if a list has one that the library does not know; `allowed` are the
/// library's lists, `place` is that of the list in the scene.
void check_names(const std::string& place, const Teuchos::ParameterList& given,
                 const std::vector<Teuchos::ParameterList>& allowed);

/// Throws a RefusedList if this method of Ifpack2 refuses an entry or does not read it; `known` are other names that
/// may be given. Tried on the matrix 1.
void check_ifpack2(const std::string& place, const std::string& method, const Teuchos::ParameterList& given,
                   const RCP<const Comm>& comm, const std::vector<std::string>& known = {});

}  // namespace sprekk::solve
