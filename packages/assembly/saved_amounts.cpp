#include "assembly/saved_amounts.hpp"

#include "base/host_table.hpp"

namespace sprekk::assembly {

void subtract_saved(const State& state, const std::vector<int>& blocks, const Rows& rows) {
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    const auto of_block = rows[blocks[k]];
    const auto saved = state.history[k];
    const Real rate = state.rate;
    Kokkos::parallel_for(
        "saved amounts", Kokkos::RangePolicy<Execution>(0, of_block.extent(0)),
        KOKKOS_LAMBDA(int i) { of_block(i) -= rate * saved(i, 0); });
  }
}

void save_amounts(State& state, const std::vector<int>& blocks, const std::vector<Term>& terms, Real old, Real factor) {
  auto at_rate_1 = state;
  at_rate_1.rate = 1;
  Rows rows;
  for (const auto& x : state.x) rows.emplace_back("amounts", x.extent(0));
  for (const auto& term : terms) term.add_residual(at_rate_1, rows);
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    const auto saved = state.history[k];
    const auto now = rows[blocks[k]];
    Kokkos::parallel_for(
        "save amounts", Kokkos::RangePolicy<Execution>(0, saved.extent(0)),
        KOKKOS_LAMBDA(int i) { saved(i, 0) = old * saved(i, 0) + factor * now(i); });
  }
}

Real sum_of_saved(const State& state, const std::vector<int>& blocks) {
  Real sum = 0;
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    const auto saved = base::to_host(state.history[k]);
    for (std::size_t i = 0; i < saved.extent(0); ++i) sum += saved(i, 0);
  }
  return sum;
}

}  // namespace sprekk::assembly
