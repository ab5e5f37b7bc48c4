// Bond with linear softening by opening and slip.
#pragma once

#include "laws/bond/none.hpp"

#include <algorithm>
#include <limits>

namespace sprekk::laws {

/// Bond with the shear strength c and the tensile strength T. Opening and slip reduce both strengths by the
/// factor 1 - D:
///   D = min(1, o_max/o_f + s/s_f),  o_f = 2 G_I/T,  s_f = 2 G_II/c
/// o is the separation w_n - g, o_max its largest value so far, s the path length of slip. o and s count in all contact
/// states. With T = 0 opening causes no damage, with c = 0 slip causes none.
/// * Never separated: the sides stay together up to lambda_n = (1 - D) T.
/// * Separated, o = o_max: lambda_n = (1 - D) T. Opening alone dissipates G_I per area.
/// * Separated, o < o_max: lambda_n = (1 - D) T o/o_max (secant unloading without a plastic part).
/// * Shear: (1 - D) c is added to the friction bound.
struct SofteningBond {
  static constexpr int n_history = 2;  ///< o_max, s; m
  Real shear = 0;                      ///< c, Pa
  Real tensile = 0;                    ///< T, Pa
  Real energy = 0;                     ///< G_I, J/m^2
  Real shear_energy = 0;               ///< G_II, J/m^2

  static constexpr const char *name = "linear softening",
                              *meaning = "tensile and shear strength that decrease with opening and slip";
  static std::vector<Parameter<SofteningBond>> parameters() {
    using Law = SofteningBond;
    return {
        {&Law::shear, Entry{"cohesion", "Pa", base::at_least(0),
                            "cohesion c, the shear strength of the bond in addition to friction"}
                          .with("shear fracture energy")},
        {&Law::tensile,
         Entry{"tensile strength", "Pa", base::at_least(0), "tensile strength T of the intact bond"}.or_else(0).with(
             "fracture energy")},
        {&Law::energy, Entry{"fracture energy", "J/m^2", base::positive(),
                             "fracture energy G_I, dissipated by opening until the bond is lost"}
                           .may_be_absent()},
        {&Law::shear_energy,
         Entry{"shear fracture energy", "J/m^2", base::positive(),
               "fracture energy G_II, dissipated by slip in addition to friction until the bond is lost"}
             .may_be_absent()}};
  }
  static std::vector<Quantity<SofteningBond>> quantities() { return quantities_of_softening<SofteningBond>(); }

  /// Estimate 0.8 E' G_I/T^2 of the length of the process zone behind a front in opening, m (Hillerborg et al. 1976;
  /// factor of linear softening), for the modulus E' = E/(1 - nu^2), Pa; infinite without tensile strength.
  Real process_zone(Real modulus) const {
    return tensile > 0 ? 0.8 * modulus * energy / (tensile * tensile) : std::numeric_limits<Real>::infinity();
  }

  template <class T>
  KOKKOS_INLINE_FUNCTION Cohesion<T> cohesion(const Contact<T>& at) const {
    const Real parted = at.history[0];
    const T widest = at.separation > parted ? at.separation : T(parted);
    const T left = 1 - widest * use(tensile, energy) - (at.history[1] + at.slip_of_step) * use(shear, shear_energy);
    if (!(left > 0)) return {};
    const T tension = tensile * left;
    if (!(parted > 0)) return {shear * left, tension, tension, !(tensile > 0)};
    return {shear * left, T(0), at.separation < parted ? T(tension * at.separation / parted) : tension, !(tensile > 0)};
  }

  KOKKOS_INLINE_FUNCTION void commit(const Contact<Real>& at, const Numbers<Real>& history) const {
    const bool apart = history[0] > 0 || at.open || at.lambda_n >= (1 - rounding) * cohesion(at).strength;
    const Real parted = at.separation;
    if (apart && parted * use(tensile, energy) > rounding && parted > history[0]) history[0] = parted;
    history[1] += at.slip_of_step;
  }

 protected:
  template <class K>
  static std::vector<Quantity<K>> quantities_of_softening() {
    return {
        {"damage of bond", "-", "the part of its strengths that opening and slip have used up", damage<K>},
        {"broken fraction", "-", "the damage of the bond", damage<K>, "", "area broken"},
        {"energy of damage", "J/m^2", "G_I times the damage of the bond, dissipated by opening without slip",
         [](const K& law, const Contact<Real>& at) { return law.energy * damage(law, at); }, "", "fracture energy"}};
  }

 private:
  static constexpr Real rounding = 1e-9;  ///< relative tolerance of tractions and separations against round-off

  Real used_by_opening(const Contact<Real>& at) const { return at.history[0] * use(tensile, energy); }
  Real used_by_slip(const Contact<Real>& at) const { return at.history[1] * use(shear, shear_energy); }
  template <class K>
  static Real damage(const K& law, const Contact<Real>& at) {
    return std::min(Real(1), law.used_by_opening(at) + law.used_by_slip(at));
  }

  /// Damage per length of opening or slip, 1/m: strength/(2 energy).
  KOKKOS_INLINE_FUNCTION static Real use(Real strength, Real energy) {
    return energy > 0 ? strength / (2 * energy) : Real(0);
  }
};

}  // namespace sprekk::laws
