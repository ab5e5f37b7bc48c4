#include "physics/mechanics/uniqueness.hpp"

#include "base/over_ranks.hpp"
#include "laws/joint_parameters.hpp"
#include "laws/joint_slopes.hpp"
#include "mesh/extents.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>

namespace sprekk::physics {

namespace {

/// Bounds of all rocks of a scene: smallest lambda + 2 G and largest G; none if a rock is not uniform.
std::optional<laws::Elasticity> bounding_rock(const Scene& scene) {
  if (!Mechanics::is_in(scene)) return {};
  std::vector<const Material*> rocks = {&scene.materials.at(scene.bulk.material)};
  for (const auto& [name, region] : scene.regions) rocks.push_back(&scene.material_of(name));
  Real shear = 0, uniaxial = std::numeric_limits<Real>::infinity();
  for (const auto* rock : rocks) {
    if (!rock->has_elasticity()) continue;  // not used in any cell
    if (!rock->is_uniformly_elastic()) return {};
    const auto elasticity = rock->elasticity({});
    shear = std::max(shear, elasticity.G);
    uniaxial = std::min(uniaxial, elasticity.lambda + 2 * elasticity.G);
  }
  if (shear == 0) return {};
  return laws::Elasticity{shear, uniaxial - 2 * shear};
}

/// Joint of a fracture, and its name in messages.
struct UsedJoint {
  const Material& material;
  std::string called;
};

/// Joint of a single fracture.
UsedJoint used_joint(const Scene& scene, const mesh::Mesh& mesh, int single) {
  const auto& [name, set, properties] = mesh.single_fractures[single];
  const bool own = scene.own_joints.count(single) > 0;
  return {joint_of(scene, mesh, single),
          own ? fmt::format("the fracture \"{}\"", name)
              : fmt::format("\"{}\"", scene.fractures.at(mesh.fracture_names[set]).material)};
}

/// All joints in use, each once; optionally only those of fractures without "unbroken".
std::vector<UsedJoint> used_joints(const Scene& scene, const mesh::Mesh& mesh, bool with_growth = true) {
  std::set<const Material*> known;
  std::vector<UsedJoint> all;
  for (int single = 0; single < static_cast<int>(mesh.single_fractures.size()); ++single)
    if (const auto& set = mesh.fracture_names[mesh.single_fractures[single].set];
        (with_growth || !scene.fractures.at(set).unbroken) && known.insert(&joint_of(scene, mesh, single)).second)
      all.push_back(used_joint(scene, mesh, single));
  return all;
}

/// Range of compressions, Pa, for the evaluation of slopes. They strain a uniform rock by 1e-5 to 1e-2.
std::array<Real, 2> compressions(const Scene& scene) {
  const auto rock = bounding_rock(scene);
  const Real G = rock ? rock->G : 1e10;
  return {1e-5 * G, 1e-2 * G};
}

/// Slopes of bound and dilation of a joint without slip, at the compression with the largest product.
std::array<Real, 2> steepest(const laws::Joint& law, const std::array<Real, 2>& compressions) {
  std::array<Real, 2> slopes{};
  const Real zero = 0;  // all history variables
  constexpr int n = 40;
  for (int k = 0; k <= n; ++k) {
    const Real compression = compressions[0] * std::pow(compressions[1] / compressions[0], Real(k) / n);
    const Real mu = laws::bound_slope(law, compression),
               opens = laws::dilation_slope(law, {.lambda_n = -compression, .history = {&zero, 0}});
    if (mu * opens > slopes[0] * slopes[1]) slopes = {mu, opens};
  }
  return slopes;
}

using PerPiece = std::vector<int>;

/// [3 piece + component] whether faces have a prescribed displacement in this direction, or tied sides are at a
/// distance in it. Collective.
PerPiece constrained_pieces(const Scene& scene, const mesh::Mesh& mesh) {
  PerPiece constrained(3 * mesh.n_pieces, 0);
  for (const auto& [name, condition] : scene.boundary_conditions)
    for (const auto& face : mesh.boundary_faces)
      for (std::size_t i = 0; i < condition.displacement.size(); ++i)
        if (condition.lower_corner.empty() && mesh.boundary_names[face.boundary] == condition.boundary &&
            condition.displacement[i].text() != "free" &&
            (!condition.region || mesh.region_names[mesh.cell_region[face.cell]] == *condition.region))
          constrained[3 * mesh.cell_piece[face.cell] + i] = 1;
  const int dim = mesh.dim();
  for (std::size_t k = 0; k < mesh.tied_to.size(); ++k)
    for (int i = 0; i < dim; ++i) {
      const Real apart =
          mesh.coordinates[(mesh.n_free_nodes + k) * dim + i] - mesh.coordinates[mesh.tied_to[k] * dim + i];
      for (int piece = 0; piece < mesh.n_pieces && apart != 0; ++piece) constrained[3 * piece + i] = 1;
    }
  return base::max_over_ranks(*mesh.comm, constrained);
}

/// [single fracture] whether the rock resists its opening somewhere. It does not if the fracture separates a piece that
/// touches no third piece and can move along the normal. The loads alone then determine the normal traction.
/// Collective.
std::vector<int> resisted_fractures(const Scene& scene, const mesh::Mesh& mesh) {
  const auto constrained = constrained_pieces(scene, mesh);
  PerPiece first(mesh.n_pieces, mesh.n_pieces), last(mesh.n_pieces, -1);  // numbers of the neighbours of a piece
  const auto for_each_face = [&](const auto& use) {
    for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) {
      const auto& face = mesh.fracture_faces[f];
      use(face, mesh.cell_piece[face.cell[mesh::minus]], mesh.cell_piece[face.cell[mesh::plus]]);
    }
  };
  for_each_face([&](const auto&, int a, int b) {
    for (const auto& [piece, other] : {std::pair(a, b), std::pair(b, a)}) {
      first[piece] = std::min(first[piece], other);
      last[piece] = std::max(last[piece], other);
    }
  });
  first = base::min_over_ranks(*mesh.comm, first);
  last = base::max_over_ranks(*mesh.comm, last);
  const auto may_move = [&](int piece, const auto& normal) {
    for (int i = 0; i < 3; ++i)
      if (constrained[3 * piece + i] && std::abs(normal[i]) > 1e-6) return false;
    return first[piece] == last[piece];
  };
  std::vector<int> resisted(mesh.single_fractures.size(), 0);
  for_each_face([&](const auto& face, int a, int b) {
    const auto& normal = face.frame[0];
    if (a == b || !(may_move(a, normal) || may_move(b, normal))) resisted[face.single] = 1;
  });
  return base::max_over_ranks(*mesh.comm, resisted);
}

}  // namespace

