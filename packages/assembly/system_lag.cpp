// Coefficients of fluxes that lag behind the unknowns they depend on.
#include "assembly/system.hpp"

#include <Teuchos_CommHelpers.hpp>

#include <algorithm>
#include <cmath>

namespace sprekk::assembly {

/// In logarithms, for coefficients go over many orders of magnitude. Of y -> ln of the coefficients that f lagged by
/// exp(y) leads to, each face has its own fixed-point iteration, relaxed by 1/(1 - s) with the secant's slope s. The
/// steepest slope is remembered, by a share that falls with each iterate, and made steeper where that went too far, for
/// faces act on each other. Where conductances follow a cubic law s is -3 if pressures decide on the aperture, 0 if
/// volumes do. If that does not settle soon, faces swing in groups, in which each knows only of itself: then a face that
/// goes to and fro remembers longer, and y moves by 1 at most, by less where it turned back.
Real System::lag(Lag how, const fields::BlockVector& x) {
  constexpr Real steepest = -100, least = 1e-12, memory = 0.25, longest_memory = 0.8, shorter = 0.7, longer = 1.2,
                 shortest_way = 0.02;
  constexpr int fast = 10;  // iterates before it goes carefully
  if (how == Lag::none) {
    coefficients_ = {};
    lagged_ = {};
    return 0;
  }
  refresh_ghosts(x, false);
  std::vector<Real> found(mesh_->n_fracture_faces(), -1);  // below zero: none
  for (std::size_t m = 0; m < modules_.size(); ++m)
    modules_[m]->coefficients(state(static_cast<int>(m)), how == Lag::widest, found);
  auto& [used, before, led_to, slope, way, n_turns, n_iterates] = lagged_;
  Real here = -1, farthest = 0;
  for (std::size_t f = 0; f < found.size(); ++f) {
    if (found[f] < 0) continue;
    found[f] = std::log(std::max(found[f], least));
    here = std::max(here, used.empty() ? 0 : std::abs(found[f] - used[f]));
  }
  Teuchos::reduceAll(*comm(), Teuchos::REDUCE_MAX, 1, &here, &farthest);
  if (farthest < 0) return farthest;
  auto next = found;
  slope.resize(found.size(), 0);
  way.resize(found.size(), 1);
  n_turns.resize(found.size(), 0);
  if (how == Lag::follow && !used.empty()) {
    const bool careful = ++n_iterates > fast;
    for (std::size_t f = 0; f < found.size(); ++f) {
      const Real away = found[f] - used[f], moved = before.empty() ? 0 : used[f] - before[f];
      const bool turned = moved * away < 0;  // gone too far
      const Real kept = careful ? longest_memory - (longest_memory - memory) * std::pow(0.6, n_turns[f]) : memory;
      const Real remembered = turned ? 2 * slope[f] - 0.5 : kept * slope[f];
      const Real secant = moved != 0 ? (found[f] - led_to[f]) / moved : 0;
      slope[f] = std::clamp(std::min(secant, remembered), steepest, Real(0));
      Real step = away / (1 - slope[f]);
      if (careful) {
        n_turns[f] += turned;
        way[f] = turned ? std::max(shorter * way[f], shortest_way) : std::min(longer * way[f], Real(1));
        step = std::clamp(step, -way[f], way[f]);
      }
      next[f] = used[f] + step;
    }
    before = used;
    led_to = found;
  } else {
    before.clear();
  }
  used = next;
  View<Real*> values("coefficients", next.size());
  const auto host = Kokkos::create_mirror_view(values);
  for (std::size_t f = 0; f < next.size(); ++f) host(f) = std::exp(next[f]);
  Kokkos::deep_copy(values, host);
  coefficients_ = values;
  return farthest;
}

}  // namespace sprekk::assembly
