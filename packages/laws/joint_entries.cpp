// Description and checks of the entries of a joint material.
#include "base/check.hpp"
#include "base/text.hpp"
#include "laws/joint_parameters.hpp"
#include "laws/joint_roles.hpp"

#include <algorithm>
#include <set>

namespace sprekk::laws {

namespace {

using Value = JointMaterial::Value;

/// Text for the reference: `Coulomb: in proportion to the compression; Barton-Choubey: ...`
std::string meaning_of(const Role& role) {
  std::string text = role.meaning;
  for (const auto& one : role.kinds) text += fmt::format("; {}: {}", one.name, one.meaning);
  return text;
}

bool vanishes(const Value& value) { return value.is_constant() && value({}, 0) == 0; }

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
    s.fail(entry.name, fmt::format("is \"{}\"; it may depend on the position, not on t", value->text()));
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
          "reduction factor F: friction and bond of the joint have 1/F of their strength; radiation damping is not "
          "reduced");
  for (const auto& [name, value] : {std::pair("initial gap", &initial_gap), {"initial aperture", &initial_aperture}})
    if (!value->constant_in_time())
      s.fail(name, fmt::format("is \"{}\"; it may depend on the position, not on t", value->text()));
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

}  // namespace sprekk::laws
