#include "assembly/flux_lag.hpp"

#include "base/host_table.hpp"
#include "base/over_ranks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace sprekk::assembly {

void FluxLag::stop() {
  coefficients_ = {};
  logarithms_ = {};
}

fields::BlockProblem::LagChange FluxLag::update(fields::BlockProblem::Lag how, const Structure& structure,
                                                const State& state) {
  using Lag = fields::BlockProblem::Lag;
  constexpr Real minimum = 1e-12;
  std::vector<Real> found(structure.mesh->n_fracture_faces(),
                          -1);  // negative: no coefficient
  for (const auto& module : structure.modules)
    if (module.coefficients) module.coefficients->coefficients(module.at(state), how == Lag::widest, found);
  std::array<Real, 2> here{-1, 0};  // see LagChange
  for (std::size_t f = 0; f < found.size(); ++f) {
    if (found[f] < 0) continue;
    found[f] = std::log(std::max(found[f], minimum));
    const Real rise = logarithms_.started() ? found[f] - logarithms_.y()[f] : 0;
    here = {std::max(here[0], std::abs(rise)), std::max(here[1], rise)};
  }
  const auto [largest, rise] = base::max_over_ranks(structure.comm(), here);
  if (largest < 0) return {};
  if (how == Lag::follow && logarithms_.started())
    logarithms_.follow(found);
  else
    logarithms_.start(found);
  for (std::size_t f = 0; f < found.size(); ++f) found[f] = std::exp(logarithms_.y()[f]);
  coefficients_ = base::to_device(found, "coefficients");
  return {largest, rise};
}

}  // namespace sprekk::assembly
