// Exchange with what lies outside of the mesh, row by row.
#pragma once

#include "assembly/module.hpp"

#include <vector>

namespace sprekk::physics {

/// The part c x of exchanges c (x - x_outside) in rows of one field; -c x_outside is a load.
class Exchange {
 public:
  /// Adds c to the coefficient of a row; those that other ranks own are dropped.
  void add(LocalIndex row, Real coefficient);
  /// Once all are added. `block`: that of the field.
  void bind(const assembly::Context& context, int block);
  void add_residual(const assembly::State& state, const assembly::Rows& r) const;
  void add_jacobian(fields::BlockMatrix& J) const;

 private:
  int block_ = -1;
  std::vector<LocalIndex> rows_;
  std::vector<Real> coefficients_;
  ConstView<LocalIndex*> row_;
  ConstView<Real*> coefficient_;
};

}  // namespace sprekk::physics
