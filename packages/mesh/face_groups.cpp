#include "mesh/face_groups.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "base/text.hpp"

namespace sprekk::mesh {
namespace {

using Names = std::set<std::string>;

Names common(const Names& a, const Names& b) {
  Names result;
  for (const auto& name : a)
    if (b.count(name) > 0) result.insert(name);
  return result;
}

Names without(const Names& a, const Names& b) {
  Names result = a;
  for (const auto& name : b) result.erase(name);
  return result;
}

/// Complete list of names, for copying.
std::string listed(const Names& names) {
  std::string text;
  for (const auto& name : names) text += fmt::format("{}\"{}\"", text.empty() ? "" : ", ", name);
  return text;
}

/// Faces of each group.
std::map<std::string, std::vector<GlobalIndex>> faces_of_groups(const InnerFaces& faces) {
  std::map<std::string, std::vector<GlobalIndex>> result;
  for (const auto& [number, face] : faces)
    for (const auto& group : face.groups) result[group].push_back(number);
  return result;
}

/// Returns `fractures` and further groups without common faces; small groups are added first or last. Returns no value
/// if a face remains without a fracture.
std::optional<Names> completed(const InnerFaces& faces, Names fractures, bool small_first) {
  const auto of_group = faces_of_groups(faces);
  std::set<GlobalIndex> covered;
  std::vector<std::pair<long, std::string>> order;
  for (const auto& [group, numbers] : of_group) {
    const auto size = static_cast<long>(numbers.size());
    order.emplace_back(small_first ? size : -size, group);
    if (fractures.count(group) > 0) covered.insert(numbers.begin(), numbers.end());
  }
  std::sort(order.begin(), order.end());
  for (const auto& [size, group] : order) {
    const auto& numbers = of_group.at(group);
    if (std::any_of(numbers.begin(), numbers.end(), [&](auto face) { return covered.count(face) > 0; })) continue;
    fractures.insert(group);
    covered.insert(numbers.begin(), numbers.end());
  }
  return covered.size() == faces.size() ? std::optional(fractures) : std::nullopt;
}

/// Advice for a choice with each face exactly once. It retains the present fractures if possible and `may_stay`.
std::string advice(const InnerFaces& faces, const Names& fractures, bool may_stay) {
  std::optional<Names> choice;
  for (const auto& start : {may_stay ? fractures : Names{}, Names{}})
    for (const bool small_first : {true, false})
      if (!choice) choice = completed(faces, start, small_first);
  if (!choice) return "the groups overlap such that no choice of them has each face once; divide them";
  Names known;
  for (const auto& [group, numbers] : faces_of_groups(faces)) known.insert(group);
  const auto added = without(*choice, fractures), left_out = common(without(fractures, *choice), known);
  const auto leave = left_out.empty() ? "" : "leave out " + listed(left_out);
  if (added.empty()) return leave;
  return fmt::format("list {} among the fractures{}{}", listed(added), leave.empty() ? "" : " and ", leave);
}

}  // namespace

std::string wrong_fractures(const InnerFaces& faces, const std::vector<std::string>& fractures,
                            const std::vector<std::string>& boundaries) {
  const Names names(fractures.begin(), fractures.end());
  Names inside;
  const InnerFace* first = nullptr;
  for (const auto& [number, face] : faces) {
    const auto chosen = common(face.groups, names);
    if (chosen.size() > 1)
      return fmt::format("{} is in the fractures \"{}\" and \"{}\"; a face belongs to one fracture: {}", face.element,
                         *chosen.begin(), *std::next(chosen.begin()), advice(faces, names, false));
    if (!chosen.empty()) continue;
    if (!first) first = &face;
    inside.insert(face.groups.begin(), face.groups.end());
  }
  if (!first) return "";
  const auto group = *first->groups.begin();
  const auto others = without(inside, {group});
  return fmt::format(
      "{} of the physical group \"{}\" lies inside of the mesh, where a boundary cannot be{}; if {}, {}; boundaries "
      "are {}",
      first->element, group, others.empty() ? "" : ", as do faces of " + listed(others),
      others.empty() ? "it is a fracture" : "these are fractures", advice(faces, names, true),
      boundaries.empty() ? "none" : base::quoted_list(boundaries));
}

}  // namespace sprekk::mesh
