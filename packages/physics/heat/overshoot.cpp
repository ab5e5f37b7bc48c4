#include "physics/heat/overshoot.hpp"

#include "base/over_ranks.hpp"
#include "base/sample.hpp"
#include "mesh/facets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sprekk::physics {

namespace {

using mesh::Vector;

constexpr Real tolerance = 1e-3;        // relative to the range of given temperatures
constexpr std::size_t max_times = 128;  // number of times at which time-dependent temperatures are evaluated

struct Range {
  Real low = std::numeric_limits<Real>::infinity(), high = -low;
  void add(Real value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

/// Sources, heat fluxes and friction that can heat or cool rock beyond all given temperatures.
struct OtherHeat {
  bool warms = false, cools = false;
  void add(const base::Expression& inward, int sign) {
    if (is_zero(inward)) return;
    const bool known = inward.is_constant();
    const Real value = known ? sign * inward({}, 0) : 0;
    warms = warms || !known || value > 0;
    cools = cools || !known || value < 0;
  }
};

OtherHeat other_heat(const Scene& scene) {
  OtherHeat other{.warms = scene.heat->of_friction};
  other.add(scene.heat->source, 1);
  for (const auto& [name, condition] : scene.boundary_conditions)
    if (condition.heat_flux) other.add(*condition.heat_flux, -1);
  return other;
}

/// Calls see(x) with corners and centres of the faces or cells of a given temperature.
template <class See>
void for_each_place(const mesh::Mesh& mesh, const GivenTemperature& given, const See& see) {
  const auto is_in = [&](LocalIndex cell) { return given.region < 0 || mesh.cell_region[cell] == given.region; };
  const auto see_face = [&](LocalIndex cell, int face) {
    const auto corners = mesh::face_corners(mesh, cell, face);
    see(mesh::face_centre(corners));
    for (int k = 0; k < corners.n; ++k) see(corners.x[k]);
  };
  if (given.boundary >= 0) {
    for (const auto& face : mesh.boundary_faces)
      if (face.boundary == given.boundary && is_in(face.cell)) see_face(face.cell, face.local_face);
  } else {
    for (LocalIndex cell = 0; cell < mesh.n_owned_cells; ++cell) {
      if (!is_in(cell)) continue;
      see(mesh::cell_centre(mesh, cell));
      for (int face = 0; face < mesh::n_faces(mesh.shape); ++face) see_face(cell, face);
    }
  }
}

/// Range of the given temperatures on this rank at these times.
Range given_range(const std::vector<GivenTemperature>& all, const mesh::Mesh& mesh, const std::vector<Real>& times) {
  Range range;
  for (const auto& given : all) {
    const std::size_t n = given.value.constant_in_time() ? 1 : times.size();
    if (given.value.is_constant())
      range.add(given.value({}, 0));
    else
      for_each_place(mesh, given, [&](const Vector& x) {
        for (std::size_t k = 0; k < n; ++k) range.add(given.value(x, times[k]));
      });
  }
  return range;
}

struct Overshoot {
  Real size, low, high;  // K; low and high of the given temperatures
  bool counts() const { return size > tolerance * (high - low) && size > 1e-9 * high; }
};

/// Overshoot over all ranks. Collective.
Overshoot overshoot(const mesh::Mesh& mesh, const OtherHeat& other, const Range& given, const Range& found) {
  const auto all =
      base::max_over_ranks(*mesh.comm, std::array<Real, 4>{given.high, -given.low, found.high, -found.low});
  return {std::max({Real(0), other.warms ? 0 : all[2] - all[0], other.cools ? 0 : all[3] - all[1]}), -all[1], all[0]};
}

}  // namespace

std::string overshoot_warning(const Setting& setting, const std::vector<Real>& times,
                              const std::vector<GivenTemperature>& given,
                              const std::vector<assembly::OutputField>& outputs) {
  const auto& [scene, mesh, start] = setting;
  const auto other = other_heat(scene);
  if (other.warms && other.cools) return "";
  Range found;
  for (const auto& output : outputs)
    if (output.name == "temperature" || output.name == "fracture temperature")
      for (const Real T : output.values) found.add(T);
  auto beyond = overshoot(mesh, other, given_range(given, mesh, {times.back()}), found);
  if (beyond.counts())
    beyond = overshoot(mesh, other, given_range(given, mesh, base::sample_of(times, max_times)), found);
  if (!beyond.counts()) return "";
  const Real size = std::pow(10, std::floor(std::log10(beyond.size)));  // few different messages
  return fmt::format(
      "{}: temperatures are more than {:.3g} K beyond the given ones, {:.6g} to {:.6g} K, by the error of the mesh "
      "or of the steps: take finer cells, or \"implicit Euler\" where steps are long",
      scene.origin, size, beyond.low, beyond.high);
}

}  // namespace sprekk::physics
