#include "model/properties.hpp"

#include "mesh/facets.hpp"

#include <Teuchos_CommHelpers.hpp>

namespace sprekk::model {

Properties<laws::Elasticity> elasticity(const Scene& scene, const mesh::Mesh& mesh) {
  const auto material = [&](int region) -> const Material& { return scene.material_of(mesh.region_names[region]); };
  return properties<laws::Elasticity>(
      static_cast<int>(mesh.region_names.size()), mesh.cell_region,
      [&](int region) { return material(region).is_uniform(); },
      [&](int region, int cell) {
        const auto& rock = material(region);
        return at_place(scene, rock,
                        [&] { return rock.elasticity(cell < 0 ? mesh::Vector{} : mesh::cell_centre(mesh, cell)); });
      });
}

Real largest_modulus(const Scene& scene, const mesh::Mesh& mesh) {
  Real here = 0, modulus = 0;
  for (LocalIndex cell = 0; cell < mesh.n_owned_cells; ++cell) {
    const auto& material = scene.material_of(mesh.region_names[mesh.cell_region[cell]]);
    if (cell > 0 && material.is_uniform() && mesh.cell_region[cell] == mesh.cell_region[cell - 1]) continue;
    here = std::max(here, material.elasticity(mesh::cell_centre(mesh, cell)).youngs_modulus());
  }
  Teuchos::reduceAll(*mesh.comm, Teuchos::REDUCE_MAX, 1, &here, &modulus);
  return modulus;
}

std::vector<Real> with_ghosts(const mesh::Mesh& mesh, fields::Entity entity, const std::vector<Real>& owned) {
  const fields::Layout layout({"value", entity, 1, ""}, mesh);
  fields::Vector from(layout.owned()), to(layout.ghosted());
  {
    const auto put = from.getLocalViewHost(Tpetra::Access::OverwriteAll);
    for (std::size_t f = 0; f < owned.size(); ++f) put(f, 0) = owned[f];
  }
  to.doImport(from, *layout.import(), Tpetra::REPLACE);
  const auto all = to.getLocalViewHost(Tpetra::Access::ReadOnly);
  std::vector<Real> values;
  for (std::size_t f = 0; f < all.extent(0); ++f) values.push_back(all(f, 0));
  return values;
}

}  // namespace sprekk::model
