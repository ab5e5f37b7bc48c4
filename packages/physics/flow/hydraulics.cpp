#include "physics/flow/hydraulics.hpp"

#include "base/check.hpp"
#include "base/entry_of_place.hpp"
#include "base/over_ranks.hpp"
#include "physics/flow/flow.hpp"
#include "physics/mechanics/mechanics.hpp"
#include "physics/mechanics/unbroken.hpp"
#include "physics/scene.hpp"

#include <algorithm>
#include <limits>
#include <optional>

namespace sprekk::physics {

namespace {

/// Opening of a joint that can open, at the start and under unlimited compression, m.
struct Opening {
  Real initial, least;
};

/// Unloaded aperture of a joint, m, its opening, none without mechanics, and its local widening per pressure, m/Pa.
struct StartOfWalls {
  Real unloaded = 0;
  std::optional<Opening> opening = {};
  Real compliance = 0;
};

/// Hydraulic data of a joint. Newton iterates may close the joint further than its law and block an injection. The
/// aperture is therefore at least a fraction of that under infinite compression.
transport::FractureFlowParameters::Face hydraulics(const Material& joint, Real viscosity, const StartOfWalls& start,
                                                   const std::array<Real, 3>& x) {
  constexpr Real part = 0.9;  // below 1, so that all solutions have larger apertures than this bound
  const auto& opening = start.opening;
  const Real aperture = start.unloaded,
             residual = value_at("residual aperture", joint.residual_aperture, base::at_least(0), x),
             a = std::max(aperture, residual),
             of_iterates = opening ? part * std::max(Real(0), aperture + opening->least) : 0;
  SPREKK_CHECK(a > 0,
               "the hydraulic aperture is 0 at ({:.6g}, {:.6g}, {:.6g}), must be above 0: give an \"initial aperture\" "
               "or a \"residual aperture\"",
               x[0], x[1], x[2]);
  const auto& given = joint.tangential_permeability;
  const Real k = given ? value_at("tangential permeability", *given, base::positive(), x) : 0,
             across = value_at("normal permeability", joint.normal_permeability, base::positive_or_infinite(), x);
  const auto walls = joint.walls(x);
  const transport::FractureFlowParameters::Face face{
      .along = {aperture + (opening ? opening->initial : 0), std::max(residual, walls.hydraulic(of_iterates)), k,
                viscosity, walls, start.compliance},
      .exchange = 2 * across / (a * viscosity)};
  SPREKK_CHECK(face.along.hydraulic_aperture() > 0,
               "the hydraulic aperture is {:.3g} at ({:.6g}, {:.6g}, {:.6g}) under the initial stress, must be above "
               "0: give a \"residual aperture\", or an \"initial aperture\" above the closure",
               face.along.hydraulic_aperture(), x[0], x[1], x[2]);
  return face;
}

/// Hydraulic data of a bonded face without aperture.
transport::FractureFlowParameters::Face hydraulics_of_bonded(const Material& joint, Real viscosity,
                                                             const std::array<Real, 3>& x) {
  constexpr Real part = 0.05;  // of the residual aperture; the film conducts part^3 = 1.25e-4 of an opened face
  const Real residual = value_at("residual aperture", joint.residual_aperture, base::positive(), x);
  return {.along = {.minimum = residual, .viscosity = viscosity, .walls = joint.walls(x), .film = part * residual},
          .exchange = std::numeric_limits<Real>::infinity()};
}

/// Initial state of local fracture faces. Collective.
std::vector<StartOfWalls> starts_of(const Setting& setting) {
  const auto& [scene, mesh, start] = setting;
  std::vector<StartOfWalls> walls(mesh.fracture_faces.size());
  if (!Mechanics::is_in(scene) || mesh.fracture_names.empty()) {
    base::collectively(*mesh.comm, [&, &scene = scene, &mesh = mesh] {
      for (std::size_t f = 0; f < walls.size(); ++f) {
        const auto& joint = joint_of(scene, mesh, mesh.fracture_faces[f].single);
        walls[f].unloaded = at_place(scene, joint, [&] { return joint.aperture(mesh.fracture_faces[f].centre); });
      }
    });
    return walls;
  }
  const auto starts = starts_of_faces(setting);
  const auto all = [&, &mesh = mesh](Real StartOfFace::*value) {
    std::vector<Real> owned;
    for (const auto& one : starts) owned.push_back(one.*value);
    return with_ghosts(mesh, fields::Entity::fracture_face, owned);
  };
  const auto unloaded = all(&StartOfFace::unloaded_aperture), opening = all(&StartOfFace::opening),
             least = all(&StartOfFace::least_opening), compliance = all(&StartOfFace::compliance);
  for (std::size_t f = 0; f < walls.size(); ++f) walls[f] = {unloaded[f], Opening{opening[f], least[f]}, compliance[f]};
  return walls;
}

}  // namespace

std::vector<transport::FractureFlowParameters::Face> hydraulics(const Setting& setting) {
  const auto& scene = setting.scene;
  const auto& mesh = setting.mesh;
  const auto starts = starts_of(setting);
  std::vector<transport::FractureFlowParameters::Face> faces;
  base::collectively(*mesh.comm, [&] {
    for (std::size_t f = 0; f < starts.size(); ++f) {
      const auto& face = mesh.fracture_faces[f];
      const auto& joint = joint_of(scene, mesh, face.single);
      faces.push_back(at_place(scene, joint, [&] {
        return is_unbroken(scene, mesh, face) ? hydraulics_of_bonded(joint, scene.flow->viscosity, face.centre)
                                              : hydraulics(joint, scene.flow->viscosity, starts[f], face.centre);
      }));
      const auto& name = mesh.fracture_names[face.fracture];
      faces.back().leak_off =
          value_at(fmt::format("{}: Sprekk > Fractures > {}", scene.origin, name), "leak-off coefficient",
                   scene.fractures.at(name).leak_off, base::at_least(0), face.centre);
    }
  });
  return faces;
}

std::vector<StartAperture> start_apertures(const Setting& setting) {
  std::vector<StartAperture> apertures;
  if (setting.scene.flow)
    for (const auto& face : hydraulics(setting)) apertures.push_back({face.along.aperture, face.along.minimum});
  else
    for (const auto& start : starts_of(setting))
      apertures.push_back({start.unloaded + (start.opening ? start.opening->initial : 0), 0});
  return apertures;
}

}  // namespace sprekk::physics
