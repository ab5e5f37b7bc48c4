#include "physics/properties.hpp"

#include "mesh/facets.hpp"

namespace sprekk::physics {

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

}  // namespace sprekk::physics
