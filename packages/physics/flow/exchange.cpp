#include "physics/flow/exchange.hpp"

namespace sprekk::physics {

void Exchange::add(LocalIndex row, Real coefficient) {
  rows_.push_back(row);
  coefficients_.push_back(coefficient);
}

void Exchange::bind(const assembly::Context& context, int block, const laws::Fluid& fluid) {
  block_ = block;
  fluid_ = fluid;
  std::vector<LocalIndex> rows;
  std::vector<Real> coefficients;
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    kept_.push_back(rows_[k] < context.layout(block).n_owned());
    if (!kept_.back()) continue;
    rows.push_back(rows_[k]);
    coefficients.push_back(coefficients_[k]);
  }
  row_ = assembly::to_device(rows, "rows");
  coefficient_ = assembly::to_device(coefficients, "coefficients");
  set_outside(std::vector<Real>(rows_.size(), 0));
}

void Exchange::set_outside(const std::vector<Real>& pressures) {
  std::vector<Real> kept;
  for (std::size_t k = 0; k < kept_.size(); ++k)
    if (kept_[k]) kept.push_back(pressures[k]);
  outside_ = assembly::to_device(kept, "pressures outside");
}

void Exchange::add_residual(const assembly::State& state, const assembly::Rows& r) const {
  const auto fluid = fluid_;
  const auto row = row_;
  const auto coefficient = coefficient_, outside = outside_;
  const auto x = state.x[block_];
  const auto rows = r[block_];
  Kokkos::parallel_for(
      "exchange", Kokkos::RangePolicy<Execution>(0, row.extent(0)), KOKKOS_LAMBDA(int k) {
        Kokkos::atomic_add(&rows(row(k)), coefficient(k) * fluid.drop(x(row(k)), outside(k), 0));
      });
}

/// Columns of owned unknowns have the numbers of their rows.
void Exchange::add_jacobian(const assembly::State& state, fields::BlockMatrix& J) const {
  const auto fluid = fluid_;
  const auto row = row_;
  const auto coefficient = coefficient_, outside = outside_;
  const auto x = state.x[block_];
  const auto local = J(block_, block_)->getLocalMatrixDevice();
  Kokkos::parallel_for(
      "exchange", Kokkos::RangePolicy<Execution>(0, row.extent(0)), KOKKOS_LAMBDA(int k) {
        const Real slope = coefficient(k) * fluid.ddrop_da(x(row(k)), outside(k), 0);
        for (auto i = local.graph.row_map(row(k)); i < local.graph.row_map(row(k) + 1); ++i)
          if (local.graph.entries(i) == row(k)) Kokkos::atomic_add(&local.values(i), slope);
      });
}

}  // namespace sprekk::physics
