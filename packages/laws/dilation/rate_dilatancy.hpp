// Dilation of gouge, whose porosity depends on the slip rate.
#pragma once

#include "laws/contact.hpp"
#include "laws/exponentials.hpp"
#include "laws/friction/rate_entries.hpp"
#include "laws/kinds.hpp"

#include <cmath>

namespace sprekk::laws {

/// Opening by a change of the porosity of gouge, m: o = h (phi - phi_i), where h is the thickness of the gouge, phi_i
/// the porosity at the start, and (Segall and Rice 1995)
///   d phi/dt = -(V/L) (phi - phi_ss),  phi_ss = phi_0 + eps ln(V/V_0)
/// Gouge at the start is in steady slip at the rate V_i: phi_i = phi_ss(V_i). Then phi_0 and V_0 have no effect. A step
/// of the slip s and the length dt is integrated exactly for the constant rate V = s/dt:
///   o = o_old + (o_ss - o_old) (1 - exp(-s/L)),  o_ss = h eps ln(V/V_i)
/// The opening decreases if the rate falls below that of the present porosity. It is constant without slip.
struct RateDilatancy {
  static constexpr int n_history = 1;  ///< o, m
  Real coefficient = 0;                ///< eps
  Real thickness = 0;                  ///< h, m
  Real distance = 1;                   ///< L, m
  Real initial_rate = 1e-9;            ///< V_i, m/s

  static constexpr const char *name = "slip rate",
                              *meaning = "of gouge, whose porosity depends on the slip rate (Segall and Rice 1995)";
  static std::vector<Parameter<RateDilatancy>> parameters() {
    using Law = RateDilatancy;
    return {{&Law::coefficient, Entry{"dilatancy coefficient", "-", base::at_least(0),
                                      "coefficient eps, the change of the porosity of gouge in steady slip per change "
                                      "of the logarithm of the slip rate; typical: 1e-5 to 1e-3"}},
            {&Law::thickness, Entry{"gouge thickness", "m", base::positive(), "thickness h of the gouge"}},
            {&Law::distance, evolution_distance_entry()},
            {&Law::initial_rate, initial_rate_entry()}};
  }
  static std::vector<Quantity<RateDilatancy>> quantities() {
    return {{"opening by slip rate", "m", "by the change of the porosity of gouge",
             [](const RateDilatancy&, const Contact<Real>& at) -> Real { return at.history[0]; }}};
  }

  template <class T>
  KOKKOS_INLINE_FUNCTION T opening(const Contact<T>& at) const {
    using std::log;
    const Real old = at.history[0];
    if (!(at.duration > 0) || !(at.slip_of_step > 0)) return T(old);
    const T steady = thickness * coefficient * log(at.slip_of_step / (at.duration * initial_rate));
    return old - (steady - old) * exponential_less_one(T(-at.slip_of_step / distance));
  }
  KOKKOS_INLINE_FUNCTION void commit(const Contact<Real>& at, const Numbers<Real>& history) const {
    history[0] = opening(at);
  }
};

}  // namespace sprekk::laws
