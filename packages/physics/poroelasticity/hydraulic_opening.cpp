#include "physics/poroelasticity/hydraulic_opening.hpp"

#include "assembly/geometry.hpp"
#include "base/over_ranks.hpp"
#include "base/symmetric.hpp"
#include "physics/mechanics/plausibility.hpp"
#include "physics/scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

namespace sprekk::physics {

namespace {

using mesh::norm;
using mesh::operator-;

/// Place of a prescribed pressure, and the cell whose initial stress acts there.
struct PressurePlace {
  mesh::Vector x;
  LocalIndex cell;
};
using PressurePlaces = std::vector<PressurePlace>;

/// The place at the nearest cell centre, on one rank; empty on other ranks. Collective.
PressurePlaces nearest_cell(const mesh::Mesh& mesh, const std::vector<Real>& point) {
  mesh::Vector x{};
  std::copy_n(point.begin(), mesh.dim(), x.begin());
  PressurePlace nearest{x, -1};
  Real distance = std::numeric_limits<Real>::max();
  for (LocalIndex cell = 0; cell < mesh.n_owned_cells; ++cell)
    if (const Real d = norm(mesh::cell_centre(mesh, cell) - x); d < distance) {
      distance = d;
      nearest.cell = cell;
    }
  const bool here = distance == base::min_over_ranks(*mesh.comm, distance) && nearest.cell >= 0;
  return here ? PressurePlaces{nearest} : PressurePlaces{};
}

PressurePlaces places_on_boundary(const mesh::Mesh& mesh, const BoundaryCondition& condition) {
  PressurePlaces places;
  for (const auto& face : mesh.boundary_faces)
    if (face.owned && mesh.boundary_names[face.boundary] == condition.boundary &&
        (!condition.region || mesh.region_names[mesh.cell_region[face.cell]] == *condition.region))
      places.push_back({mesh::face_centre(mesh::face_corners(mesh, face.cell, face.local_face)), face.cell});
  return places;
}

PressurePlaces places_on_fracture(const mesh::Mesh& mesh, const std::string& name) {
  PressurePlaces places;
  for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f)
    if (const auto& face = mesh.fracture_faces[f]; mesh.fracture_names[face.fracture] == name)
      places.push_back({face.centre, face.cell[0]});
  return places;
}

/// Corners of faces in the box of a held pressure; without any, the nearest cell. Collective.
PressurePlaces places_in_box(const mesh::Mesh& mesh, const std::string& name, const HeldPressureSection& held) {
  const auto &lower = held.lower_corner, &upper = held.upper_corner.empty() ? lower : held.upper_corner;
  PressurePlaces places;
  for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) {
    const auto& face = mesh.fracture_faces[f];
    const Real rounding = 1e-6 * std::pow(face.area, Real(1) / (mesh.dim() - 1));
    for (int k = 0; k < mesh::n_face_corners(mesh.shape) && mesh.fracture_names[face.fracture] == name; ++k) {
      const auto x = mesh::face_corner(mesh, f, k);
      bool within = true;
      for (int i = 0; i < mesh.dim(); ++i)
        within = within && x[i] >= lower[i] - rounding && x[i] <= upper[i] + rounding;
      if (within) places.push_back({x, face.cell[0]});
    }
  }
  return base::on_any_rank(*mesh.comm, !places.empty()) ? places : nearest_cell(mesh, lower);
}

/// Smallest principal compression, in 2D of the directions in the plane.
Real smallest_compression(const std::vector<base::Expression>& stress, const mesh::Vector& x, int dim) {
  std::vector<Real> s;
  for (const auto& component : stress) s.push_back(component(x, 0));
  return dim == 2 ? -0.5 * (s[0] + s[1]) - std::hypot(0.5 * (s[0] - s[1]), s[3]) : -base::largest_principal(s);
}

}  // namespace

std::vector<std::string> hydraulic_opening_doubts(const Setting& setting, const std::vector<Real>& times) {
  const auto& [scene, mesh, start] = setting;
  std::vector<std::string> doubts;
  const auto initial = initial_stress(scene, mesh);
  if (initial.empty()) return doubts;
  const auto compare = [&, &scene = scene, &mesh = mesh](const std::string& entry, const base::Expression& pressure,
                                                         const PressurePlaces& places) {
    Real excess = 0, largest = 0;
    looking([&] {
      for (const auto& [x, cell] : places) {
        const Real compression = smallest_compression(initial.of_cell(mesh, cell), x, mesh.dim());
        for (const Real t :
             pressure.constant_in_time() ? std::vector{times.front()} : base::sample_of(times, most_times)) {
          const Real p = pressure(x, t);
          if (compression <= 0 || p - compression <= excess) continue;
          excess = p - compression;
          largest = p;
        }
      }
    });
    const Real above = base::max_over_ranks(*mesh.comm, excess);
    largest = base::max_over_ranks(*mesh.comm, excess == above ? largest : 0);
    if (above > 1e-6 * largest)
      doubts.push_back(
          implausible(fmt::format("{}: Sprekk > {}", scene.origin, entry),
                      fmt::format("reaches {:.4g} Pa, and the smallest principal compression there is {:.4g} Pa",
                                  largest, largest - above),
                      "fractures normal to this stress open (hydraulic opening)",
                      "check the pressure and the initial stress, or ignore this warning if fractures should open"));
  };
  if (scene.flow)
    for (const auto& [name, well] : scene.flow->wells)
      if (well.pressure)
        compare(fmt::format("Flow > Wells > {} > \"pressure\"", name), *well.pressure, nearest_cell(mesh, well.points));
  for (const auto& [name, condition] : scene.boundary_conditions)
    if (condition.pressure)
      compare(fmt::format("Boundary conditions > {} > \"pressure\"", name), *condition.pressure,
              places_on_boundary(mesh, condition));
  for (const auto& [name, fracture] : scene.fractures) {
    compare(fmt::format("Fractures > {} > \"fluid pressure\"", name), fracture.fluid_pressure,
            places_on_fracture(mesh, name));
    for (const auto& [held, one] : fracture.held_pressures)
      compare(fmt::format("Fractures > {} > Held pressures > {} > \"pressure\"", name, held), one.pressure,
              places_in_box(mesh, name, one));
  }
  return doubts;
}

std::vector<std::string> opening_by_rate_doubts(const Setting& setting,
                                                const std::vector<assembly::OutputField>& outputs) {
  const auto& [scene, mesh, start] = setting;
  const auto initial = initial_stress(scene, mesh);
  const auto any = [](const auto& all, const auto& has) { return std::ranges::any_of(all, has); };
  if (initial.empty() || !scene.flow ||
      !any(scene.flow->wells, [](const auto& one) { return one.second.rate.has_value(); }) ||
      any(scene.fractures, [](const auto& one) { return one.second.unbroken || one.second.toughness; }))
    return {};
  bool above = false;
  for (const auto& output : outputs)
    for (std::size_t f = 0; f < output.values.size() && output.name == "fracture pressure" && !above; ++f) {
      const auto& face = mesh.fracture_faces[f];
      const Real compression = smallest_compression(initial.of_cell(mesh, face.cell[0]), face.centre, mesh.dim());
      above = compression > 0 && output.values[f] > (1 + 1e-6) * compression;
    }
  if (!base::on_any_rank(*mesh.comm, above)) return {};
  return {implausible(scene.origin + ": Sprekk > Flow > Wells",
                      "the pressure in fractures exceeds the smallest principal compression of the initial stress",
                      "fractures normal to this stress open (hydraulic opening)",
                      "inject less, or ignore this warning if fractures should open")};
}

}  // namespace sprekk::physics
