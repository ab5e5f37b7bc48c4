#include "assembly/jacobian.hpp"

#include "base/over_ranks.hpp"
#include "fields/without_zeros.hpp"

#include <algorithm>
#include <vector>

namespace sprekk::assembly {

using fields::BlockMatrix;

namespace {

/// Removes zero entries from off-diagonal blocks that only linear modules write, since these blocks never change.
/// Diagonal blocks keep their zeros, so that the unknowns of a node stay together.
void drop_zeros(BlockMatrix& linear, BlockMatrix& all) {
  for (int i = 0; i < all.n_blocks(); ++i)
    for (int j = 0; j < all.n_blocks(); ++j)
      if (const auto A = linear(i, j); i != j && !A.is_null() && all(i, j) == A)
        all(i, j) = linear(i, j) = fields::without_zeros(A);
}

}  // namespace

Jacobian::Jacobian(const Structure& structure) : structure_(structure) {
  const auto scope = structure.timers->scope("set-up"), inner = structure.timers->scope("structure of the matrices");
  const auto context = structure.context();
  const int n = structure.n_blocks();
  std::vector<char> linear(n * n, 0), nonlinear(n * n, 0);
  for (const auto& module : structure.modules)
    for (const auto& coupling : module.declaration.couplings)
      for (const auto& column : coupling.columns)
        (module.declaration.linear ? linear : nonlinear)[context.field(coupling.row) * n + context.field(column)] = 1;
  linear_ = structure.create_matrix();
  matrix_ = linear_;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      if (!nonlinear[i * n + j]) continue;
      if (linear[i * n + j])
        matrix_(i, j) = rcp(new fields::CrsMatrix(*linear_(i, j), Teuchos::Copy));
      else
        linear_(i, j) = Teuchos::null;
    }
}

void Jacobian::assemble_linear(const State& state) {
  {
    const auto scope = structure_.timers->scope("assembly of the linear part");
    for (const auto& module : structure_.modules)
      if (module.declaration.linear) module->jacobian(module.at(state), linear_);
  }
  const auto scope = structure_.timers->scope("structure of the matrices");
  drop_zeros(linear_, matrix_);
}

/// Sets the matrix to the linear part.
void Jacobian::start() {
  for (int i = 0; i < matrix_.n_blocks(); ++i)
    for (int j = 0; j < matrix_.n_blocks(); ++j) {
      if (matrix_(i, j).is_null() || matrix_(i, j) == linear_(i, j)) continue;
      const auto values = matrix_(i, j)->getLocalMatrixDevice().values;
      if (linear_(i, j).is_null())
        Kokkos::deep_copy(values, 0.0);
      else
        Kokkos::deep_copy(values, linear_(i, j)->getLocalMatrixDevice().values);
    }
}

void Jacobian::assemble(const State& state) {
  const auto scope = structure_.timers->scope("Jacobian");
  bool symmetric = true;
  start();
  for (const auto& module : structure_.modules) {
    if (module.declaration.linear) continue;
    const auto scope_of_module = structure_.timers->scope(module->name());
    const auto there = module.at(state);
    module->jacobian(there, matrix_);
    symmetric = module->symmetric(there) && symmetric;
  }
  symmetric_ = base::on_all_ranks(structure_.comm(), symmetric);
}

void Jacobian::assemble_balances(State state) {
  const auto context = structure_.context();
  state.rate = 0;
  start();
  for (const auto& module : structure_.modules) {
    const auto& couplings = module.declaration.couplings;
    const bool balances = std::any_of(couplings.begin(), couplings.end(), [&](const auto& coupling) {
      return structure_.unknowns[context.field(coupling.row)].balance;
    });
    if (!module.declaration.linear && balances) module->jacobian(module.at(state), matrix_);
  }
}

void Jacobian::add_linear(const fields::BlockVector& ghosted, fields::BlockVector& r) const {
  for (int i = 0; i < linear_.n_blocks(); ++i)
    for (int j = 0; j < linear_.n_blocks(); ++j) linear_.add_local_product(i, j, *ghosted[j], *r[i]);
}

std::shared_ptr<fields::SavedRows> Jacobian::share(int block, const RCP<const fields::Matrix>& J) {
  if (auto saved = linear_.saved(block)) {
    saved->restore(*J);
    return saved;
  }
  const auto& A = linear_(block, block);
  const bool constant = !A.is_null() && matrix_(block, block) == A && !structure_.unknowns[block].balance;
  if (!constant) return nullptr;
  const auto saved = std::make_shared<fields::SavedRows>(J);
  linear_.share(block, saved);
  matrix_.share(block, saved);
  return saved;
}

}  // namespace sprekk::assembly
