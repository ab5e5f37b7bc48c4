#include "transport/outflow.hpp"

#include "base/entry_of_place.hpp"
#include "base/host_table.hpp"

#include <algorithm>
#include <cmath>

namespace sprekk::transport {

bool Outflow::constant_in_time() const {
  return std::all_of(conditions_.begin(), conditions_.end(),
                     [](const auto& condition) { return condition.value.constant_in_time(); });
}

void Outflow::add(std::size_t condition, LocalIndex row, Real area, const std::array<Real, 3>& x) {
  points_.push_back({condition, row, area, x});
  const auto& [boundary, value, coefficient, region, fracture, location] = conditions_[condition];
  if (coefficient)
    exchange_.add(row, area * base::value_at(location, names_.coefficient, *coefficient, base::at_least(0), x));
}

void Outflow::bind(const assembly::Context& context, int block, const laws::Fluid& fluid) {
  block_ = block;
  n_owned_ = context.layout(block).n_owned();
  fluid_ = fluid;
  exchange_.bind(context, block, fluid);
}

Real Outflow::largest(Real t, bool beyond) const {
  Real largest = 0;
  for (const auto& point : points_)
    if (const auto& condition = conditions_[point.condition]; condition.coefficient.has_value() == beyond)
      largest = std::max(largest, std::abs(condition.value(point.x, t)));
  return largest;
}

/// [owned row] residual divided by U, the sum of area times coefficient.
std::map<LocalIndex, Real> Outflow::unbalanced_per_coefficient(const assembly::State& state) const {
  std::map<LocalIndex, Real> sums;
  if (state.unbalanced.empty()) return sums;
  const auto unbalanced = base::to_host(state.unbalanced[block_]);
  for (const auto& [number, row, area, x] : points_)
    if (const auto& coefficient = conditions_[number].coefficient; coefficient && row < n_owned_)
      sums[row] += area * (*coefficient)(x, 0);
  for (auto& [row, sum] : sums) sum = sum > 0 ? unbalanced(row) / sum : 0;
  return sums;
}

void Outflow::totals(const assembly::State& state, const mesh::Mesh& mesh, std::vector<assembly::Total>& totals) const {
  const auto u = base::to_host(state.x[block_]);
  const auto unbalanced = unbalanced_per_coefficient(state);
  const std::size_t first = totals.size();
  for (const auto& one : conditions_)
    totals.push_back({{names_.inflows, mesh.boundary_names[one.boundary]}, 0, names_.unit});
  for (const auto& [number, row, area, x] : points_) {
    if (row >= n_owned_) continue;
    const auto& [boundary, value, coefficient, region, fracture, location] = conditions_[number];
    const Real beyond = value(x, state.t), h = coefficient ? (*coefficient)(x, 0) : 0;
    totals[first + number].value -= area * (coefficient ? h * fluid_.drop(u(row), beyond, 0) : beyond);
    if (const auto of_row = unbalanced.find(row); h > 0 && of_row != unbalanced.end())
      totals[first + number].value += area * h * of_row->second;
  }
}

}  // namespace sprekk::transport
