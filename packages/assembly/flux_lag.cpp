#include "assembly/flux_lag.hpp"

#include "base/host_table.hpp"
#include "base/over_ranks.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace sprekk::assembly {

void FluxLag::stop() {
  coefficients_ = {};
  logarithms_ = {};
}

Real FluxLag::update(fields::BlockProblem::Lag how, const Structure& structure, const State& state) {
  using Lag = fields::BlockProblem::Lag;
  constexpr Real minimum = 1e-12;
  std::vector<Real> found(structure.mesh->n_fracture_faces(),
                          -1);  // negative: no coefficient
  for (const auto& module : structure.modules)
    if (module.coefficients) module.coefficients->coefficients(module.at(state), how == Lag::widest, found);
  Real here = -1;
  for (std::size_t f = 0; f < found.size(); ++f) {
    if (found[f] < 0) continue;
    found[f] = std::log(std::max(found[f], minimum));
    here = std::max(here, logarithms_.started() ? std::abs(found[f] - logarithms_.y()[f]) : 0);
  }
  const Real farthest = base::max_over_ranks(structure.comm(), here);
  if (farthest < 0) return farthest;
  if (how == Lag::follow && logarithms_.started())
    logarithms_.follow(found);
  else
    logarithms_.start(found);
  for (std::size_t f = 0; f < found.size(); ++f) found[f] = std::exp(logarithms_.y()[f]);
  coefficients_ = base::to_device(found, "coefficients");
  return farthest;
}

}  // namespace sprekk::assembly
