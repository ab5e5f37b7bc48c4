#include "assembly/geometry.hpp"

namespace sprekk::assembly {
namespace {

/// The vector's own values where kernels can read them, else a copy.
template <class Data, class T, class... Extents>
ConstView<Data> view_of(const std::vector<T>& values, Extents... extents) {
  const typename Kokkos::View<Data, Kokkos::LayoutRight, Kokkos::HostSpace>::const_type host(values.data(), extents...);
  return Kokkos::create_mirror_view_and_copy(Execution::memory_space(), host);
}

}  // namespace

Geometry::Geometry(const mesh::Mesh& mesh)
    : coordinates(view_of<Real**>(mesh.coordinates, mesh.n_nodes(), mesh.dim())),
      cells(view_of<LocalIndex**>(mesh.cells, mesh.n_cells(), mesh.nodes_per_cell())),
      region(view_of<int*>(mesh.cell_region, mesh.n_cells())) {}

std::vector<Real> cell_volumes(const mesh::Mesh& mesh) {
  std::vector<Real> volumes(mesh.n_cells(), 0);
  mesh::for_shape(mesh.shape, [&](auto shape) {
    for (LocalIndex c = 0; c < mesh.n_cells(); ++c)
      for_each_cell_point<shape(), StiffnessQuadrature<shape()>>(
          mesh, c, [&](const auto&, Real share, const auto&) { volumes[c] += share; });
  });
  return volumes;
}

}  // namespace sprekk::assembly
