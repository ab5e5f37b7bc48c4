#include "fields/properties.hpp"

#include "mesh/facets.hpp"

namespace sprekk::fields {

std::vector<Real> with_ghosts(const mesh::Mesh& mesh, Entity entity, const std::vector<Real>& owned) {
  return with_ghosts(Layout({"value", entity, 1, ""}, mesh), owned);
}

std::vector<Real> with_ghosts(const Layout& layout, const std::vector<Real>& owned) {
  Vector from(layout.owned()), to(layout.ghosted());
  {
    const auto put = from.getLocalViewHost(Tpetra::Access::OverwriteAll);
    for (std::size_t k = 0; k < owned.size(); ++k) put(k, 0) = owned[k];
  }
  to.doImport(from, *layout.import(), Tpetra::REPLACE);
  const auto all = to.getLocalViewHost(Tpetra::Access::ReadOnly);
  return {all.data(), all.data() + all.extent(0)};
}

}  // namespace sprekk::fields
