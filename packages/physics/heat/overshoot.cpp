#include "physics/heat/overshoot.hpp"

#include "base/over_ranks.hpp"
#include "physics/heat/temperatures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sprekk::physics {

namespace {

constexpr Real tolerance = 1e-3;  // of the span

struct Range {
  Real low = std::numeric_limits<Real>::infinity(), high = -low;
  void add(Real value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

bool has_other_heat(const Scene& scene) {
  const auto& conditions = scene.boundary_conditions;
  return !is_zero(scene.heat->source) || scene.heat->of_friction ||
         std::any_of(conditions.begin(), conditions.end(), [](const auto& named) { return named.second.heat_flux; });
}

}  // namespace

std::string overshoot_warning(const Scene& scene, const mesh::Mesh& mesh,
                              const std::vector<assembly::OutputField>& outputs) {
  if (has_other_heat(scene)) return "";
  Range given;
  bool known = true;
  for_each_temperature(scene, [&](const std::string&, const base::Expression& T) {
    known = known && T.is_constant();
    if (known) given.add(T({0, 0, 0}, 0));
  });
  if (!known || !(given.low <= given.high)) return "";
  Range found;
  for (const auto& output : outputs)
    if (output.name == "temperature" || output.name == "fracture temperature")
      for (const Real T : output.values) found.add(T);
  const auto all =
      base::max_over_ranks(*mesh.comm, std::array<Real, 4>{given.high, -given.low, found.high, -found.low});
  const Real beyond = std::max(all[2] - all[0], all[3] - all[1]);
  if (!(beyond > tolerance * (all[0] + all[1]) && beyond > 1e-9 * all[0])) return "";
  const Real size = std::pow(10, std::floor(std::log10(beyond)));  // few different texts, so that few are printed
  return fmt::format(
      "{}: temperatures are more than {:.3g} K beyond the given ones, {:.6g} to {:.6g} K, by the error of the mesh "
      "or of the steps: take finer cells, or \"implicit Euler\" where steps are long",
      scene.origin, size, -all[1], all[0]);
}

}  // namespace sprekk::physics
