// Sizes of rows: measures of convergence and merit of residuals, relative to loads, diagonals and round-off.
#pragma once

#include "assembly/structure.hpp"

#include <string>
#include <vector>

namespace sprekk::assembly {

/// The residual of a row has a round-off of its diagonal times the round-off of the unknowns. Measures and merit
/// subtract it: otherwise round-off would reject steps that reduce the measures. It is relevant for slivers, which are
/// stiff, and for nearly incompressible rock. Augmented rows contain differences of both sides times the augmentation
/// constant. Where soft rock carries stiff rock over a long distance, the round-off of the differences exceeds the
/// deformation of the stiff rock.
class RowSizes {
 public:
  /// Finds weights and diagonals for the linear part and the balances of a Jacobian. The arguments must outlive this
  /// object.
  RowSizes(const Structure& structure, const fields::BlockMatrix& linear, const fields::BlockMatrix& matrix);

  /// Starts an attempt of a step of length dt. Its first Jacobian again defines the sizes of balances.
  void begin_step(Real dt);
  /// Starts a solve: the round-off of the last Jacobian no longer applies.
  void begin_solve() { present_.clear(); }
  /// Finds the diagonals and Schur complements of the Jacobian at a state.
  void update(const State& state);
  /// Sets the diagonals of an augmented block to the augmentation constants.
  void set_augmentation(int block, const std::vector<contact::Constraint>& contact_constraints);

  /// Returns the largest relative residual of each block on this rank. Collective.
  std::vector<fields::Measure> measures(const fields::BlockVector& x, const fields::BlockVector& r) const;
  /// Returns the squared energy norm of r. Collective.
  Real merit(const fields::BlockVector& x, const fields::BlockVector& r) const;
  /// Returns the Schur complement of a block; null: none.
  RCP<const fields::Vector> schur(int block) const { return schur_[block]; }
  /// Returns the diagonal of a block of the linear part; of an augmented block, the augmentation constants.
  const fields::Vector& diagonal(int block) const { return *diagonals_[block]; }

  struct Row;  ///< device code

 private:
  enum class Type { bulk, augmented, balance };
  Type type(int block) const;
  Row row(int block, const fields::BlockVector& x, const fields::BlockVector& r) const;
  Real rounding(const fields::BlockVector& x, const std::string& scale) const;
  View<Real*> rounding_of_others(int block, const fields::BlockVector& x) const;
  const fields::BlockVector& present() const { return present_.empty() ? diagonals_ : present_; }

  const Structure& structure_;
  const fields::BlockMatrix& matrix_;
  fields::BlockVector weights_;  // [block] weights of merit(); null: 1/|diagonal|
  // [block] of the linear part; balances: of the first Jacobian of an attempt; augmented blocks: augmentation constants
  fields::BlockVector diagonals_;
  fields::BlockVector present_;  // [block] of the last Jacobian
  fields::BlockVector schur_;    // [block] of the last Jacobian; null: none
  Real dt_ = 0;
  bool sized_ = false;  // diagonals_ of balances are those of this attempt
};

}  // namespace sprekk::assembly
