// Checks of scenes with growing fractures on their mesh.
#include "base/entry_of_place.hpp"
#include "base/over_ranks.hpp"
#include "mesh/facets.hpp"
#include "model/scene.hpp"

#include <algorithm>
#include <limits>

namespace sprekk::model {

namespace {

/// Smallest side of the box around the mesh.
Real smallest_side(const mesh::Mesh& mesh) {
  const int dim = mesh.dim();
  std::vector<Real> ends(2 * dim, -std::numeric_limits<Real>::max());  // -minimum and maximum of each coordinate
  for (std::size_t k = 0; k < mesh.coordinates.size(); ++k) {
    ends[2 * (k % dim)] = std::max(ends[2 * (k % dim)], -mesh.coordinates[k]);
    ends[2 * (k % dim) + 1] = std::max(ends[2 * (k % dim) + 1], mesh.coordinates[k]);
  }
  ends = base::max_over_ranks(*mesh.comm, ends);
  Real smallest = std::numeric_limits<Real>::max();
  for (int i = 0; i < dim; ++i) smallest = std::min(smallest, ends[2 * i] + ends[2 * i + 1]);
  return smallest;
}

}  // namespace

void check_growth(const Scene& scene, const mesh::Mesh& mesh) {
  const auto place = fmt::format("{}: Sprekk > ", scene.origin);
  if (scene.growth) {
    const Real side = smallest_side(mesh);
    SPREKK_CHECK(scene.growth->segment < side,
                 "{}Growth > \"segment\": is {:.6g} m, must be less than the smallest side of the mesh, {:.6g} m",
                 place, scene.growth->segment, side);
  }
  base::collectively(*mesh.comm, [&] {
    for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) {
      const auto& face = mesh.fracture_faces[f];
      const auto& name = mesh.fracture_names[face.fracture];
      const auto& toughness = scene.fractures.at(name).toughness;
      for (int k = 0; k < 2 && toughness; ++k)
        if (face.nodes[0][k] == face.nodes[1][k])
          base::value_at(place + "Fractures > " + name, "toughness", *toughness, base::positive(),
                         mesh::face_corner(mesh, f, k));
    }
  });
}

}  // namespace sprekk::model
