#include "assembly/geometry.hpp"

namespace sprekk::assembly {

Geometry::Geometry(const mesh::Mesh& mesh) {
  View<Real**> X("coordinates", mesh.n_nodes(), mesh.dim());
  View<LocalIndex**> nodes("cells", mesh.n_cells(), mesh.nodes_per_cell());
  View<int*> regions("regions", mesh.n_cells());
  const auto X_host = Kokkos::create_mirror_view(X);
  const auto nodes_host = Kokkos::create_mirror_view(nodes);
  const auto regions_host = Kokkos::create_mirror_view(regions);
  for (LocalIndex n = 0; n < mesh.n_nodes(); ++n)
    for (int i = 0; i < mesh.dim(); ++i) X_host(n, i) = mesh.coordinates[n * mesh.dim() + i];
  for (LocalIndex c = 0; c < mesh.n_cells(); ++c) {
    regions_host(c) = mesh.cell_region[c];
    for (int a = 0; a < mesh.nodes_per_cell(); ++a) nodes_host(c, a) = mesh.cells[c * mesh.nodes_per_cell() + a];
  }
  Kokkos::deep_copy(X, X_host);
  Kokkos::deep_copy(nodes, nodes_host);
  Kokkos::deep_copy(regions, regions_host);
  coordinates = X;
  cells = nodes;
  region = regions;
}

}  // namespace sprekk::assembly
