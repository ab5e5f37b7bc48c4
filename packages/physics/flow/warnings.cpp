// Warnings about flow.
#include "assembly/geometry.hpp"
#include "base/over_ranks.hpp"
#include "laws/joint_parameters.hpp"
#include "physics/flow/flow.hpp"
#include "physics/flow/wells_and_channels.hpp"
#include "physics/mechanics/mechanics.hpp"
#include "physics/mechanics/plausibility.hpp"
#include "physics/scene.hpp"
#include "transport/hybrid_diffusion.hpp"
#include "transport/well_connections.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

namespace sprekk::physics {

namespace {

/// Warns about joints that a compression of 1e-3 of Young's modulus closes by more than their initial aperture.
void add_closure_warnings(const Setting& setting, std::vector<std::string>& warnings) {
  const auto& [scene, mesh, start] = setting;
  if (!Mechanics::is_in(scene)) return;
  Real modulus = 0;
  for (const auto& rock : elasticity(scene, mesh).values) modulus = std::max(modulus, rock.youngs_modulus());
  const Real compression = 1e-3 * base::max_over_ranks(*mesh.comm, modulus), zero = 0;
  std::set<std::string> seen;
  for (std::size_t k = 0; k < mesh.single_fractures.size(); ++k) {
    const auto& joint = joint_of(scene, mesh, static_cast<int>(k));
    if (!joint.is_uniform() || joint.is_in_situ()) continue;
    const auto law = joint.joint({}).law;
    const Real aperture = joint.initial_aperture({}, 0),
               closure = -law.closure(laws::Contact<Real>{.lambda_n = -compression, .history = {&zero, 0}});
    if (aperture == 0 || !(closure > aperture) || !seen.insert(fmt::format("{} {}", closure, aperture)).second)
      continue;
    const bool residual = !is_zero(joint.residual_aperture);
    warnings.push_back(fmt::format(
        "{}: fracture \"{}\": a compression of {:.3g} Pa closes the joint by {:.3g} m, more than its \"initial "
        "aperture\" "
        "{:.3g} m; {}",
        scene.origin, mesh.single_fractures[k].name, compression, closure, aperture,
        residual ? "the fluid then has the \"residual aperture\"" : "the fluid in it then bears the compression"));
  }
}

/// Warns about wells near a fracture in 2D, where rounded coordinates may be the cause.
void add_well_warnings(const Setting& setting, std::vector<std::string>& warnings) {
  const auto& [scene, mesh, start] = setting;
  const auto wells = wells_in(scene, mesh.dim());
  for (const auto& [w, single, distance] : transport::wells_near_fractures(mesh, wells))
    warnings.push_back(implausible(
        fmt::format("{}: Sprekk > Flow > Wells > {} > \"points\"", scene.origin, wells[w].name),
        fmt::format("({:.10g}, {:.10g}) is {:.3g} m beside the fracture \"{}\", less than half of a face",
                    wells[w].points[0][0], wells[w].points[0][1], distance, mesh.single_fractures[single].name),
        "the well is connected to the rock only", "if it should be on the fracture, give a point of the fracture"));
}

/// Warns about leak-off coefficients above those of any rock. Collective.
void add_leak_off_warnings(const Setting& setting, std::vector<std::string>& warnings) {
  constexpr Real maximum = 0.01;  // m/s^0.5
  const auto& [scene, mesh, start] = setting;
  std::vector<Real> largest(mesh.fracture_names.size(), 0);
  looking([&, &scene = scene, &mesh = mesh] {
    for (const auto& face : mesh.fracture_faces)
      largest[face.fracture] = std::max(
          largest[face.fracture], scene.fractures.at(mesh.fracture_names[face.fracture]).leak_off(face.centre, 0));
  });
  largest = base::max_over_ranks(*mesh.comm, largest);
  for (std::size_t k = 0; k < largest.size(); ++k)
    if (largest[k] > maximum)
      warnings.push_back(implausible(
          fmt::format("{}: Sprekk > Fractures > {} > \"leak-off coefficient\"", scene.origin, mesh.fracture_names[k]),
          fmt::format("reaches {:.4g} m/s^0.5", largest[k]), "rock has 1e-6 to 1e-3 m/s^0.5",
          "check the unit: 1 ft/min^0.5 is 0.0394 m/s^0.5"));
}

/// Warns about channels without an intersection. Collective.
void add_channel_warnings(const Setting& setting, std::vector<std::string>& warnings) {
  const auto& [scene, mesh, start] = setting;
  for (const auto& [name, one] : scene.flow->intersections)
    if (transport::length_of(channel_of(one, scene, mesh), mesh) == 0)
      warnings.push_back(implausible(fmt::format("{}: Sprekk > Flow > Intersections > {}", scene.origin, name),
                                     one.fractures.empty() ? "no fractures meet" : "its \"fractures\" do not meet",
                                     "the channel has no effect", "remove it, or name fractures that intersect"));
}

}  // namespace

/// Warns about wells that inject more than 1 % of the volume of the rock without an outlet.
std::vector<std::string> Flow::Warnings::of_input(const Setting& setting, const std::vector<Real>& times) {
  const auto& [scene, mesh, start] = setting;
  if (!is_in(scene) || !Mechanics::is_in(scene)) return {};
  const auto wells = wells_in(scene, mesh.dim());
  bool closed = is_zero(scene.flow->source) &&
                std::all_of(wells.begin(), wells.end(), [](const auto& well) { return well.rate.has_value(); });
  for (const auto& [name, one] : scene.boundary_conditions) closed = closed && !one.pressure && !one.flux;
  for (const auto& [name, one] : scene.regions) closed = closed && !one.pressure;
  for (const auto& [name, one] : scene.fractures)
    closed = closed && one.held_pressures.empty() && is_zero(one.leak_off) && is_zero(one.source);
  const auto volumes = assembly::cell_volumes(mesh);
  const Real rock =
      base::sum_over_ranks(*mesh.comm, std::accumulate(volumes.begin(), volumes.begin() + mesh.n_owned_cells, Real(0)));
  Real injected = 0, end = start;
  for (auto t = times.begin(); closed && t != times.end() && injected <= 0.01 * rock; end = *t++)
    for (const auto& well : wells) injected += (*t - end) * (*well.rate)(well.points[0], *t);
  if (injected <= 0.01 * rock) return {};
  return {implausible(
      scene.origin + ": Sprekk > Flow > Wells",
      fmt::format("{:.3g} {} of fluid enter until t = {:.4g} s, {:.3g} % of the volume of the rock, and none leave",
                  injected, mesh.dim() == 2 ? "m^2" : "m^3", end, 100 * injected / rock),
      "the fluid opens fractures or expands the rock by this volume, and an equilibrium need not exist",
      "check rates and units, or give a pressure at a boundary")};
}

std::vector<std::string> Flow::warnings(const Setting& setting) {
  const auto& [scene, mesh, start] = setting;
  if (!is_in(scene)) return {};
  std::vector<std::string> all;
  if (flows_in_rock(scene))
    if (const auto skew = transport::scheme_warning(scheme_entry(scene), mesh, mobility(scene, mesh)); !skew.empty())
      all.push_back(scene.origin + ": " + skew);
  add_closure_warnings(setting, all);
  add_well_warnings(setting, all);
  add_leak_off_warnings(setting, all);
  add_channel_warnings(setting, all);
  return all;
}

std::vector<std::string> Flow::Warnings::of_state(const Setting& setting, const std::vector<Real>&,
                                                  const std::vector<assembly::OutputField>& outputs) {
  const auto& [scene, mesh, start] = setting;
  if (!is_in(scene)) return {};
  std::array<Real, 2> here{};  // largest value of -p, and of |p|
  for (const auto& output : outputs)
    for (const Real p : output.values)
      if (output.name == "pressure" || output.name == "fracture pressure") {
        here[0] = std::max(here[0], -p);
        here[1] = std::max(here[1], std::abs(p));
      }
  const auto all = base::max_over_ranks(*mesh.comm, here);
  if (all[0] <= 1e-9 * all[1]) return {};
  return {
      fmt::format("{}: the pressure of the fluid is below 0 in places; if it is an absolute pressure, a real fluid "
                  "boils or cavitates there; if it is relative to another pressure, ignore this warning",
                  scene.origin)};
}

}  // namespace sprekk::physics
