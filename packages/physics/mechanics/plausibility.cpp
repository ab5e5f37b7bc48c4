#include "physics/mechanics/plausibility.hpp"

#include "assembly/geometry.hpp"
#include "base/entry_of_place.hpp"
#include "base/over_ranks.hpp"
#include "base/symmetric.hpp"
#include "base/text.hpp"
#include "mesh/extents.hpp"
#include "mesh/extreme.hpp"
#include "physics/scene.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace sprekk::physics {

using mesh::norm;
using mesh::operator-;

namespace {

using mesh::Extreme;

constexpr Real huge = std::numeric_limits<Real>::max();

/// Calls use(face centre, piece of rock) for owned faces of a condition.
template <class Use>
void for_each_face_of(const mesh::Mesh& mesh, const BoundaryCondition& condition, const Use& use) {
  for (const auto& face : mesh.boundary_faces)
    if (face.owned && mesh.boundary_names[face.boundary] == condition.boundary &&
        (!condition.region || mesh.region_names[mesh.cell_region[face.cell]] == *condition.region))
      use(mesh::face_centre(mesh::face_corners(mesh, face.cell, face.local_face)), mesh.cell_piece[face.cell]);
}

/// Displacements of pieces of rock between fractures, which may slide relative to each other: the largest at [2 piece],
/// the negative of the smallest at [2 piece + 1].
using PieceExtremes = std::vector<Extreme>;

/// Adds the prescribed displacements in direction i at time t, either those constant in time or the others. Not
/// collective.
void add_displacements(const Setting& setting, int i, Real t, bool constant, PieceExtremes& all) {
  looking([&] {
    for (const auto& [name, condition] : setting.scene.boundary_conditions) {
      if (condition.displacement.empty() || condition.displacement[i].text() == "free" ||
          condition.displacement[i].constant_in_time() != constant)
        continue;
      for_each_face_of(setting.mesh, condition, [&](const mesh::Vector& x, int piece) {
        const Real u = condition.displacement[i](x, t);
        for (const int side : {0, 1}) all[2 * piece + side].offer(side ? -u : u, x);
      });
    }
  });
}

/// Returns whether a prescribed displacement in direction i depends on time.
bool moves(const Scene& scene, int i) {
  return std::any_of(scene.boundary_conditions.begin(), scene.boundary_conditions.end(), [&](const auto& one) {
    const auto& u = one.second.displacement;
    return !u.empty() && u[i].text() != "free" && !u[i].constant_in_time();
  });
}

/// Warns about displacements of a piece of rock that differ by more than 5 % of their distance. Collective.
std::string strain_doubt(const Setting& setting, const std::vector<Real>& times) {
  constexpr Real maximum = 0.05;
  struct {
    Real strain = 0, t = 0, difference = 0, distance = 0;
  } worst;
  for (int i = 0; i < setting.mesh.dim(); ++i) {
    PieceExtremes fixed(2 * setting.mesh.n_pieces);
    add_displacements(setting, i, times.front(), true, fixed);
    for (const Real t : moves(setting.scene, i) ? times : std::vector{times.front()}) {
      auto all = fixed;
      add_displacements(setting, i, t, false, all);
      take_largest(*setting.mesh.comm, all);
      for (std::size_t k = 0; k < all.size(); k += 2) {
        if (all[k].value == Extreme::none) continue;
        const Real difference = all[k].value + all[k + 1].value, distance = norm(all[k].x - all[k + 1].x);
        if (difference > worst.strain * distance && distance > 0)
          worst = {difference / distance, t, difference, distance};
      }
    }
  }
  if (worst.strain <= maximum) return "";
  return implausible(setting.scene.origin + ": Sprekk > Boundary conditions",
                     fmt::format("displacements at t = {:.4g} s differ by {:.3g} m over {:.3g} m of rock, {:.3g} %",
                                 worst.t, worst.difference, worst.distance, 100 * worst.strain),
                     "small strains are assumed, and rock fails far below 5 %",
                     "check the unit of the displacements and of the lengths");
}

/// Smallest Young's modulus of the rocks with constant values, Pa; 0: none.
Real min_modulus(const Scene& scene) {
  Real minimum = 0;
  for (const auto& [name, material] : scene.materials) {
    if (material.type != "elastic" || !material.has_elasticity() || !material.is_uniformly_elastic()) continue;
    const Real E = material.elasticity({}).youngs_modulus();
    minimum = minimum == 0 ? E : std::min(minimum, E);
  }
  return minimum;
}

/// Warns about stresses above Young's modulus. Collective.
std::string load_doubt(const Setting& setting, const std::vector<Real>& times) {
  const auto& [scene, mesh, start] = setting;
  const Real E = min_modulus(scene);
  if (E == 0) return "";
  Real stress = 0;
  const auto compare = [&](Real value) { stress = std::max(stress, std::abs(value)); };
  looking([&] {
    for (const auto& [name, condition] : scene.boundary_conditions) {
      auto loads = condition.traction;
      if (condition.confining_pressure) loads.push_back(*condition.confining_pressure);
      for (const auto& component : loads)
        for_each_face_of(mesh, condition, [&](const mesh::Vector& x, int) {
          for (std::size_t k = 0; k < (component.constant_in_time() ? 1 : times.size()); ++k)
            compare(component(x, times[k]));
        });
    }
    const auto initial = initial_stress(scene, mesh);
    for (LocalIndex cell = 0; cell < mesh.n_owned_cells && !initial.empty(); ++cell)
      for (const auto& component : initial.value[mesh.cell_region[cell]])
        compare(component(mesh::cell_centre(mesh, cell), 0));
  });
  const Real maximum = base::max_over_ranks(*mesh.comm, stress);
  if (maximum <= E) return "";
  return implausible(scene.origin + ": Sprekk > Materials",
                     fmt::format("Young's modulus is {:.4g} Pa, and there is a stress of {:.4g} Pa", E, maximum),
                     "this is a strain of the rock above 100 %",
                     E < 1e4 ? "write the unit after the modulus, as in \"50 GPa\"" : "check both units");
}

/// Warns about confining pressures in tension. Collective.
std::string confining_doubt(const Setting& setting, const std::vector<Real>& times) {
  const auto& [scene, mesh, start] = setting;
  for (const auto& [name, condition] : scene.boundary_conditions) {
    if (!condition.confining_pressure) continue;
    Real pull = 0;
    looking([&, &mesh = mesh, &condition = condition] {
      for_each_face_of(mesh, condition, [&](const mesh::Vector& x, int) {
        for (const Real t : times) pull = std::max(pull, -(*condition.confining_pressure)(x, t));
      });
    });
    pull = base::max_over_ranks(*mesh.comm, pull);
    if (pull > 0)
      return implausible(
          fmt::format("{}: Sprekk > Boundary conditions > {} > \"confining pressure\"", scene.origin, name),
          fmt::format("is {:.4g} Pa", -pull), "that pulls at the rock", "compression is positive here");
  }
  return "";
}

/// Parts of a warning about a joint entry.
struct Doubt {
  std::string entry, what, why, advice;
};

Real number(const Material& joint, const std::string& entry) {
  const auto& value = joint.entry(entry);
  return value && value->is_constant() ? (*value)({}, 0) : 0;
}

/// Warns about stiffnesses with a missing prefix (GPa/m, MPa/m), given Young's modulus of the rock, Pa, and the domain
/// size, m.
std::vector<Doubt> stiffness_doubts(const Material& joint, Real E, Real size) {
  std::vector<Doubt> all;
  for (const char* entry : {"tangential stiffness", "normal stiffness"}) {
    const Real K = number(joint, entry);
    if (E < 1e6 || K < 0.1 || K > 1e4 || K * size > 1e-6 * E) continue;
    all.push_back({entry, fmt::format("is {:.4g} Pa/m next to rock with a modulus of {:.4g} Pa", K, E),
                   "the joint has almost no resistance", "write the unit, as in \"10 GPa/m\""});
  }
  return all;
}

/// Warns about friction coefficients above 1.5, angles in radians, dilation above friction, and damage without lengths.
std::vector<Doubt> strength_doubts(const Material& joint) {
  std::vector<Doubt> all;
  if (const Real mu = number(joint, "friction coefficient"); mu > 1.5)
    all.push_back({"friction coefficient", fmt::format("is {:.4g}", mu), "rock has 0.2 to 1.2",
                   "to prevent slip use friction \"no slip\"; give an angle as \"friction angle\""});
  for (const char* entry : {"friction angle", "residual friction angle", "basic friction angle", "dilation angle"})
    if (const Real angle = number(joint, entry); angle > 0 && angle < 0.02 * (entry[0] == 'd' ? 1 : 50))
      all.push_back({entry, fmt::format("is {:.4g} degrees", angle),
                     "this is almost zero, and typical of an angle in radians",
                     "write the unit, as in \"30 deg\" or \"0.52 rad\""});
  const Real phi = number(joint, "friction angle"),
             friction = phi > 0 ? std::tan(phi * M_PI / 180) : number(joint, "friction coefficient"),
             slope = friction / joint.strength_reduction;
  if (const Real dilation = number(joint, "dilation angle");
      joint.friction == "Coulomb" && slope > 0 && std::tan(dilation * M_PI / 180) > slope)
    all.push_back({"dilation angle", fmt::format("is {:.4g} degrees", dilation),
                   fmt::format("this is above the friction angle, {:.4g} degrees: sliding would produce energy",
                               std::atan(slope) * 180 / M_PI),
                   "friction contains dilation; give a smaller angle"});
  const auto is_infinite = [&](const char* entry) {
    const auto& value = joint.entry(entry);
    return !value || (value->is_constant() && std::isinf((*value)({}, 0)));
  };
  if (joint.damage != "none" && is_infinite("damage length of friction") && is_infinite("damage length of dilation"))
    all.push_back({"damage", fmt::format("is \"{}\"", joint.damage), "without a damage length it has no effect",
                   "give \"damage length of friction\" or \"damage length of dilation\""});
  return all;
}

/// Warnings about joints of the scene and about individual entries of single fractures, with the first fracture per
/// entry.
std::vector<std::string> joint_doubts(const Setting& setting) {
  const auto& [scene, mesh, start] = setting;
  const Real E = min_modulus(scene), size = mesh::largest_extent(mesh);
  const auto doubts = [&](const Material& joint) {
    auto all = stiffness_doubts(joint, E, size);
    if (joint.source) return all;  // values with a source are trusted
    for (auto& doubt : strength_doubts(joint)) all.push_back(std::move(doubt));
    return all;
  };
  std::vector<std::string> all;
  std::set<std::string> reported;
  for (const auto& [name, material] : scene.materials)
    for (const auto& [entry, what, why, advice] : material.type == "joint" ? doubts(material) : std::vector<Doubt>()) {
      all.push_back(implausible(fmt::format("{}: Sprekk > Materials > {} > \"{}\"", scene.origin, name, entry), what,
                                why, advice));
      reported.insert(entry + what);
    }
  std::map<std::string, std::pair<Doubt, std::vector<int>>> own;  // [entry] warning and its single fractures
  for (const auto& [single, joint] : scene.own_joints)
    for (const auto& doubt : doubts(joint))
      if (!reported.count(doubt.entry + doubt.what))
        own.try_emplace(doubt.entry, doubt, std::vector<int>()).first->second.second.push_back(single);
  for (const auto& [entry, found] : own) {
    const auto& [doubt, singles] = found;
    const auto n = singles.size() - 1;
    const auto others = n > 0 ? fmt::format(", with {} other{} like it", n, n > 1 ? "s" : "") : "";
    all.push_back(implausible(
        fmt::format("{}: fracture \"{}\" > \"{}\"", scene.origin, mesh.single_fractures[singles[0]].name, entry),
        doubt.what + others, doubt.why, doubt.advice));
  }
  return all;
}

/// Warns about initial stress in tension. Collective.
std::string tension_doubt(const Setting& setting) {
  const auto& [scene, mesh, start] = setting;
  const auto initial = initial_stress(scene, mesh);
  if (initial.empty()) return "";
  std::vector<Extreme> highest(1);
  std::array<Real, 2> volumes{};  // numbers of cells in tension, of all cells
  Real compression = 0;
  looking([&] {
    for (LocalIndex cell = 0; cell < mesh.n_owned_cells; ++cell) {
      const auto x = mesh::cell_centre(mesh, cell);
      std::vector<Real> stress;
      for (const auto& component : initial.value[mesh.cell_region[cell]]) stress.push_back(component(x, 0));
      const Real principal = base::largest_principal(stress);
      highest[0].offer(principal, x);
      volumes[0] += principal > 0;
      volumes[1] += 1;
      for (int i = 0; i < 3; ++i) compression = std::max(compression, std::abs(stress[i]));
    }
  });
  take_largest(*mesh.comm, highest);
  const auto& maximum = highest[0];
  volumes = base::sum_over_ranks(*mesh.comm, volumes);
  compression = base::max_over_ranks(*mesh.comm, compression);
  if (maximum.value <= 1e-6 * compression) return "";
  return implausible(
      scene.origin + ": Sprekk > Bulk",
      fmt::format("the initial stress is tension in {:.3g} % of the cells, {:.4g} Pa at ({:.4g}, {:.4g}, "
                  "{:.4g})",
                  100 * volumes[0] / volumes[1], maximum.value, maximum.x[0], maximum.x[1], maximum.x[2]),
      "rock at rest is in compression, which is negative",
      "check the signs, the \"surface\" of a \"lithostatic stress\" and the \"datum\" of an \"in-situ stress\"");
}

/// Warns if horizontal stresses are zero, or their order is reversed at the bottom of the mesh, or if the vertical
/// stress differs from the weight, also if there is no weight. Collective.
std::string in_situ_doubt(const Setting& setting) {
  const auto& [scene, mesh, start] = setting;
  const auto& stress = scene.bulk.in_situ_stress;
  if (!stress) return "";
  const auto place = scene.origin + ": Sprekk > Bulk > in-situ stress";
  Real depth = -std::numeric_limits<Real>::max();
  const int dim = mesh.dim();
  for (LocalIndex node = 0; node < mesh.n_nodes(); ++node)
    depth = std::max(depth, stress->datum - mesh.coordinates[node * dim + dim - 1]);
  depth = base::max_over_ranks(*mesh.comm, depth);
  const auto at_foot = [&](const PrincipalStress::Component& one) { return one.value + one.gradient * depth; };
  const std::pair<const char*, const PrincipalStress::Component&> horizontal[] = {{"SHmax", stress->largest},
                                                                                  {"Shmin", stress->smallest}};
  for (const auto& [name, component] : horizontal)
    if (at_foot(component) == 0 && at_foot(stress->vertical) > 0)
      return implausible(place, fmt::format("{} is 0 Pa in a depth of {:.4g} m", name, depth),
                         fmt::format("there Sv is {:.4g} Pa", at_foot(stress->vertical)),
                         fmt::format("give \"{0}\" or \"{0} gradient\"", name));
  if (at_foot(stress->largest) < at_foot(stress->smallest))
    return implausible(place,
                       fmt::format("SHmax is below Shmin, {:.4g} and {:.4g} Pa in a depth of {:.4g} m",
                                   at_foot(stress->largest), at_foot(stress->smallest), depth),
                       "it is the largest horizontal stress",
                       "exchange them, and change the \"azimuth\" by 90 degrees");
  const auto& gravity = scene.bulk.gravity;
  const auto& density = scene.material_of("bulk").density;
  if (gravity.empty() && scene.bulk.body_force.empty() && stress->vertical.gradient != 0)
    return implausible(
        place, fmt::format("\"Sv gradient\" is {:.4g} Pa/m, and the rock has no weight", stress->vertical.gradient),
        "without a force against it, the gradient displaces the rock at the start",
        "give \"gravity\" in \"Bulk\" and \"density\" in the material");
  if (gravity.empty() || !density || !density->is_constant()) return "";
  const Real weight = -(*density)({}, 0) * gravity.back(), gradient = stress->vertical.gradient;
  if (std::abs(gradient - weight) <= 0.02 * std::abs(weight)) return "";
  return implausible(place,
                     fmt::format("\"Sv gradient\" is {:.4g} Pa/m, and rock weighs {:.4g} Pa/m", gradient, weight),
                     "the difference displaces the rock at the start", "check \"density\" and \"gravity\"");
}

using Starts = std::vector<StartOfFace>;

/// Warns about fractures whose initial stress exceeds their strength. Collective.
std::string strength_doubt(const Setting& setting, const Starts& starts) {
  const auto& mesh = setting.mesh;
  if (initial_stress(setting.scene, mesh).empty()) return "";
  std::vector<Real> beyond(mesh.single_fractures.size(), 0), all(beyond);
  for (std::size_t f = 0; f < starts.size(); ++f) {
    const auto& t = starts[f].traction;
    const Real bound = starts[f].bound;
    const auto& face = mesh.fracture_faces[f];
    all[face.single] += face.area;
    if (starts[f].depends_on_rate) continue;  // slips at another rate
    if (std::hypot(t[1], t[2]) > (1 + 1e-9) * bound || (t[0] > 0 && bound <= 0)) beyond[face.single] += face.area;
  }
  beyond = base::sum_over_ranks(*mesh.comm, beyond);
  all = base::sum_over_ranks(*mesh.comm, all);
  std::vector<std::string> names;
  Real area = 0, total = 0;
  for (std::size_t k = 0; k < all.size(); ++k) {
    area += beyond[k];
    total += all[k];
    if (beyond[k] > 0) names.push_back(mesh.single_fractures[k].name);
  }
  if (names.empty()) return "";
  constexpr std::size_t reported = 8;
  const auto n = names.size();
  if (n > reported) names.resize(reported);
  return implausible(
      setting.scene.origin + ": the initial state",
      fmt::format("{} beyond the strength of the joint ({:.3g} % of the area): \"{}\"{}",
                  n == 1 ? "a fracture is" : fmt::format("{} fractures are", n), 100 * area / total,
                  fmt::join(names, "\", \""), n > reported ? ", ..." : ""),
      n == 1 ? "it slips or opens in the first step without any load"
             : "they slip or open in the first step without any load",
      "check the initial stress, the pressure and the friction, or treat this step as part of the initial state");
}

/// Warns about fractures whose cells do not resolve the cohesive zone of a rupture. Collective.
std::vector<std::string> cohesive_zone_doubts(const Setting& setting, const Starts& starts) {
  const auto& mesh = setting.mesh;
  const std::size_t n = mesh.single_fractures.size();
  std::vector<Real> ratio(n, huge), edge(n, huge), zone(n, huge);  // of the least resolved face
  const auto edge_of = [&](std::size_t f) { return mesh::length_of(mesh, mesh.fracture_faces[f]); };
  for (std::size_t f = 0; f < starts.size(); ++f) {
    const auto k = mesh.fracture_faces[f].single;
    ratio[k] = std::min(ratio[k], starts[f].cohesive_zone / edge_of(f));
  }
  ratio = base::min_over_ranks(*mesh.comm, ratio);
  for (std::size_t f = 0; f < starts.size(); ++f) {
    const auto k = mesh.fracture_faces[f].single;
    if (starts[f].cohesive_zone / edge_of(f) > ratio[k] || edge_of(f) > edge[k]) continue;
    edge[k] = edge_of(f);
    zone[k] = starts[f].cohesive_zone;
  }
  edge = base::min_over_ranks(*mesh.comm, edge);
  zone = base::min_over_ranks(*mesh.comm, zone);
  std::vector<std::string> doubts;
  for (std::size_t k = 0; k < n; ++k)
    if (ratio[k] < 3 * (1 - 1e-6))
      doubts.push_back(
          implausible(fmt::format("{}: fracture \"{}\"", setting.scene.origin, mesh.single_fractures[k].name),
                      fmt::format("a cell has an edge of {:.3g} m, and the cohesive zone of a rupture is {:.3g} m long",
                                  edge[k], zone[k]),
                      "cells do not resolve the decrease of friction behind the tip, and slip depends on the cells",
                      fmt::format("use edges of at most {:.3g} m", zone[k] / 3)));
  return doubts;
}

/// Warns about joints in situ whose sides overlap under a higher compression, or whose unloaded aperture is the larger
/// one of two. Collective.
std::vector<std::string> in_situ_doubts(const Setting& setting, const Starts& starts) {
  const auto& mesh = setting.mesh;
  const std::size_t n = mesh.single_fractures.size();
  std::vector<Real> overlap(n, huge), smaller(n, 0), larger(n, 0);
  for (std::size_t f = 0; f < starts.size(); ++f) {
    const auto k = mesh.fracture_faces[f].single;
    overlap[k] = std::min(overlap[k], starts[f].overlap);
    if (starts[f].smaller_aperture <= smaller[k]) continue;
    smaller[k] = starts[f].smaller_aperture;
    larger[k] = starts[f].unloaded_aperture;
  }
  overlap = base::min_over_ranks(*mesh.comm, overlap);
  const auto largest = base::max_over_ranks(*mesh.comm, smaller);
  for (std::size_t k = 0; k < n; ++k)
    if (smaller[k] < largest[k]) larger[k] = 0;
  larger = base::max_over_ranks(*mesh.comm, larger);
  std::vector<std::string> doubts;
  for (std::size_t k = 0; k < n; ++k) {
    const auto place =
        fmt::format("{}: fracture \"{}\" in situ: ", setting.scene.origin, mesh.single_fractures[k].name);
    if (overlap[k] < huge)
      doubts.push_back(place + fmt::format("a compression above {:.6g} Pa closes it by more than its aperture; the "
                                           "sides then overlap",
                                           overlap[k]));
    if (largest[k] > 0)
      doubts.push_back(place + fmt::format("two unloaded apertures fit, {:.6g} m and {:.6g} m; the larger one is used. "
                                           "Give the smaller one as \"joint aperture\" to use it",
                                           larger[k], largest[k]));
  }
  return doubts;
}

}  // namespace

std::vector<std::string> Mechanics::Warnings::of_input(const Setting& setting, const std::vector<Real>& times) {
  if (!is_in(setting.scene)) return {};
  const auto some = base::sample_of(times, most_times);
  std::vector<std::string> all = {strain_doubt(setting, some), load_doubt(setting, some),
                                  confining_doubt(setting, some), tension_doubt(setting), in_situ_doubt(setting)};
  const auto add = [&](const auto& some) { all.insert(all.end(), some.begin(), some.end()); };
  add(joint_doubts(setting));
  if (!setting.mesh.fracture_names.empty()) {
    const auto starts = starts_of_faces(setting);
    all.push_back(strength_doubt(setting, starts));
    add(in_situ_doubts(setting, starts));
    add(cohesive_zone_doubts(setting, starts));
  }
  std::erase(all, "");
  return all;
}

}  // namespace sprekk::physics