std::string friction_doubt(const Scene& scene, const mesh::Mesh& mesh) {
  const auto [minimum, maximum] = compressions(scene);
  std::string joint;
  laws::JointMaterial::Slope steepest{1, true, 0};
  for (const auto& [material, called] : used_joints(scene, mesh)) {
    const auto slope = material.friction_slope(minimum, maximum);
    if (!slope || slope->largest <= steepest.largest) continue;
    steepest = *slope;
    joint = called;
  }
  if (joint.empty()) return "";
  const std::string what = steepest.constant
                               ? fmt::format("the friction coefficient of {} is {:.4g}", joint, steepest.largest)
                               : fmt::format(
                                     "the friction bound of {} increases up to {:.4g} times as fast as the "
                                     "compression, and faster than the compression below {:.2g} Pa",
                                     joint, steepest.largest, steepest.up_to);
  return what + ": above about 1 equilibrium need not exist, nor be unique";
}

std::string weakening_doubt(const Scene& scene, const mesh::Mesh& mesh) {
  const Real size = mesh::largest_extent(mesh);
  const auto rock = bounding_rock(scene);
  if (!rock) return "";
  const auto [minimum, maximum] = compressions(scene);
  const Real compression = std::sqrt(minimum * maximum), zero = 0;  // compression for the evaluation of laws
  std::string weakest;
  Real lowest = maximum;  // smallest compression of unstable slip
  for (const auto& [material, called] : used_joints(scene, mesh)) {
    if (!material.is_uniform()) continue;
    auto law = material.joint({}).law;
    law.bond = laws::Bond();  // softening of the bond does not grow with the compression
    const Real unloads = 1 / (size / rock->G + law.elastic.initial_compliance());
    for (Real slip = 1e-9; slip < 10; slip *= 1.5) {
      const Real fall = laws::weakening(law, {.lambda_n = -compression,
                                              .plastic_slip = slip,
                                              .slip_of_step = slip,
                                              .plastic_jump = {slip, 0},
                                              .history = {&zero, 0}});
      if (!(fall * lowest > unloads * compression)) continue;
      lowest = unloads * compression / fall;
      weakest = called;
    }
  }
  if (weakest.empty()) return "";
  return fmt::format(
      "the bound of {} decreases with slip, above a compression of {:.2g} MPa faster than rock of the size of the "
      "domain, {:.4g} m, unloads; slip may be unstable there, also in short steps",
      weakest, lowest / 1e6, size);
}

