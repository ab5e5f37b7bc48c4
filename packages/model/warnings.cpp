#include "model/warnings.hpp"

#include "base/xml.hpp"
#include "physics/comparison.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

namespace sprekk::model {

namespace {

/// Whether expressions of the scene call a table by the time.
bool is_of_time(const std::string& scene, const std::string& table) {
  for (auto at = scene.find(table + '('); at != scene.npos; at = scene.find(table + '(', at + 1))
    if (at == 0 || !(std::isalnum(static_cast<unsigned char>(scene[at - 1])) || scene[at - 1] == '_'))
      if (scene.compare(at + table.size(), 3, "(t)") == 0) return true;
  return false;
}

/// How many steps leave out more than a twentieth of what a table does between their ends, and the first of its knots
/// there.
std::pair<int, Real> passed_over(const base::Table& table, const Time& time) {
  const auto [least, most] = std::minmax_element(table.values.begin(), table.values.end());
  int n = 0;
  Real first = 0, begin = time.start;
  const auto inside = [&](Real t) { return t >= table.arguments.front() && t <= table.arguments.back(); };
  for (const Real end : time.times()) {
    bool misses = false;
    auto knot = std::upper_bound(table.arguments.begin(), table.arguments.end(), begin);
    for (; inside(begin) && inside(end) && knot != table.arguments.end() && *knot < end && !misses; ++knot) {
      const Real s = (*knot - begin) / (end - begin), straight = (1 - s) * table(begin) + s * table(end);
      misses = std::abs(table(*knot) - straight) > 0.05 * (*most - *least);
      if (misses && n++ == 0) first = *knot;
    }
    begin = end;
  }
  return {n, first};
}

std::vector<std::string> steps_across_knots(const Scene& scene) {
  std::vector<std::string> all;
  if (scene.tables.empty()) return all;
  Scene copy = scene;
  const auto text = base::to_xml(base::effective(copy, "Sprekk"));
  for (const auto& [name, table] : scene.tables) {
    const auto [n, knot] = passed_over(table, scene.time);
    if (n > 0 && is_of_time(text, name))
      all.push_back(
          physics::implausible(fmt::format("{}: Sprekk > Time", scene.origin),
                               fmt::format("{} step{} over knots of the table \"{}\", the first at t = {:.6g} s", n,
                                           n == 1 ? " goes" : "s go", name, knot),
                               "loads count at the ends of steps alone, and slip depends on their path",
                               "take more \"steps\", or a \"schedule\" with the knots in it"));
  }
  return all;
}

}  // namespace

std::vector<std::string> scene_warnings(const Model& model) {
  const auto& scene = model.scene();
  std::vector<std::string> all;
  const auto add = [&](const std::vector<std::string>& some) { all.insert(all.end(), some.begin(), some.end()); };
  add(physics::conditions_that_hold_nowhere(scene, model.mesh()));
  add(physics::properties_passed_over(scene, model.mesh()));
  physics::for_each_physics([&](auto physics) { add(physics.doubts(model.setting(), true)); });
  physics::for_each_physics([&](auto physics) { add(physics.warnings(model.setting())); });
  physics::for_each_physics([&](auto physics) { add(physics.plausibility(model.setting(), scene.time.times())); });
  add(steps_across_knots(scene));
  return all;
}

}  // namespace sprekk::model
