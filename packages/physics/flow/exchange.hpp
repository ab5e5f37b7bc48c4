// Exchange with what lies outside of the mesh, row by row.
#pragma once

#include "assembly/module.hpp"
#include "laws/fluid.hpp"

#include <vector>

namespace sprekk::physics {

/// Exchanges c (p - p_outside) in rows of a field of pressures, of a compressible fluid c (e - e_outside)/c_f.
class Exchange {
 public:
  /// Adds one with the coefficient c to a row; those that other ranks own are dropped.
  void add(LocalIndex row, Real coefficient);
  /// Once all are added. `block`: that of the field.
  void bind(const assembly::Context& context, int block, const laws::Fluid& fluid);
  /// The pressures outside, in the order in which exchanges were added.
  void set_outside(const std::vector<Real>& pressures);
  void add_residual(const assembly::State& state, const assembly::Rows& r) const;
  void add_jacobian(const assembly::State& state, fields::BlockMatrix& J) const;

 private:
  int block_ = -1;
  laws::Fluid fluid_;
  std::vector<LocalIndex> rows_;
  std::vector<Real> coefficients_;
  std::vector<char> kept_;  // [exchange as added]
  ConstView<LocalIndex*> row_;
  ConstView<Real*> coefficient_, outside_;
};

}  // namespace sprekk::physics
