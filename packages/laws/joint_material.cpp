#include "laws/joint_material.hpp"

#include "base/check.hpp"
#include "base/text.hpp"
#include "laws/conduit.hpp"
#include "laws/joint_parameters.hpp"
#include "laws/joint_slopes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace sprekk::laws {

namespace {

using Value = JointMaterial::Value;

/// Description of a law. Entries with the same number are alternatives.
struct Kind {
  std::string name, meaning;
  bool flat;  // available in 2D only
  std::vector<Entry> entries;
  std::vector<int> number;  // of each entry
};

template <class K, class = void>
constexpr bool is_flat = false;
template <class K>
constexpr bool is_flat<K, std::void_t<decltype(K::flat)>> = K::flat;

template <class K>
Kind kind() {
  Kind result{K::name, K::meaning, is_flat<K>, {}, {}};
  const auto parameters = K::parameters();
  for (const auto& parameter : parameters) {
    const auto same = [&](const auto& other) { return other.number == parameter.number; };
    result.entries.push_back(parameter.entry);
    result.number.push_back(
        static_cast<int>(std::find_if(parameters.begin(), parameters.end(), same) - parameters.begin()));
  }
  return result;
}

template <class... Ks>
std::vector<Kind> kinds(const Kinds<Ks...>&) {
  return {kind<Ks>()...};
}

/// Part of the joint law, and the laws available for it.
struct Role {
  std::string name, meaning;
  std::string JointMaterial::*chosen;
  std::vector<Kind> kinds;

  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const auto& one : kinds) all.push_back(one.name);
    return all;
  }
  const Kind* kind_of(const JointMaterial& material) const {
    for (const auto& one : kinds)
      if (one.name == material.*chosen) return &one;
    return nullptr;
  }
  /// Entries of all laws of this part, each name once.
  std::vector<Entry> entries() const {
    std::vector<Entry> all;
    for (const auto& one : kinds)
      for (const auto& entry : one.entries)
        if (std::none_of(all.begin(), all.end(), [&](const auto& other) { return other.name == entry.name; }))
          all.push_back(entry);
    return all;
  }
  std::vector<std::string> kinds_with(const std::string& entry) const {
    std::vector<std::string> with;
    for (const auto& one : kinds)
      for (const auto& other : one.entries)
        if (other.name == entry) with.push_back(one.name);
    return with;
  }
  /// Names of the laws that require this entry and accept no alternative.
  std::vector<std::string> kinds_that_need(const std::string& entry) const {
    std::vector<std::string> needed;
    for (const auto& one : kinds)
      for (std::size_t k = 0; k < one.entries.size(); ++k)
        if (one.entries[k].name == entry && std::count(one.number.begin(), one.number.end(), one.number[k]) == 1 &&
            !one.entries[k].optional && !one.entries[k].otherwise)
          needed.push_back(one.name);
    return needed;
  }
};

const std::vector<Role>& roles() {
  static const std::vector<Role> all = {
      {"tangential elasticity", "law of the elastic part of the tangential jump", &JointMaterial::tangential_elasticity,
       kinds(ShearKinds())},
      {"friction", "friction law, the bound on the shear traction", &JointMaterial::friction, kinds(FrictionKinds())},
      {"dilation", "dilation law, the opening by slip", &JointMaterial::dilation, kinds(DilationKinds())},
      {"closure", "closure law, the normal closure under compression", &JointMaterial::closure, kinds(ClosureKinds())},
      {"bond", "bond law, the cohesion and tensile strength in addition to friction", &JointMaterial::bond,
       kinds(BondKinds())},
      {"damage", "damage law, the wear of friction and dilation", &JointMaterial::damage, kinds(DamageKinds())},
      {"damage driver", "driver of damage, per unit of slip", &JointMaterial::damage_driver, kinds(DriverKinds())},
      {"hydraulic aperture", "hydraulic aperture law, the aperture for flow in the fracture, with \"Flow\"",
       &JointMaterial::hydraulic_aperture, kinds(ApertureKinds())}};
  return all;
}

/// Text for the reference: `Coulomb: in proportion to the compression; Barton-Choubey: ...`
std::string meaning_of(const Role& role) {
  std::string text = role.meaning;
  for (const auto& one : role.kinds) text += fmt::format("; {}: {}", one.name, one.meaning);
  return text;
}

const Entry* entry_of(const Kind& kind, const std::string& name) {
  for (const auto& entry : kind.entries)
    if (entry.name == name) return &entry;
  return nullptr;
}

bool vanishes(const Value& value) { return value.is_constant() && value({}, 0) == 0; }

/// Calls visit(entry, value) for the given entries of the selected laws.
template <class Visit>
void for_each_given(const JointMaterial& material, const Visit& visit) {
  for (const auto& role : roles())
    if (const auto* chosen = role.kind_of(material))
      for (const auto& entry : chosen->entries)
        if (const auto& value = material.entry(entry.name)) visit(entry, *value);
}

