#include "laws/closure/bandis.hpp"

#include "base/check.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace sprekk::laws {

namespace {

/// Root of f between `low` and `high`, where f has different signs, to round-off.
template <class F>
Real root_between(const F& f, Real low, Real high) {
  const bool rises = f(low) <= 0;
  for (;;) {
    const Real middle = low + (high - low) / 2;
    if (!(middle > low && middle < high)) return middle;
    ((f(middle) <= 0) == rises ? low : high) = middle;
  }
}

/// Position of the minimum of f between `low` and `high`, by golden sections.
template <class F>
Real minimum_between(const F& f, Real low, Real high) {
  constexpr Real part = 0.381966011250105;
  for (int k = 0; k < 80; ++k) {
    const Real a = low + part * (high - low), b = high - part * (high - low);
    f(a) < f(b) ? high = b : low = a;
  }
  return low + (high - low) / 2;
}

}  // namespace

BandisClosure BandisClosure::of_aperture(Real unloaded) const {
  BandisClosure law = *this;
  law.aperture = unloaded;
  law.complete();
  return law;
}

Real BandisClosure::least_aperture() const {
  const auto& [fixed, by_roughness, factor, exponent] = closure_terms();
  return wall_strength / 1e9 / std::pow(-(fixed + by_roughness * roughness) / factor, 1 / exponent);
}

Real BandisClosure::largest_aperture() const {
  const Real missing = 7.15 - 1.75 * roughness;
  return missing > 0 ? 0.02 * wall_strength / 1e9 / missing : std::numeric_limits<Real>::infinity();
}

Real BandisClosure::aperture_under(Real N, Real unloaded) const {
  return unloaded + of_aperture(unloaded).opening(Contact<Real>{.lambda_n = -N});
}

BandisClosure BandisClosure::in_situ(Real N, Real a) const {
  if (aperture > 0) return *this;
  constexpr int n = 400;          // unloaded apertures, evenly spaced on a logarithmic scale
  constexpr Real inside = 1e-12;  // of the range of the regressions
  const Real least = (1 + inside) * least_aperture(), end = (1 - inside) * largest_aperture();
  SPREKK_CHECK(least < end, "closure \"{}\" has no unloaded aperture for this roughness and wall strength", name);
  const auto excess = [&](Real unloaded) { return aperture_under(N, unloaded) - a; };
  // a_0 - Du(a_0) is convex, and a lower bound of the aperture: no roots beyond the point where it exceeds a and rises
  const auto lower_bound = [&](Real unloaded) { return unloaded - of_aperture(unloaded).maximum; };
  Real top = 2 * std::max(a, least);
  while (top < end && !(lower_bound(top) > a && lower_bound(top) > lower_bound(top / 2))) top *= 2;
  top = std::min(top, end);
  SPREKK_CHECK(excess(top) >= 0,
               "closure \"{}\" has no unloaded joint with the aperture {:.6g} m (without dilation) under {:.6g} Pa; it "
               "must be at most {:.6g} m",
               name, a, N, excess(top) + a);
  const auto position = [&](int k) { return k == n ? top : least * std::pow(top / least, Real(k) / n); };
  int lowest = n;  // with the smallest aperture under load
  for (int k = n - 1; k >= 0; --k) {
    if (excess(position(k)) <= 0) return of_aperture(root_between(excess, position(k), position(k + 1)));
    if (excess(position(k)) < excess(position(lowest))) lowest = k;
  }
  const Real low = minimum_between(excess, position(std::max(lowest - 1, 0)), position(std::min(lowest + 1, n)));
  SPREKK_CHECK(excess(low) <= 0,
               "closure \"{}\" has no unloaded joint with the aperture {:.6g} m (without dilation) under {:.6g} Pa; it "
               "must be at least {:.6g} m",
               name, a, N, excess(low) + a);
  return of_aperture(root_between(excess, low, position(std::min(lowest + 1, n))));
}

Real BandisClosure::smaller_aperture(Real N) const {
  const Real a = aperture_under(N, aperture), least = (1 + 1e-12) * least_aperture();
  const auto excess = [&](Real unloaded) { return aperture_under(N, unloaded) - a; };
  if (!(excess(least) > 0)) return 0;
  const Real low = minimum_between(excess, least, aperture);
  return excess(low) < 0 ? root_between(excess, least, low) : 0;
}

}  // namespace sprekk::laws
