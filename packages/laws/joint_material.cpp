#include "laws/joint_material.hpp"

#include "base/check.hpp"
#include "base/text.hpp"
#include "laws/conduit.hpp"
#include "laws/joint_parameters.hpp"
#include "laws/joint_roles.hpp"
#include "laws/joint_slopes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sprekk::laws {

namespace {

using Value = JointMaterial::Value;

template <class K, class = void>
constexpr bool can_complete = false;
template <class K>
constexpr bool can_complete<K, std::void_t<decltype(std::declval<K>().complete())>> = true;

template <class K, class = void>
constexpr bool has_defect = false;
template <class K>
constexpr bool has_defect<K, std::void_t<decltype(std::declval<K>().defect())>> = true;

/// Law K with the values of the material at x. Throws an Error for inconsistent values.
template <class K>
K law_at(const JointMaterial& material, const JointMaterial::Point& x) {
  K law;
  for (const auto& [number, entry] : K::parameters()) {
    const auto& value = material.entry(entry.name);
    if (!value && !entry.otherwise) continue;
    const Real v = value ? (*value)(x, 0) : *entry.otherwise;
    law.*number = entry.number_of ? entry.number_of(v) : v;
  }
  if constexpr (can_complete<K>) law.complete();
  if constexpr (has_defect<K>) {
    const std::string defect = law.defect();
    SPREKK_CHECK(defect.empty(), "{}", defect);
  }
  return law;
}

template <class Part, class... Ks>
void set_part(Part& part, const Kinds<Ks...>&, const std::string& kind, const JointMaterial& material,
              const JointMaterial::Point& x) {
  ((kind == Ks::name ? void(part = law_at<Ks>(material, x)) : void()), ...);
}

Real degrees(Real tangent) { return std::atan(tangent) * 180 / M_PI; }

/// Error message if slip from rest would release energy, i.e. if friction is below the work of dilation: b < N dg/ds.
/// Checks laws with history variables at some slips and compressions; empty: no error found.
std::string gain_by_slip(const Joint& law) {
  if (law.n_history() == 0) return "";
  const Real zero = 0;  // all history variables
  for (const Real compression : {1.0, 1e3, 1e5, 1e6, 1e7})
    for (const Real slip : {0.0, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 1.0}) {
      const Contact<Real> at{.lambda_n = -compression,
                             .plastic_slip = slip,
                             .slip_of_step = slip,
                             .plastic_jump = {slip, 0},
                             .history = {&zero, 0}};
      const Real opens = dilation_slope(law, at);
      if (!(opens > 0)) continue;
      const Real bound = law.friction_bound(at);
      if (bound < (1 - 1e-9) * opens * compression)
        return fmt::format(
            "slip would produce energy instead of dissipating it: after a slip of {:.3g} m under {:.3g} Pa the "
            "friction bound is {:.4g} Pa, and dilation requires {:.4g} Pa; at any slip the dilation angle, here {:.4g} "
            "degrees, must not exceed the friction angle, here {:.4g} degrees",
            slip, compression, bound, opens * compression, degrees(opens), degrees(bound / compression));
    }
  return "";
}

}  // namespace

void JointMaterial::check(const Point& x) const {
  const auto check_value = [&](const std::string& name, const Value& value, const base::Bounds& bounds) {
    if (value.is_constant()) return;  // checked when it was read
    const Real v = value(x, 0);
    SPREKK_CHECK(bounds.contains(v), "\"{}\" = {} is {:.6g} at ({:.6g}, {:.6g}, {:.6g}), must be {}", name,
                 base::shortened(value.text()), v, x[0], x[1], x[2], bounds.text());
  };
  for_each_given(*this, [&](const Entry& entry, const Value& value) { check_value(entry.name, value, entry.bounds); });
  check_value("initial gap", initial_gap, base::any());
  check_value("initial aperture", initial_aperture, base::at_least(0));
}

bool JointMaterial::depends_on_rate() const {
  Joint law;
  if (missing("friction").empty()) set_part(law.friction, FrictionKinds(), friction, *this, {});
  return law.depends_on_rate();
}

namespace {

/// Multiplies the radiation damping by a factor, if there is any.
Friction with_damping(const Friction& friction, Real factor) {
  return friction.visit([&](auto law) {
    if constexpr (requires { law.damping; }) law.damping *= factor;
    return Friction(law);
  });
}

}  // namespace

