#include "assembly/jacobian_check.hpp"

#include "base/over_ranks.hpp"

#include <algorithm>
#include <cmath>

namespace sprekk::assembly {

using fields::BlockVector;

namespace {

/// Returns a number in [-1, 1] that depends on the global number of the unknown only. The direction is thus independent
/// of the partition.
Real pseudo_random(GlobalIndex unknown, int direction) {
  std::size_t h = static_cast<std::size_t>(unknown) * 1000003 + static_cast<std::size_t>(direction) * 7919 + 1;
  h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9ULL;
  h = (h ^ (h >> 27)) * 0x94d049bb133111ebULL;
  return 2 * static_cast<Real>((h ^ (h >> 31)) >> 11) / 9007199254740992.0 - 1;
}

void fill_direction(fields::Vector& d, int direction, Real scale) {
  auto view = d.getLocalViewHost(Tpetra::Access::OverwriteAll);
  for (std::size_t i = 0; i < view.extent(0); ++i)
    view(i, 0) = scale * pseudo_random(d.getMap()->getGlobalElement(static_cast<LocalIndex>(i)), direction);
}

/// Returns the largest sum_j |J_ij| |d_j| over the rows, with |d_j| = scale; 0 for an absent block. Collective.
Real size_of_product(const RCP<fields::CrsMatrix>& J, Real scale) {
  if (J.is_null()) return 0;
  const auto local = J->getLocalMatrixHost();
  Real here = 0;
  for (LocalIndex i = 0; i < local.numRows(); ++i) {
    Real sum = 0;
    for (auto k = local.graph.row_map(i); k < local.graph.row_map(i + 1); ++k) sum += std::abs(local.values(k)) * scale;
    here = std::max(here, sum);
  }
  return base::max_over_ranks(*J->getComm(), here);
}

}  // namespace

std::vector<JacobianError> check_jacobian(System& system, const BlockVector& x, Real h, int n_directions) {
  const auto& blocks = system.blocks();
  auto J = system.create_matrix();
  std::vector<JacobianError> errors;
  for (int m = 0; m < static_cast<int>(system.modules().size()); ++m) {
    system.module_jacobian(m, x, J);
    for (std::size_t column = 0; column < blocks.size(); ++column) {
      std::vector<Real> worst(blocks.size(), 0);
      for (int direction = 0; direction < n_directions; ++direction) {
        fields::Vector d(blocks[column].map);
        fill_direction(d, direction, blocks[column].kinematic_scale);
        auto shifted = fields::create_like(x), forward = fields::create_like(x), backward = fields::create_like(x);
        fields::copy(x, shifted);
        shifted[column]->update(h, d, 1.0);
        system.module_residual(m, shifted, forward);
        shifted[column]->update(-2 * h, d, 1.0);
        system.module_residual(m, shifted, backward);
        for (std::size_t row = 0; row < blocks.size(); ++row) {
          forward[row]->update(-0.5 / h, *backward[row], 0.5 / h);
          if (!J(row, column).is_null()) J(row, column)->apply(d, *forward[row], Teuchos::NO_TRANS, -1.0, 1.0);
          worst[row] = std::max(worst[row], forward[row]->normInf());
        }
      }
      for (std::size_t row = 0; row < blocks.size(); ++row) {
        const Real size = size_of_product(J(row, column), blocks[column].kinematic_scale);
        errors.push_back({system.modules()[m]->name(), blocks[row].name, blocks[column].name,
                          worst[row] / (size > 0 ? size : blocks[row].residual_scale)});
      }
    }
  }
  return errors;
}

}  // namespace sprekk::assembly
