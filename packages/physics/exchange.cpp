#include "physics/exchange.hpp"

namespace sprekk::physics {

void Exchange::add(LocalIndex row, Real coefficient) {
  rows_.push_back(row);
  coefficients_.push_back(coefficient);
}

void Exchange::bind(const assembly::Context& context, int block) {
  block_ = block;
  std::vector<LocalIndex> rows;
  std::vector<Real> coefficients;
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    if (rows_[k] >= context.layout(block).n_owned()) continue;
    rows.push_back(rows_[k]);
    coefficients.push_back(coefficients_[k]);
  }
  row_ = assembly::to_device(rows, "rows");
  coefficient_ = assembly::to_device(coefficients, "coefficients");
}

void Exchange::add_residual(const assembly::State& state, const assembly::Rows& r) const {
  const auto row = row_;
  const auto coefficient = coefficient_;
  const auto x = state.x[block_];
  const auto rows = r[block_];
  Kokkos::parallel_for(
      "exchange", Kokkos::RangePolicy<Execution>(0, row.extent(0)),
      KOKKOS_LAMBDA(int k) { Kokkos::atomic_add(&rows(row(k)), coefficient(k) * x(row(k))); });
}

/// Columns of owned unknowns have the numbers of their rows.
void Exchange::add_jacobian(fields::BlockMatrix& J) const {
  const auto row = row_;
  const auto coefficient = coefficient_;
  const auto local = J(block_, block_)->getLocalMatrixDevice();
  Kokkos::parallel_for(
      "exchange", Kokkos::RangePolicy<Execution>(0, row.extent(0)), KOKKOS_LAMBDA(int k) {
        for (auto i = local.graph.row_map(row(k)); i < local.graph.row_map(row(k) + 1); ++i)
          if (local.graph.entries(i) == row(k)) Kokkos::atomic_add(&local.values(i), coefficient(k));
      });
}

}  // namespace sprekk::physics