std::string bond_doubt(const Scene& scene, const mesh::Mesh& mesh) {
  const Real size = mesh::largest_extent(mesh), zero = 0, little = 1e-9;
  const auto rock = bounding_rock(scene);
  if (!rock) return "";
  for (const auto& [material, called] : used_joints(scene, mesh, false)) {
    if (!material.is_uniform()) continue;
    const auto law = material.joint({}).law;
    const laws::Contact<Real> whole{.history = {&zero, 0}};
    auto apart = whole;
    apart.separation = little;
    const Real softens[] = {(law.cohesion(whole).strength - law.cohesion(apart).strength) / little,
                            laws::weakening(law, whole)};
    const Real unloads[] = {1 / (size / (rock->lambda + 2 * rock->G) + law.gap.closure.initial_compliance()),
                            1 / (size / rock->G + law.elastic.initial_compliance())};
    for (int k = 0; k < 2; ++k)
      if (softens[k] > unloads[k])
        return fmt::format(
            "the bond of {} softens by {:.2g} Pa/m with {}, and rock of the size of the domain, {:.4g} m, unloads by "
            "{:.2g} Pa/m: the bond may break suddenly, also in short steps; more \"{}fracture energy\" avoids this",
            called, softens[k], k == 0 ? "opening" : "slip", size, unloads[k], k == 0 ? "" : "shear ");
  }
  return "";
}

std::string cohesion_doubt(const Scene& scene, const mesh::Mesh& mesh) {
  const Real zero = 0;
  for (const auto& [material, called] : used_joints(scene, mesh, false)) {
    if (!material.is_uniform()) continue;
    const auto cohesion = material.joint({}).law.cohesion(laws::Contact<Real>{.history = {&zero, 0}});
    if (cohesion.lost && cohesion.shear > 0)
      return fmt::format(
          "faces of {} lose their cohesion, {:.2g} Pa, at once when they open; where they are about to open, neither "
          "the closed nor the open state may be in equilibrium; an \"opening without cohesion\" of bond \"constant "
          "cohesion\" avoids this",
          called, cohesion.shear);
  }
  return "";
}

std::string dilation_doubt(const Scene& scene, const mesh::Mesh& mesh) {
  const Real size = mesh::largest_extent(mesh);
  const auto rock = bounding_rock(scene);
  if (!rock || mesh.fracture_names.empty()) return "";
  const auto resisted = resisted_fractures(scene, mesh);
  std::set<const Material*> known;
  for (std::size_t k = 0; k < resisted.size(); ++k) {
    const auto [material, called] = used_joint(scene, mesh, static_cast<int>(k));
    if (!resisted[k] || !material.is_uniform() || !known.insert(&material).second) continue;
    const auto law = material.joint({}).law;
    const auto [mu, dilation] = steepest(law, compressions(scene));
    const Real shear = mu * (size / rock->G + law.elastic.initial_compliance()),
               normal = size / (rock->lambda + 2 * rock->G) + law.gap.closure.initial_compliance();
    if (!(dilation * shear > normal)) continue;
    const auto degrees = [](Real tangent) { return std::atan(tangent) * 180 / M_PI; };
    return fmt::format(
        "on reversal of slip on {} the solution may not be unique: its dilation angle is {:.4g} degrees, and above "
        "{:.4g} the friction bound falls faster than the shear traction (rock of size {:.4g} m); less dilation or "
        "friction, or a larger tangential stiffness, avoids this",
        called, degrees(dilation), degrees(normal / shear), size);
  }
  return "";
}

}  // namespace sprekk::physics
