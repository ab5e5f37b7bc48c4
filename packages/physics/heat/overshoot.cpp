#include "physics/heat/overshoot.hpp"

#include "base/over_ranks.hpp"
#include "physics/heat/temperatures.hpp"

#include <algorithm>
#include <limits>

namespace sprekk::physics {

namespace {

constexpr Real tolerance = 1e-3;  // of the span
constexpr int n_places = 5;

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

/// Adds the value of T; false if it depends on the time or, by samples, on the place.
bool add_value(const mesh::Mesh& mesh, const base::Expression& T, Range& range) {
  if (!T.constant_in_time()) return false;
  const int dim = mesh.dim();
  Range here;
  for (int place = 0; place < (T.is_constant() ? 1 : n_places); ++place) {
    std::array<Real, 3> x{};
    const auto node = static_cast<std::size_t>(mesh.n_nodes() - 1) * place / n_places;
    if (mesh.n_nodes() > 0) std::copy_n(&mesh.coordinates[node * dim], dim, x.begin());
    here.add(T(x, 0));
  }
  range.add(here.low);
  return here.low == here.high;
}

}  // namespace

std::string overshoot_warning(const Scene& scene, const mesh::Mesh& mesh,
                              const std::vector<assembly::OutputField>& outputs) {
  if (has_other_heat(scene)) return "";
  Range given;
  bool known = true;
  for_each_temperature(
      scene, [&](const std::string&, const base::Expression& T) { known = known && add_value(mesh, T, given); });
  if (base::on_any_rank(*mesh.comm, !known)) return "";
  Range found;
  for (const auto& output : outputs)
    if (output.name == "temperature" || output.name == "fracture temperature")
      for (const Real T : output.values) found.add(T);
  const auto all =
      base::max_over_ranks(*mesh.comm, std::array<Real, 4>{given.high, -given.low, found.high, -found.low});
  const Real beyond = std::max(all[2] - all[0], all[3] - all[1]);
  if (!(beyond > tolerance * (all[0] + all[1]) && beyond > 1e-9 * all[0])) return "";
  return fmt::format(
      "{}: temperatures are up to about {:.0e} K beyond the given ones, {:.6g} to {:.6g} K, by the error of the mesh "
      "or "
      "of the steps: take finer cells or longer steps, and \"implicit Euler\" where steps are long",
      scene.origin, beyond, -all[1], all[0]);
}

}  // namespace sprekk::physics
