// Parts of a joint law, the laws available for each part, and their entries.
#pragma once

#include "laws/joint_material.hpp"
#include "laws/kinds.hpp"

#include <string>
#include <vector>

namespace sprekk::laws {

/// Description of a law. Entries with the same number are alternatives.
struct Kind {
  std::string name, meaning;
  bool flat;  ///< available in 2D only
  std::vector<Entry> entries;
  std::vector<int> number;  ///< of each entry
};

/// Part of the joint law, and the laws available for it.
struct Role {
  std::string name, meaning;
  std::string JointMaterial::*chosen;
  std::vector<Kind> kinds;

  std::vector<std::string> names() const;
  const Kind* kind_of(const JointMaterial& material) const;  ///< selected law; null: its name is unknown
  std::vector<Entry> entries() const;                        ///< of all laws of this part, each name once
  std::vector<std::string> kinds_with(const std::string& entry) const;
  /// Names of the laws that require this entry and accept no alternative.
  std::vector<std::string> kinds_that_need(const std::string& entry) const;
};

/// All parts of the joint law.
const std::vector<Role>& roles();

/// Entry of a law; null: it has none of this name.
const Entry* entry_of(const Kind& kind, const std::string& name);

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

}  // namespace sprekk::laws