/// Calls visit(names of the alternatives, given names, whether one is required) for each number of the selected law.
template <class Visit>
void for_each_number(const JointMaterial& material, const Role& role, const Visit& visit) {
  const auto* chosen = role.kind_of(material);
  for (int number = 0; chosen && number < static_cast<int>(chosen->entries.size()); ++number) {
    std::vector<std::string> names, given;
    bool needed = false;
    for (std::size_t k = 0; k < chosen->entries.size(); ++k) {
      if (chosen->number[k] != number) continue;
      const auto& entry = chosen->entries[k];
      names.push_back(entry.name);
      needed = needed || !(entry.optional || entry.otherwise || (entry.found_in_situ && material.is_in_situ()));
      if (material.entry(entry.name)) given.push_back(entry.name);
    }
    if (!names.empty()) visit(names, given, needed);
  }
}

/// Text of an error message: `give either "friction coefficient" or "friction angle"`.
std::string give_one_of(const std::vector<std::string>& names) {
  std::string text = "give either ";
  for (std::size_t k = 0; k < names.size(); ++k)
    text += fmt::format("{}\"{}\"", k == 0 ? "" : k + 1 == names.size() ? " or " : ", ", names[k]);
  return text;
}

/// Text of an error message: `, or friction "no slip"`, for the laws of a part without entries.
std::string or_without_entries(const Role& role) {
  std::string text;
  for (const auto& one : role.kinds)
    if (one.entries.empty()) text += fmt::format(", or {} \"{}\"", role.name, one.name);
  return text;
}

/// Laws with this entry, e.g. `friction "Barton-Choubey", required` or `dilation "mobilised"`. Omits parts whose laws
/// all have the entry.
std::string owners_of(const std::string& entry, bool tell_required) {
  std::string text;
  for (const auto& role : roles()) {
    const auto with = role.kinds_with(entry), needed = role.kinds_that_need(entry);
    if (with.empty() || with.size() == role.kinds.size()) continue;
    text += fmt::format("{}{} {}{}", text.empty() ? "" : "; ", role.name, base::quoted_list(with),
                        tell_required && needed == with ? ", required" : "");
  }
  return text;
}

/// Declares an entry. Its meaning in the reference names the laws with this entry.
void describe_entry(base::Section& s, const Role& role, const Entry& entry, std::optional<Value>& value, bool of_all) {
  if (of_all && !value && entry.otherwise) value = *entry.otherwise;
  const auto with = role.kinds_with(entry.name), needed = role.kinds_that_need(entry.name);
  std::string meaning = entry.meaning;
  if (const auto owners = owners_of(entry.name, true); of_all && !owners.empty())
    meaning += fmt::format("; entry of {}", owners);
  if (of_all && needed != with && !needed.empty())
    meaning += fmt::format("; required with {} {}", role.name, base::quoted_list(needed));
  s.entry(value, entry.name, entry.unit, entry.bounds, meaning);
  if (value && !value->constant_in_time())
    s.fail(entry.name, fmt::format("is \"{}\"; it may depend on x, y, z, not on t", value->text()));
}

/// Text of an error message: `It belongs to friction "Coulomb"; here it is "Barton-Choubey"`.
std::string not_here(const JointMaterial& material, const std::string& entry) {
  std::vector<std::string> here;
  for (const auto& role : roles())
    if (!role.kinds_with(entry).empty()) here.push_back(material.*role.chosen);
  return fmt::format("It belongs to {}; here {} {}", owners_of(entry, false), here.size() == 1 ? "it is" : "they are",
                     base::quoted_list(here));
}

/// Returns whether a selected law has this entry.
bool is_in_use(const JointMaterial& material, const std::string& entry) {
  return std::any_of(roles().begin(), roles().end(), [&](const auto& role) {
    const auto* chosen = role.kind_of(material);
    return chosen && entry_of(*chosen, entry);
  });
}

/// Declares the entries of a part, except those already `described`: several parts may share entries.
void describe_role(base::Section& s, JointMaterial& material, const Role& role, bool of_all,
                   std::set<std::string>& described) {
  s.choice(material.*role.chosen, role.name, role.names(), meaning_of(role));
  of_all = of_all || !s.is_sound();
  const auto* chosen = role.kind_of(material);
  for (const auto& entry : role.entries()) {
    if (described.count(entry.name) > 0) continue;
    const auto* own = chosen ? entry_of(*chosen, entry.name) : nullptr;
    auto& value = material.entry(entry.name);
    if (own && !value && own->otherwise) value = *own->otherwise;
    if (own || of_all) {
      describe_entry(s, role, own ? *own : entry, value, of_all);
      described.insert(entry.name);
    } else {
      const auto reason = not_here(material, entry.name);
      const bool is_set = value && !(entry.otherwise && value->text() == Value(*entry.otherwise).text());
      if (is_set && !is_in_use(material, entry.name)) {  // by a host; entries of a file are declared only
        s.fail(entry.name, "unknown. " + reason);
        described.insert(entry.name);
      }
      s.hint({entry.name}, reason);
    }
    const std::string owners = own ? "" : " It belongs to " + owners_of(entry.name, false);
    s.hint(entry.others, fmt::format("Did you mean \"{}\"?{}", entry.name, owners));
  }
}

