#include "assembly/divergence.hpp"

#include "assembly/geometry.hpp"
#include "assembly/loop.hpp"
#include "assembly/reference_cell.hpp"
#include "assembly/tip_cell.hpp"
#include "base/check.hpp"
#include "base/host_table.hpp"

#include <memory>
#include <numeric>

namespace sprekk::assembly {

namespace {

using OfCell = std::function<Real(LocalIndex)>;

template <Shape shape>
View<Real**> cell_divergence(const mesh::Mesh& mesh, const OfCell& factor) {
  constexpr int dim = mesh::dimension(shape), n = mesh::n_nodes(shape);
  const base::HostTable<Real**> volume("volume", mesh.n_cells(), n * dim);
  Real X[n][dim], dN[n][dim], g[dim];
  for (LocalIndex c = 0; c < mesh.n_cells(); ++c) {
    gather_host<shape>(mesh, c, X);
    for_each_cell_point<shape>(mesh, c, [&](const Real(&xi)[dim], Real part, const auto&) {
      ReferenceCell<shape>::gradients(xi, dN);
      const CellPoint<shape> point(X, dN);
      for (int a = 0; a < n; ++a) {
        point.gradient(dN[a], g);
        for (int i = 0; i < dim; ++i) volume(c, a * dim + i) += part * factor(c) * g[i];
      }
    });
  }
  return volume.on_device();
}

template <Shape shape>
View<Real**> bubble_divergence(const mesh::Mesh& mesh, const OfCell& factor) {
  constexpr int dim = mesh::dimension(shape), n = mesh::n_nodes(shape);
  using Cell = ReferenceCell<shape>;
  const auto sides = fracture_sides(mesh);
  const base::HostTable<Real**> volume("volume", sides.size(), dim);
  Real X[n][dim], dN[n][dim], db[dim], g[dim];
  for (std::size_t s = 0; s < sides.size(); ++s) {
    const auto& face = mesh.fracture_faces[sides[s][0]];
    const LocalIndex cell = face.cell[sides[s][1]];
    gather_host<shape>(mesh, cell, X);
    for_each_cell_point<shape>(mesh, cell, [&](const Real(&xi)[dim], Real part, const auto&) {
      Cell::gradients(xi, dN);
      Cell::bubble(face.local_face[sides[s][1]], xi, db);
      CellPoint<shape>(X, dN).gradient(db, g);
      for (int i = 0; i < dim; ++i) volume(s, i) += part * factor(cell) * g[i];
    });
  }
  return volume.on_device();
}

template <Shape shape>
View<Real**> tip_divergence(const mesh::Mesh& mesh, const OfCell& factor) {
  constexpr int dim = mesh::dimension(shape), n = mesh::n_nodes(shape);
  const auto cells = tip_cells(mesh);
  const base::HostTable<Real**> volume("volume", cells.size(), n * dim);
  const auto rules = std::make_shared<TipRules>();
  for (std::size_t c = 0; c < cells.size(); ++c)
    TipCell<shape>(mesh, cells[c], rules).for_each_point([&](const auto&, Real part, const auto&, const auto& v) {
      for (int a = 0; a < n; ++a)
        for (int i = 0; i < dim; ++i) volume(c, a * dim + i) += part * factor(cells[c]) * v.grad_psi[a][i];
    });
  return volume.on_device();
}

template <Shape shape>
View<Real**> tip_side_volumes_of(const mesh::Mesh& mesh) {
  constexpr int dim = mesh::dimension(shape), n = mesh::n_nodes(shape);
  const auto all = fracture_sides(mesh);
  const auto selected = tip_sides(mesh);
  const base::HostTable<Real**> volume("volume", selected.size(), n * dim);
  using Tip = TipCell<shape>;
  const auto rules = std::make_shared<TipRules>();
  for (std::size_t s = 0; s < selected.size(); ++s) {
    const auto [f, side] = all[selected[s]];
    const auto& face = mesh.fracture_faces[f];
    const auto means = Tip(mesh, face.cell[side], rules).face_means(face.local_face[side]);
    for (int k = 0; k < Tip::n_face; ++k)
      for (int i = 0; i < dim; ++i)
        volume(s, mesh::face_nodes(shape)[face.local_face[side]][k] * dim + i) =
            (side == mesh::plus ? face.area : -face.area) * means[k] * face.frame[0][i];
  }
  return volume.on_device();
}

}  // namespace

std::vector<Divergence> divergence_fields(const mesh::Mesh& mesh, const VectorFields& names) {
  std::vector<Divergence> all = {{Loop::cells, names[0]}};
  if (!mesh.fracture_names.empty()) all.push_back({Loop::fracture_sides, names[1]});
  if (mesh.n_global_enriched > 0) all.push_back({Loop::tip_cells, names[2]});
  return all;
}

std::vector<Divergence> divergence(const mesh::Mesh& mesh, const VectorFields& names, const OfCell& factor) {
  auto all = divergence_fields(mesh, names);
  for (auto& [loop, field, volume, cells] : all)
    if (loop == Loop::cells) {
      volume = mesh::for_shape(mesh.shape, [&](auto shape) { return cell_divergence<shape()>(mesh, factor); });
      cells.resize(mesh.n_cells());
      std::iota(cells.begin(), cells.end(), 0);
    } else if (loop == Loop::fracture_sides) {
      volume = mesh::for_shape(mesh.shape, [&](auto shape) { return bubble_divergence<shape()>(mesh, factor); });
      for (const auto& [f, side] : fracture_sides(mesh)) cells.push_back(mesh.fracture_faces[f].cell[side]);
    } else {
      volume = mesh::for_corners(mesh.shape, [&](auto shape) { return tip_divergence<shape()>(mesh, factor); });
      cells = tip_cells(mesh);
    }
  return all;
}

View<Real**> side_volumes(const mesh::Mesh& mesh) {
  const int dim = mesh.dim(), n = mesh.nodes_per_cell();
  const auto sides = fracture_sides(mesh);
  const base::HostTable<Real**> volume("volume", sides.size(), n * dim + dim);
  for (std::size_t s = 0; s < sides.size(); ++s) {
    const auto [f, side] = sides[s];
    const auto& face = mesh.fracture_faces[f];
    const LocalIndex cell = face.cell[side];
    const int local_face = face.local_face[side];
    const Real area = side == mesh::plus ? face.area : -face.area;
    const auto shares = mean_shares(mesh, cell, local_face);
    const Real mean = bubble_mean(mesh, cell, local_face);
    for (int i = 0; i < dim; ++i) {
      for (int k = 0; k < mesh::n_face_nodes(mesh.shape); ++k)
        volume(s, mesh::face_nodes(mesh.shape)[local_face][k] * dim + i) = area * shares[k] * face.frame[0][i];
      volume(s, n * dim + i) = area * mean * face.frame[0][i];
    }
  }
  return volume.on_device();
}

View<Real**> layer_volumes(const mesh::Mesh& mesh) {
  SPREKK_CHECK(
      mesh.n_global_enriched == 0,
      "the volume of a layer in a fracture is not known where crack tips are enriched; give the mesh plain tips");
  const auto sides = fracture_sides(mesh);
  const auto of_sides = base::to_host(side_volumes(mesh));
  const std::size_t n = of_sides.extent(1);
  const base::HostTable<Real**> volume("layer volumes", sides.size(), n + 1);
  for (std::size_t s = 0; s < sides.size(); ++s) {
    for (std::size_t k = 0; k < n; ++k) volume(s, k) = of_sides(s, k);
    volume(s, n) = mesh.fracture_faces[sides[s][0]].area / 2;
  }
  return volume.on_device();
}

View<Real**> tip_side_volumes(const mesh::Mesh& mesh) {
  return mesh::for_corners(mesh.shape, [&](auto shape) { return tip_side_volumes_of<shape()>(mesh); });
}

}  // namespace sprekk::assembly
