// What of mechanics a live model keeps where its scene changes.
#include "laws/joint.hpp"
#include "physics/mechanics/elastic_plastic_jump.hpp"
#include "physics/mechanics/mechanics.hpp"
#include "physics/scene.hpp"

#include <fmt/ranges.h>

namespace sprekk::physics {

namespace {

/// The laws of a joint that keep numbers of faces, by their names, in the order of the numbers.
std::vector<std::string> laws_with_memory(const Material& material) {
  std::vector<std::string> names;
  material.joint({}).law.for_each_part([&](const auto& law, int) {
    if (laws::n_history(law) == 0) return;
    names.emplace_back(law.visit([](const auto& kind) { return std::decay_t<decltype(kind)>::name; }));
  });
  return names;
}

}  // namespace

/// Strains and jumps count from a state without them under the initial stress, and stress is Hooke's law of all of the
/// strain: other constants would change it at once.
std::vector<std::string> Mechanics::fixed_entries() {
  return {"initial stress",  "lithostatic stress", "in-situ stress",         "plastic jump", "Young's modulus",
          "Poisson's ratio", "shear modulus",      "Lame's first parameter", "bulk modulus"};
}

std::vector<std::string> Mechanics::refuses_change(const Scene& before, const Scene& after) {
  std::vector<std::string> lines;
  for (const auto& [name, fracture] : after.fractures) {
    const auto old = before.fractures.find(name);
    if (old == before.fractures.end() || !is_in(after)) continue;
    const auto laws = laws_with_memory(after.materials.at(fracture.material)),
               old_laws = laws_with_memory(before.materials.at(old->second.material));
    if (!old_laws.empty() && laws != old_laws)
      lines.push_back(
          fmt::format("Fractures > {}: its laws that remember become \"{}\", they were \"{}\", and what "
                      "these have kept means nothing to others",
                      name, fmt::join(laws, "\", \""), fmt::join(old_laws, "\", \"")));
  }
  if (!after.bulk.lithostatic_stress) return lines;
  const auto density = [](const Scene& scene) { return scene.material_of("bulk").density.value_or(0).text(); };
  if (before.bulk.gravity != after.bulk.gravity || density(before) != density(after))
    lines.push_back("Bulk > \"lithostatic stress\": is that of gravity and density, which a change keeps with it");
  return lines;
}

}  // namespace sprekk::physics
