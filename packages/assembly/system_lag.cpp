// Lagged coefficients of fluxes.
#include "assembly/system.hpp"

#include "base/over_ranks.hpp"

#include <algorithm>
#include <cmath>

namespace sprekk::assembly {

/// Updates the lagged coefficients in logarithms, since they vary over many orders of magnitude. For cubic laws, the
/// slope of the iteration is -3 if pressures determine the aperture, and 0 if volumes determine it.
Real System::lag(Lag how, const fields::BlockVector& x) {
  constexpr Real least = 1e-12;
  if (how == Lag::none) {
    coefficients_ = {};
    lagged_ = {};
    return 0;
  }
  refresh_ghosts(x, false);
  std::vector<Real> found(mesh_->n_fracture_faces(), -1);  // negative: no coefficient
  for (const auto& module : modules_)
    if (module.coefficients) module.coefficients->coefficients(state(module), how == Lag::widest, found);
  Real here = -1;
  for (std::size_t f = 0; f < found.size(); ++f) {
    if (found[f] < 0) continue;
    found[f] = std::log(std::max(found[f], least));
    here = std::max(here, lagged_.started() ? std::abs(found[f] - lagged_.y()[f]) : 0);
  }
  const Real farthest = base::max_over_ranks(*comm(), here);
  if (farthest < 0) return farthest;
  if (how == Lag::follow && lagged_.started())
    lagged_.follow(found);
  else
    lagged_.start(found);
  View<Real*> values("coefficients", found.size());
  const auto host = Kokkos::create_mirror_view(values);
  for (std::size_t f = 0; f < found.size(); ++f) host(f) = std::exp(lagged_.y()[f]);
  Kokkos::deep_copy(values, host);
  coefficients_ = values;
  return farthest;
}

}  // namespace sprekk::assembly
