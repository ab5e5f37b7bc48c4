// Hyperbolic closure with an irrecoverable part.
#pragma once

#include "laws/closure/barton_bandis.hpp"

namespace sprekk::laws {

/// Normal closure, m, with the hyperbola V of Barton and Bandis, the compression N and its largest value so far, N_max:
///   B = -(1 - r) V(N) - r V(max(N, N_max))
/// First loading follows V. Below N_max the joint is stiffer by the factor 1/(1 - r). The closure r V(N_max) remains
/// after unloading. A cycle dissipates the area between its branches, which is never negative. V is the equation of
/// Bandis et al. (1983). The unloading rule is specific to Sprekk; the one of the paper, by JRC and JCS, was not
/// available.
struct BartonBandisCycles : BartonBandisClosure {
  static constexpr int n_history = 1;  ///< N_max, Pa
  Real retained = 0;                   ///< r
  Real past = 0;                       ///< N_max at the start, Pa

  static constexpr const char *name = "Barton-Bandis with memory",
                              *meaning = "hyperbolic, with a part that unloading does not recover";
  static std::vector<Parameter<BartonBandisCycles>> parameters() {
    std::vector<Parameter<BartonBandisCycles>> all;
    for (const auto& [number, entry] : BartonBandisClosure::parameters()) all.push_back({number, entry});
    all.push_back(
        {&BartonBandisCycles::retained, Entry{"irrecoverable part of closure", "-", base::at_least(0).below(1),
                                              "fraction r of the closure under the largest compression so far"}});
    all.push_back(
        {&BartonBandisCycles::past,
         Entry{"largest past compression", "Pa", base::at_least(0),
               "largest compression of the joint before the start; of a joint in situ at least the initial one"}
             .or_else(0)});
    return all;
  }
  static std::vector<Quantity<BartonBandisCycles>> quantities() {
    return {{"largest compression", "Pa", "that the joint has borne so far",
             [](const BartonBandisCycles& law, const Contact<Real>& at) { return law.largest_compression(at); }}};
  }

  template <class T>
  KOKKOS_INLINE_FUNCTION T opening(const Contact<T>& at) const {
    const T now = BartonBandisClosure::opening(at);
    Contact<Real> largest;
    largest.lambda_n = -largest_compression(at);
    if (!(at.lambda_n > largest.lambda_n)) return now;
    return (1 - retained) * now + retained * BartonBandisClosure::opening(largest);
  }
  KOKKOS_INLINE_FUNCTION void commit(const Contact<Real>& at, const Numbers<Real>& history) const {
    if (-at.lambda_n > history[0]) history[0] = -at.lambda_n;
  }
  /// Law of a joint under the compression N, Pa. Throws an Error if N exceeds a given largest past compression.
  BartonBandisCycles in_situ(Real N, Real) const;

 private:
  /// N_max, Pa.
  template <class T>
  KOKKOS_INLINE_FUNCTION Real largest_compression(const Contact<T>& at) const {
    return at.history[0] > past ? at.history[0] : past;
  }
};

}  // namespace sprekk::laws
