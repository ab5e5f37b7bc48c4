#include "linearised.hpp"

#include "assembly/geometry.hpp"
#include "assembly/jacobian_check.hpp"
#include "base/over_ranks.hpp"
#include "estimate/mesh_error.hpp"
#include "mesh/facets.hpp"

namespace sprekk::python {

using model::Model;

namespace {

/// Global numbers of rows and columns of a system with block after block.
struct Numbering {
  std::vector<GlobalIndex> first;  ///< [block] first number
  explicit Numbering(const assembly::System& system) {
    GlobalIndex n = 0;
    for (const auto& block : system.blocks()) {
      first.push_back(n);
      n += static_cast<GlobalIndex>(block.map->getGlobalNumElements());
    }
    first.push_back(n);
  }
};

fields::BlockVector vectors_of(const assembly::System& system, const py::list& unknowns) {
  fields::BlockVector x;
  for (std::size_t b = 0; b < system.blocks().size(); ++b) {
    x.push_back(rcp(new fields::Vector(system.blocks()[b].map)));
    const auto values = unknowns[b].cast<py::array_t<Real, py::array::c_style | py::array::forcecast>>();
    const auto local = x[b]->getLocalViewHost(Tpetra::Access::OverwriteAll);
    SPREKK_CHECK(static_cast<std::size_t>(values.size()) == local.extent(0),
                 "block \"{}\": {} values are given, it has {}", system.blocks()[b].name, values.size(),
                 local.extent(0));
    for (std::size_t i = 0; i < local.extent(0); ++i) local(i, 0) = values.data()[i];
  }
  return x;
}

py::list lists_of(const fields::BlockVector& vectors) {
  py::list all;
  for (const auto& block : vectors) {
    const auto local = block->getLocalViewHost(Tpetra::Access::ReadOnly);
    std::vector<Real> values;
    for (std::size_t i = 0; i < local.extent(0); ++i) values.push_back(local(i, 0));
    all.append(array_of(std::move(values)));
  }
  return all;
}

/// Centres of owned facets of cells and fracture faces, and of ridges of fracture faces.
py::array_t<Real> facet_centres(const mesh::Mesh& mesh) {
  const auto& facets = *mesh.facets;
  const auto dim = static_cast<std::size_t>(mesh.dim());
  std::vector<Real> centres(facets.n_owned * dim);
  const auto set = [&](LocalIndex facet, const mesh::Vector& x) {
    if (facet >= 0 && facet < facets.n_owned) std::copy_n(x.begin(), dim, centres.begin() + facet * dim);
  };
  const int n_faces = mesh::n_faces(mesh.shape), n_ridges = mesh::n_face_corners(mesh.shape);
  for (LocalIndex c = 0; facets.in_rock && c < mesh.n_cells(); ++c)
    for (int k = 0; k < n_faces; ++k)
      set(facets.of_cell[c * n_faces + k], mesh::face_centre(mesh::face_corners(mesh, c, k)));
  for (LocalIndex f = 0; f < mesh.n_fracture_faces(); ++f) {
    if (mesh.fracture_faces[f].cell[mesh::minus] < 0) continue;
    set(facets.fracture_face[f], mesh.fracture_faces[f].centre);
    for (int k = 0; k < n_ridges; ++k) set(facets.ridge[f * n_ridges + k], mesh::ridge_centre(mesh, f, k));
  }
  return array_of(std::move(centres), {facets.n_owned, mesh.dim()});
}

}  // namespace

py::list residual_at(Model& model, const py::list& unknowns, Real t, Real dt, bool raw) {
  auto& system = model.system();
  const auto x = vectors_of(system, unknowns);
  auto r = fields::create_like(x);
  system.set_time(t, dt);
  if (raw)
    system.raw_residual(x, r);
  else
    system.residual(x, r);
  return lists_of(r);
}

void linearise(Model& model, Real dt) {
  model.system().set_time(model.time(), dt);
  model.newton().linearize(model.state());
}

py::tuple response_to(Model& model, const py::list& b, Real tolerance) {
  auto dx = fields::create_like(model.state());
  const auto report = model.newton().solve_linearized(model.state(), vectors_of(model.system(), b), dx, tolerance);
  SPREKK_CHECK(report.converged, "linear solve: {}", report.reason);
  return py::make_tuple(lists_of(dx), report.iterations);
}

py::dict error_energies(Model& model, const py::list& responses) {
  py::dict all;
  physics::for_each_physics([&]<physics::HasEstimate P>(P) {
    if (!P::Estimate::missing(model.scene()).empty()) return;
    const auto error = P::Estimate::mesh_error(model.setting(), model.system());
    if (!error || !error->goals()) return;
    py::list energies;
    for (const auto& response : responses) {
      const auto z = vectors_of(model.system(), response.cast<py::list>());
      energies.append(array_of(error->goals()->of_adjoint(model.state(), z).energy));
    }
    all[error->names().name.c_str()] = energies;
  });
  return all;
}

py::list product_with(Model& model, const py::list& x) {
  auto& system = model.system();
  const auto vectors = vectors_of(system, x);
  auto product = fields::create_like(vectors);
  system.matrix().apply(vectors, product);
  return lists_of(product);
}

py::list prescribed_in(const Model& model) {
  py::list all;
  for (std::size_t b = 0; b < model.system().blocks().size(); ++b) {
    const auto mask = base::to_host(model.system().constrained(static_cast<int>(b)));
    all.append(array_of(std::vector<char>(mask.data(), mask.data() + mask.extent(0))));
  }
  return all;
}

py::dict boundary_of(const mesh::Mesh& mesh) {
  const auto dim = static_cast<std::size_t>(mesh.dim());
  const py::ssize_t per_face = mesh::n_face_nodes(mesh.shape);
  std::vector<int> boundary, cell, nodes, facet;
  std::vector<Real> centre, area;
  for (const auto& face : mesh.boundary_faces) {
    if (!face.owned) continue;
    const auto corners = mesh::face_corners(mesh, face.cell, face.local_face);
    const auto x = mesh::face_centre(corners), normal = mesh::area_vector(corners);
    boundary.push_back(face.boundary);
    cell.push_back(face.cell);
    for (py::ssize_t k = 0; k < per_face; ++k)
      nodes.push_back(mesh.cells[face.cell * mesh.nodes_per_cell() + mesh::face_nodes(mesh.shape)[face.local_face][k]]);
    centre.insert(centre.end(), x.begin(), x.begin() + dim);
    area.insert(area.end(), normal.begin(), normal.begin() + dim);
    if (!mesh.facets.is_null() && mesh.facets->in_rock)
      facet.push_back(mesh.facets->of_cell[face.cell * mesh::n_faces(mesh.shape) + face.local_face]);
  }
  const auto n = static_cast<py::ssize_t>(boundary.size());
  py::dict all;
  all["boundary"] = array_of(std::move(boundary));
  all["cell"] = array_of(std::move(cell));
  all["nodes"] = array_of(std::move(nodes), {n, per_face});
  all["centre"] = array_of(std::move(centre), {n, mesh.dim()});
  all["area"] = array_of(std::move(area), {n, mesh.dim()});
  all["cell_volume"] = array_of(assembly::cell_volumes(mesh));
  if (mesh.facets.is_null()) return all;
  all["facet"] = array_of(std::move(facet));
  all["facet_centre"] = facet_centres(mesh);
  return all;
}

py::tuple jacobian_at(Model& model, const py::list& unknowns, Real t, Real dt, bool raw) {
  auto& system = model.system();
  const auto x = vectors_of(system, unknowns);
  const Numbering numbers(system);
  auto J = system.create_matrix();
  std::vector<GlobalIndex> rows, columns;
  std::vector<Real> values;
  const int n = J.n_blocks();
  system.set_time(t, dt);
  for (std::size_t m = 0; m < system.modules().size(); ++m) {
    system.module_jacobian(static_cast<int>(m), x, J);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        if (J(i, j).is_null()) continue;
        const auto constrained = system.constrained(i);
        const auto local = J(i, j)->getLocalMatrixDevice();
        const auto& row_map = *J(i, j)->getRowMap();
        const auto& column_map = *J(i, j)->getColMap();
        for (LocalIndex row = 0; row < local.numRows(); ++row) {
          if (constrained(row) && !raw) continue;
          for (auto k = local.graph.row_map(row); k < local.graph.row_map(row + 1); ++k) {
            if (local.values(k) == 0) continue;
            rows.push_back(numbers.first[i] + row_map.getGlobalElement(row));
            columns.push_back(numbers.first[j] + column_map.getGlobalElement(local.graph.entries(k)));
            values.push_back(local.values(k));
          }
        }
      }
  }
  for (int i = 0; i < n && !raw; ++i) {
    const auto constrained = system.constrained(i);
    for (std::size_t row = 0; row < constrained.extent(0); ++row)
      if (constrained(row)) {
        rows.push_back(numbers.first[i] + system.blocks()[i].map->getGlobalElement(static_cast<LocalIndex>(row)));
        columns.push_back(rows.back());
        values.push_back(1);
      }
  }
  py::list owned;
  for (int i = 0; i < n; ++i) {
    std::vector<GlobalIndex> here;
    for (const GlobalIndex k : base::local_elements(*system.blocks()[i].map)) here.push_back(numbers.first[i] + k);
    owned.append(array_of(std::move(here)));
  }
  return py::make_tuple(array_of(std::move(rows)), array_of(std::move(columns)), array_of(std::move(values)),
                        numbers.first.back(), owned);
}

py::list jacobian_errors(Model& model, const py::list& unknowns, Real t, Real dt) {
  auto& system = model.system();
  const auto x = vectors_of(system, unknowns);
  system.set_time(t, dt);
  py::list all;
  for (const auto& error : assembly::check_jacobian(system, x))
    all.append(py::make_tuple(error.module, error.row, error.column, error.error));
  return all;
}

}  // namespace sprekk::python
