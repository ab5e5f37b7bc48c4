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

}  // namespace sprekk::assembly
