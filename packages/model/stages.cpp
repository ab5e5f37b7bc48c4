#include "model/stages.hpp"

#include "base/text.hpp"
#include "model/scene.hpp"

#include <algorithm>
#include <array>

namespace sprekk::model {

namespace {

/// Sections that cannot change during a run.
constexpr std::array constant_sections = {"Mesh",   "Mesh file", "Time",     "Output",
                                          "Probes", "Stages",    "Accuracy", "Growth"};

std::vector<std::string> parts_of(const std::string& path) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= path.size();) {
    const auto end = std::min(path.find('>', begin), path.size());
    parts.emplace_back(base::trimmed(std::string_view(path).substr(begin, end - begin)));
    begin = end + 1;
  }
  return parts;
}

/// Adds the entries of `changes` to `list` or replaces existing ones.
void merge(const Teuchos::ParameterList& changes, Teuchos::ParameterList& list) {
  for (const auto& named_entry : changes) {
    const auto& name = named_entry.first;
    const auto& entry = named_entry.second;
    if (!entry.isList())
      list.setEntry(name, entry);
    else if (list.isParameter(name) && !list.isSublist(name))
      list.set(name, changes.sublist(name));
    else
      merge(changes.sublist(name), list.sublist(name));
  }
}

/// Removes the section or entry at a path. Returns the reason of a failure, or an empty text.
std::string remove(const std::string& path, Teuchos::ParameterList& list) {
  const auto parts = parts_of(path);
  auto* at = &list;
  for (auto part = parts.begin(); part + 1 != parts.end() && at; ++part)
    at = at->isSublist(*part) ? &at->sublist(*part) : nullptr;
  if (at && at->remove(parts.back(), false)) return "";
  std::vector<std::string> names;
  for (const auto& named_entry : at ? *at : list) names.push_back(named_entry.first);
  return fmt::format("names \"{}\", which the scene does not have at this time{}", path,
                     base::did_you_mean(parts.back(), names));
}

}  // namespace

void Stage::describe(base::Section& s) {
  s.required(time, "time", "s", "begin of the stage, at the end of a step");
  s.entry(without, "without", "-",
          "paths of sections and entries that the stage removes, e.g. Boundary conditions > pull");
  s.entry(excavate, "excavate", "-",
          "names of regions that the stage excavates; their walls become boundaries of the same names, and fractures "
          "end there");
  s.entry(backfill, "backfill", "-",
          "names of excavated regions that the stage fills with the materials of \"Regions\", unloaded when placed");
  s.entry(release, "release", "s", base::positive(),
          "duration of the linear release of unbalanced forces at the begin of the stage; absent: release in its first "
          "step");
  s.other_sections(changes, "entries of this section of the scene from this stage on; other entries remain");
  for (const char* name : constant_sections)
    if (changes.isParameter(name)) s.fail_inside(fmt::format("{}: a stage cannot change it", name));
  if (changes.isSublist("Fractures") && changes.sublist("Fractures").isParameter("material"))
    s.fail_inside("Fractures > \"material\": a stage changes the materials of fractures by their names");
}

void check_stages(base::Section& s, const Stages& stages, Real start) {
  std::map<Real, std::string> at;
  for (const auto& [name, stage] : stages) {
    const auto place = fmt::format("Stages > {} > \"time\": is {} s: ", name, stage.time);
    if (!(stage.time > start))
      s.fail_inside(place + fmt::format("must be after the \"start\" of \"Time\", {} s", start));
    else if (const auto [other, is_new] = at.emplace(stage.time, name); !is_new)
      s.fail_inside(place + fmt::format("the stage \"{}\" begins then", other->second));
  }
}

std::vector<StagedScene> staged_scenes(const Scene& scene) {
  std::vector<std::pair<std::string, Stage>> stages(scene.stages.begin(), scene.stages.end());
  std::sort(stages.begin(), stages.end(), [](const auto& a, const auto& b) { return a.second.time < b.second.time; });
  std::vector<StagedScene> all;
  if (stages.empty()) return all;
  Scene copy = scene;  // copy, because describe() could change it
  auto list = base::effective(copy, "Sprekk");
  for (const auto& [name, stage] : stages) {
    const auto origin = fmt::format("{}: stage \"{}\"", scene.origin, name);
    std::vector<std::string> errors;
    for (const auto& path : stage.without)
      if (const auto why = remove(path, list); !why.empty())
        errors.push_back(fmt::format("{}: \"without\": {}", origin, why));
    merge(stage.changes, list);
    for (const auto& region : stage.excavate) list.sublist("Regions").sublist(region).set("excavated", true);
    for (const auto& region : stage.backfill) {
      auto& regions = list.sublist("Regions");
      auto& entries = regions.sublist(region);
      if (std::find(stage.excavate.begin(), stage.excavate.end(), region) != stage.excavate.end())
        errors.push_back(
            fmt::format("{}: \"backfill\": names \"{}\", and so does \"excavate\": take two stages", origin, region));
      if (!entries.isType<bool>("excavated") || !entries.get<bool>("excavated"))
        errors.push_back(
            fmt::format("{}: \"backfill\": names \"{}\", which is not excavated at this time", origin, region));
      entries.remove("excavated", false);
      if (entries.begin() == entries.end()) regions.remove(region);  // the material of Bulk
    }
    if (stage.release) {
      const std::array<Real, 2> times = {stage.time, stage.time + *stage.release};
      list.sublist("Bulk").set("release", Teuchos::Array<Real>(times.begin(), times.end()));
    }
    all.push_back({name, stage.time, base::draft<Scene>(list, origin, "Sprekk", errors)});
    auto& staged = all.back().draft.value;
    staged.origin = origin;
    staged.keep(scene);
    staged.solver.should_stop = scene.solver.should_stop;
  }
  return all;
}

}  // namespace sprekk::model