/// Members for entries that hosts set by name in C++ code; null: none.
std::optional<Value> JointMaterial::*member_of(const std::string& entry) {
  using Material = JointMaterial;
  const std::pair<const char*, std::optional<Value> Material::*> members[] = {
      {"tangential stiffness", &Material::tangential_stiffness},
      {"friction coefficient", &Material::friction_coefficient},
      {"friction angle", &Material::friction_angle},
      {"dilation angle", &Material::dilation_angle},
      {"maximum closure", &Material::maximum_closure},
      {"normal stiffness", &Material::normal_stiffness}};
  for (const auto& [name, member] : members)
    if (entry == name) return member;
  return nullptr;
}

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

JointMaterial::JointMaterial() {
  for (const auto& role : roles()) this->*role.chosen = role.kinds.front().name;
}

std::optional<Value>& JointMaterial::entry(const std::string& name) {
  const auto member = member_of(name);
  return member ? this->*member : more[name];
}

const std::optional<Value>& JointMaterial::entry(const std::string& name) const {
  static const std::optional<Value> none;
  if (const auto member = member_of(name)) return this->*member;
  const auto found = more.find(name);
  return found == more.end() ? none : found->second;
}

void JointMaterial::describe(base::Section& s, bool of_all_kinds) {
  std::set<std::string> described;
  for (const auto& role : roles()) {
    if (role.name == "closure")
      s.entry(initial_gap, "initial gap", "m", base::any(), "gap g0 of (14), without load and slip");
    describe_role(s, *this, role, of_all_kinds, described);
  }
  s.entry(initial_aperture, "initial aperture", "m", base::at_least(0),
          "aperture a0 of (15), without load and slip, or that of another \"reference state\"; typical: 1e-6 to 3e-4 "
          "(material library)");
  s.choice(reference_state, "reference state", {"unloaded", "in situ", "in situ hydraulic"},
           "state of the joint with the initial aperture; unloaded: without load and slip; in situ: with the initial "
           "stress, pressure and slip; in situ hydraulic: likewise, and the value is the hydraulic aperture");
  s.entry(strength_reduction, "strength reduction factor", "-", base::positive(),
          "reduction factor F: friction and bond of the joint have 1/F of their strength");
  for (const auto& [name, value] : {std::pair("initial gap", &initial_gap), {"initial aperture", &initial_aperture}})
    if (!value->constant_in_time())
      s.fail(name, fmt::format("is \"{}\"; it may depend on x, y, z, not on t", value->text()));
}

void JointMaterial::compare_entries(base::Section& s) const {
  for (const auto& role : roles())
    for_each_number(*this, role, [&](const auto& names, const auto& given, bool) {
      if (given.size() > 1) s.fail(give_one_of(names));
    });
  for_each_given(*this, [&](const Entry& entry, const Value& value) {
    if (!entry.needs.empty() && !vanishes(value) && !this->entry(entry.needs))
      s.fail(entry.needs, fmt::format("missing; it is required with a \"{}\" above 0", entry.name));
  });
  if (is_in_situ() && !vanishes(initial_gap))
    s.fail("initial gap", fmt::format("must be absent or 0 with \"reference state\" {}: an aperture does not determine "
                                      "it",
                                      reference_state));
  if (!s.complete() || !is_uniform() || !missing().empty()) return;
  try {
    joint({});
  } catch (const Error& error) {  // errors of combined values
    s.fail(error.what());
  }
}

bool JointMaterial::is_uniform() const {
  bool uniform = initial_gap.is_constant() && initial_aperture.is_constant();
  for_each_given(*this, [&](const Entry&, const Value& value) { uniform = uniform && value.is_constant(); });
  return uniform;
}

std::vector<std::array<std::string, 2>> JointMaterial::missing(const std::string& only) const {
  std::vector<std::array<std::string, 2>> all;
  for (const auto& role : roles())
    for_each_number(*this, role, [&](const auto& names, const auto& given, bool needed) {
      if (!needed || (!only.empty() && role.name != only) || !given.empty()) return;
      if (names.size() > 1)
        all.push_back({"", give_one_of(names) + or_without_entries(role)});
      else
        all.push_back({names[0], fmt::format("missing; it is required with {} \"{}\": {}", role.name,
                                             this->*role.chosen, entry_of(*role.kind_of(*this), names[0])->meaning)});
    });
  return all;
}

std::vector<std::array<std::string, 2>> JointMaterial::only_in_2d() const {
  std::vector<std::array<std::string, 2>> all;
  for (const auto& role : roles())
    if (const auto* chosen = role.kind_of(*this); chosen && chosen->flat)
      all.push_back({role.name, fmt::format("is \"{}\", which is available only in 2D", chosen->name)});
  return all;
}

void JointMaterial::check(const Point& x) const {
  const auto check_value = [&](const std::string& name, const Value& value, const base::Bounds& bounds) {
    if (value.is_constant()) return;  // checked when it was read
    const Real v = value(x, 0);
    SPREKK_CHECK(bounds.contains(v), "\"{}\" = {} is {} at ({}, {}, {}), must be {}", name,
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
  const Real zero = 0;  // all history variables
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