JointParameters JointMaterial::joint(const Point& x) const {
  check(x);
  for (const auto& [entry, what] : missing())
    throw Error(entry.empty() ? what : fmt::format("\"{}\": {}", entry, what));
  JointParameters joint;
  set_part(joint.law.elastic, ShearKinds(), tangential_elasticity, *this, x);
  set_part(joint.law.friction, FrictionKinds(), friction, *this, x);
  set_part(joint.law.gap.dilation, DilationKinds(), dilation, *this, x);
  set_part(joint.law.gap.closure, ClosureKinds(), closure, *this, x);
  set_part(joint.law.bond, BondKinds(), bond, *this, x);
  set_part(joint.law.damage, DamageKinds(), damage, *this, x);
  set_part(joint.law.driver, DriverKinds(), damage_driver, *this, x);
  joint.law.gap.initial = initial_gap(x, 0);
  joint.law.strength = 1 / strength_reduction;
  joint.law.friction = with_damping(joint.law.friction, strength_reduction);  // a resistance of the rock, not reduced
  const Real zero = 0;                                                        // all history variables
  Contact<Real> at_rest;
  at_rest.history = {&zero, 0};
  const Real dilates = dilation_slope(joint.law, at_rest);
  joint.law.sliding_compliance =
      std::max(bound_slope(joint.law, 0) * dilates, Real(0)) * joint.law.elastic.initial_compliance();
  joint.initial_aperture = aperture(x);
  joint.in_situ = is_in_situ();
  SPREKK_CHECK(
      !joint.law.depends_on_rate() || (bond == NoBond::name && damage == NoDamage::name),
      "friction \"{}\" depends on the slip rate and requires bond \"{}\" and damage \"{}\"; they are \"{}\" and "
      "\"{}\"",
      friction, NoBond::name, NoDamage::name, bond, damage);
  SPREKK_CHECK(dilation != RateDilatancy::name || friction == AgeingFriction::name || friction == SlipLawFriction::name,
               "dilation \"{}\" requires friction \"{}\" or \"{}\", whose state controls the steps; it is \"{}\"",
               dilation, AgeingFriction::name, SlipLawFriction::name, friction);
  const std::string gain = gain_by_slip(joint.law);
  using Friction = MobilisedBartonChoubeyFriction;
  SPREKK_CHECK(gain.empty() || friction != Friction::name || dilation == MobilisedDilation::name,
               "{}; friction \"{}\" is 0 at the start of slip and requires dilation \"{}\", which begins later", gain,
               friction, MobilisedDilation::name);
  SPREKK_CHECK(gain.empty(), "{}", gain);
  return joint;
}

Real JointMaterial::aperture(const Point& x) const {
  check(x);
  const Real a = initial_aperture(x, 0);
  return reference_state == "in situ hydraulic" ? walls(x).mechanical(a) : a;
}

HydraulicAperture JointMaterial::walls(const Point& x) const {
  check(x);
  HydraulicAperture walls;
  set_part(walls, ApertureKinds(), hydraulic_aperture, *this, x);
  return walls;
}

std::optional<JointMaterial::Slope> JointMaterial::friction_slope(Real minimum, Real largest) const {
  const auto& role =
      *std::find_if(roles().begin(), roles().end(), [](const auto& one) { return one.name == "friction"; });
  bool known = friction != NoSlip::name;
  for_each_number(*this, role, [&](const auto& names, const auto& given, bool needed) {
    for (const auto& name : given) known = known && entry(name)->is_constant();
    known = known && !(needed && given.empty());
  });
  if (!known) return {};
  Joint law;
  law.strength = 1 / strength_reduction;
  set_part(law.friction, FrictionKinds(), friction, *this, {});
  Slope slope{-std::numeric_limits<Real>::infinity(), true, 0};
  Real first = 0;
  constexpr int n = 40;  // number of compressions, evenly spaced on a logarithmic scale
  for (int k = 0; k <= n; ++k) {
    const Real compression = minimum * std::pow(largest / minimum, Real(k) / n), here = bound_slope(law, compression);
    if (k == 0) first = here;
    slope.constant = slope.constant && std::abs(here - first) <= 1e-12 * std::abs(first);
    slope.largest = std::max(slope.largest, here);
    if (here > 1) slope.up_to = compression;
  }
  return slope;
}

}  // namespace sprekk::laws
