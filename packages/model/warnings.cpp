// Warnings about implausible scenes.

#include "base/over_ranks.hpp"
#include "model/knots.hpp"
#include "model/model.hpp"
#include "physics/comparison.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace sprekk::model {

namespace {

/// Returns the number of steps that skip a relevant knot of a table, and the time of the first such knot. At a relevant
/// knot, the table deviates from a linear variation over the step by more than 0.05 of its range.
std::pair<int, Real> passed_over(const TableOfTime& of, const Time& time) {
  const auto& table = *of.table;
  const auto [minimum, maximum] = std::minmax_element(table.values.begin(), table.values.end());
  int n = 0;
  Real first = 0, begin = of.shift + of.factor * time.start;
  const auto inside = [&](Real s) { return s >= table.arguments.front() && s <= table.arguments.back(); };
  for (const Real t : time.times()) {
    const Real end = of.shift + of.factor * t;
    bool misses = false;
    auto knot = std::upper_bound(table.arguments.begin(), table.arguments.end(), std::min(begin, end));
    const auto between = [&] { return knot != table.arguments.end() && *knot < std::max(begin, end); };
    for (; inside(begin) && inside(end) && between() && !misses; ++knot) {
      const Real s = (*knot - begin) / (end - begin), straight = (1 - s) * table(begin) + s * table(end);
      misses = std::abs(table(*knot) - straight) > 0.05 * (*maximum - *minimum);
      if (misses && n++ == 0) first = (*knot - of.shift) / of.factor;
    }
    begin = end;
  }
  return {n, first};
}

/// Warns about steps that skip knots of tables. Adaptive steps meet all knots.
std::vector<std::string> steps_across_knots(const Scene& scene) {
  std::vector<std::string> all;
  if (scene.time.chooses_steps()) return all;
  for (const auto& of : tables_of_time(scene)) {
    const auto [n, knot] = passed_over(of, scene.time);
    if (n > 0)
      all.push_back(
          physics::implausible(fmt::format("{}: Sprekk > Time", scene.origin),
                               fmt::format("{} step{} over knots of the table \"{}\", the first at t = {:.6g} s", n,
                                           n == 1 ? " goes" : "s go", of.name, knot),
                               "loads are evaluated only at the ends of steps, and results depend on their path",
                               "take more \"steps\", a \"schedule\" with the knots in it, or a \"tolerance\""));
  }
  return all;
}

std::vector<std::string> stages_after_the_end(const Scene& scene) {
  std::vector<std::string> all;
  const Real end = scene.time.times().back();
  for (const auto& [name, stage] : scene.stages) {
    const auto place = fmt::format("{}: Sprekk > Stages > {} > ", scene.origin, name);
    if (stage.time >= end)
      all.push_back(physics::implausible(
          place + "\"time\"", fmt::format("is {:.6g} s, and the last step ends at {:.6g} s", stage.time, end),
          "the stage never begins", "let the run end later, or leave the stage out"));
    else if (const Real released = stage.time + stage.release.value_or(0); released > end)
      all.push_back(physics::implausible(
          place + "\"release\"", fmt::format("lasts to {:.6g} s, and the last step ends at {:.6g} s", released, end),
          "part of the forces is not released", "let the run end later, or release in less time"));
  }
  return all;
}

/// Times for the inspection of loads: ends of steps; for adaptive steps, also intermediate times and knots.
std::vector<Real> looked_at(const Scene& scene) {
  auto times = scene.time.times();
  if (!scene.time.chooses_steps()) return times;
  const Real start = scene.time.start, end = times.back();
  constexpr int n = 50;
  for (int k = 1; k < n; ++k) times.push_back(start + (end - start) * k / n);
  const auto turns = knots(scene, end);
  times.insert(times.end(), turns.begin(), turns.end());
  std::sort(times.begin(), times.end());
  return times;
}

std::vector<std::string> toughness_without_growth(const Scene& scene) {
  std::vector<std::string> all;
  for (const auto& [name, fracture] : scene.fractures)
    if (fracture.toughness && !scene.growth)
      all.push_back(physics::implausible(fmt::format("{}: Sprekk > Fractures > {} > \"toughness\"", scene.origin, name),
                                         "is given, and the scene has no section \"Growth\"",
                                         "the fracture does not grow", "add the section with a \"segment\""));
  return all;
}

/// Warns about fractures that grow and are shorter than an extension. Collective.
std::vector<std::string> segments_longer_than_fractures(const Scene& scene, const mesh::Mesh& mesh) {
  std::vector<std::string> all;
  if (!scene.growth) return all;
  std::vector<Real> lengths(mesh.single_fractures.size(), 0);
  for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f)
    lengths[mesh.fracture_faces[f].single] += mesh.fracture_faces[f].area;
  lengths = base::sum_over_ranks(*mesh.comm, lengths);
  for (std::size_t k = 0; k < lengths.size(); ++k)
    if (const auto& [name, set] = std::tie(mesh.single_fractures[k].name, mesh.single_fractures[k].set);
        scene.fractures.at(mesh.fracture_names[set]).toughness && lengths[k] < scene.growth->segment) {
      all.push_back(physics::implausible(fmt::format("{}: Sprekk > Growth > \"segment\"", scene.origin),
                                         fmt::format("is {:.6g} m, and the fracture \"{}\" has a length of {:.6g} m",
                                                     scene.growth->segment, name, lengths[k]),
                                         "the first extension exceeds the crack whose load determines it",
                                         "shorten the \"segment\""));
      break;
    }
  return all;
}

}  // namespace

std::vector<std::string> Model::warnings() const {
  const auto times = looked_at(scene_);
  std::vector<std::string> all;
  const auto add = [&](const std::vector<std::string>& some) { all.insert(all.end(), some.begin(), some.end()); };
  add(physics::conditions_without_effect(scene_, mesh()));
  add(physics::properties_passed_over(scene_, mesh()));
  physics::for_each_physics([&]<physics::HasSolvability P>(P) { add(P::Solvability::doubts(setting(), true)); });
  physics::for_each_physics([&](auto physics) { add(physics.warnings(setting())); });
  physics::for_each_physics([&]<physics::HasWarnings P>(P) { add(P::Warnings::of_input(setting(), times)); });
  add(steps_across_knots(scene_));
  add(stages_after_the_end(scene_));
  add(toughness_without_growth(scene_));
  add(segments_longer_than_fractures(scene_, mesh()));
  return all;
}

}  // namespace sprekk::model
