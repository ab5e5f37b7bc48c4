#include "transport/flux_truncation.hpp"

#include "base/check.hpp"
#include "base/over_ranks.hpp"
#include "transport/patch_fit.hpp"

namespace sprekk::transport {

namespace {

template <Shape shape>
class Truncation final : public FluxTruncation {
 public:
  using Flux = HybridFlux<shape>;
  using Of = Potentials::Of;
  static constexpr int dim = Flux::dim, n = Flux::n, fewest = dim == 2 ? 4 : 8;  // cells per fit

  Truncation(RCP<const mesh::Mesh> mesh, const Potentials::Layouts& layouts, ConstView<char*> constrained_facets,
             HybridFluxParameters parameters)
      : mesh_(mesh),
        flow_(mesh, layouts, std::move(parameters)),
        constrained_(flow_.constrained(constrained_facets)),
        around_cells_(cells(), fewest, mesh->comm),
        around_faces_(faces(), dim == 2 ? 2 : 4, mesh->comm) {}

  void set_transmissivity(FaceTransmissivity present) override { flow_.set_transmissivity(std::move(present)); }

  HybridFlows flows(const fields::Vector& cells, const fields::Vector& facets) const override {
    const Potentials u(flow_.layouts(), flow_.parameters().rock.fluid, {&cells, &facets});
    HybridFlows all;
    for (LocalIndex c = 0; c < mesh_->n_owned_cells; ++c) {
      const auto q = flow_.in_cell(c, u);
      for (int k = 0; k < n; ++k) all.in_cells.push_back(q[Flux::opposite(k)]);
    }
    for (LocalIndex f = 0; f < mesh_->n_owned_fracture_faces; ++f) {
      const auto q = flow_.in_face(f, u);
      for (int k = 0; k < dim; ++k) all.in_faces.push_back(q[Flux::opposite_ridge(k)]);
    }
    return all;
  }

  HybridFlows flows(const HybridFlows& differences) const override {
    HybridFlows all;
    for (LocalIndex c = 0; c < mesh_->n_owned_cells; ++c) {
      std::array<Real, n> drops;
      std::copy_n(&differences.in_cells[c * n], n, drops.begin());
      const auto q = flow_.in_cell(c, drops);
      for (int k = 0; k < n; ++k) all.in_cells.push_back(q[Flux::opposite(k)]);
    }
    for (LocalIndex f = 0; f < mesh_->n_owned_fracture_faces; ++f) {
      std::array<Real, dim> drops;
      std::copy_n(&differences.in_faces[f * dim], dim, drops.begin());
      const auto q = flow_.in_face(f, drops);
      for (int k = 0; k < dim; ++k) all.in_faces.push_back(q[Flux::opposite_ridge(k)]);
    }
    return all;
  }

  void add_upwind(const HybridFlows& carrying, Real capacity, const fields::Vector& cells, const fields::Vector& facets,
                  HybridFlows& excess) const override {
    const Potentials T(flow_.layouts(), {}, {&cells, &facets});
    std::vector<Real> values;
    for (LocalIndex c = 0; c < mesh_->n_owned_cells; ++c) values.push_back(T(Of::cell, c));
    const auto in_cells = around_cells_.gradients(values);
    for (LocalIndex c = 0; c < mesh_->n_owned_cells; ++c)
      for (int k = 0; k < n; ++k) {
        const auto& way = flow_.cell(c).faces.centre[k];
        Real rise = 0;
        for (int i = 0; i < dim; ++i) rise += in_cells[c][i] * way[i];
        excess.in_cells[c * n + k] -= capacity * std::max(Real(0), carrying.in_cells[c * n + k]) * rise;
      }
    values.clear();
    for (LocalIndex f = 0; f < mesh_->n_owned_fracture_faces; ++f)
      values.push_back(T(Of::facet, mesh_->facets->fracture_face[f]));
    const auto in_faces = around_faces_.gradients(values);
    for (LocalIndex f = 0; f < mesh_->n_owned_fracture_faces; ++f)
      for (int k = 0; k < dim; ++k) {
        Real rise = 0;
        for (int i = 0; i < dim; ++i) rise += in_faces[f][i] * flow_.face(f).plane.d[k][i];
        excess.in_faces[f * dim + k] -= capacity * std::max(Real(0), carrying.in_faces[f * dim + k]) * rise;
      }
  }

  void add_to_rows(const HybridFlows& excess, fields::Vector& cells, fields::Vector& facets) const override {
    std::vector<Real> of_facets(mesh_->facets->id.size(), 0);
    {
      const auto of_cells = cells.getLocalViewHost(Tpetra::Access::ReadWrite);
      for (LocalIndex c = 0; c < mesh_->n_owned_cells; ++c)
        for (int k = 0; k < n; ++k) {
          of_cells(c, 0) += excess.in_cells[c * n + k];
          of_facets[flow_.facet_of_cell(c, k)] -= excess.in_cells[c * n + k];
        }
      for (LocalIndex f = 0; f < mesh_->n_owned_fracture_faces; ++f)
        for (int k = 0; k < dim; ++k) {
          of_facets[mesh_->facets->fracture_face[f]] += excess.in_faces[f * dim + k];
          of_facets[flow_.facet_of_face(f, k)] -= excess.in_faces[f * dim + k];
        }
    }
    add_over_ranks(of_facets, facets);
  }

  void add_over_ranks(const std::vector<Real>& local, fields::Vector& facets) const override {
    fields::Vector all(flow_.layouts()[1]->ghosted()), sums(facets.getMap());
    {
      const auto view = all.getLocalViewHost(Tpetra::Access::OverwriteAll);
      for (std::size_t k = 0; k < local.size(); ++k) view(k, 0) = local[k];
    }
    sums.doExport(all, *flow_.layouts()[1]->import(), Tpetra::ADD);
    facets.update(1, sums, 1);
  }

  void add_prescribed(Real t, fields::Vector& facets) const override {
    std::vector<Real> missed(mesh_->facets->id.size(), 0);
    base::collectively(*mesh_->comm, [&] {
      for (const auto& constrained : constrained_) {
        if (!constrained.in_rock && dim == 2) continue;  // the end is a point
        Real mean = 0;
        mesh::Vector middle{};
        const auto points = flow_.points(constrained);
        const auto n_corners = std::count_if(points.begin(), points.end(), [](const auto& p) { return p.a == p.b; });
        for (const auto& point : points) {
          mean += point.share * flow_.prescribed(constrained, point.x, t);
          for (int i = 0; i < dim && point.a == point.b; ++i) middle[i] += point.x[i] / static_cast<Real>(n_corners);
        }
        missed[constrained.facet] = mean - flow_.prescribed(constrained, middle, t);
      }
    });
    add_over_ranks(missed, facets);
  }

  std::vector<Real> products(const HybridFlows& excess, const fields::Vector& cells,
                             const fields::Vector& facets) const override {
    const Potentials v(flow_.layouts(), {}, {&cells, &facets});
    std::vector<Real> result(mesh_->n_owned_cells, 0);
    for (LocalIndex c = 0; c < mesh_->n_owned_cells; ++c)
      for (int k = 0; k < n; ++k)
        result[c] += std::abs(excess.in_cells[c * n + k] * (v(Of::cell, c) - v(Of::facet, flow_.facet_of_cell(c, k))));
    for (LocalIndex f = 0; f < mesh_->n_owned_fracture_faces; ++f)
      for (int k = 0; k < dim; ++k)
        result[mesh_->fracture_faces[f].cell[mesh::minus]] +=
            std::abs(excess.in_faces[f * dim + k] *
                     (v(Of::facet, mesh_->facets->fracture_face[f]) - v(Of::facet, flow_.facet_of_face(f, k))));
    return result;
  }

 private:
  using AroundCells = PatchFit<n>;
  using AroundFaces = PatchFit<dim>;

  mesh::Vector at(LocalIndex node) const {
    mesh::Vector x{};
    std::copy_n(&mesh_->coordinates[node * dim], dim, x.begin());
    return x;
  }
  std::vector<PatchEntity<n>> cells() const {
    std::vector<PatchEntity<n>> all;
    const auto n_regions = static_cast<GlobalIndex>(mesh_->region_names.size());
    for (LocalIndex c = 0; c < mesh_->n_owned_cells; ++c) {
      auto& cell = all.emplace_back();
      cell.centre = mesh::cell_centre(*mesh_, c);
      for (int k = 0; k < n; ++k) {
        const LocalIndex node = flow_.node(c, k);
        cell.corner[k] = mesh_->node_id[mesh_->free_node(node)] * n_regions + mesh_->cell_region[c];
        cell.at[k] = at(node);
        cell.is_regular[k] = true;
      }
    }
    return all;
  }
  /// Fracture faces. A corner on an intersection is irregular, because values along a single fracture have a kink
  /// there.
  std::vector<PatchEntity<dim>> faces() const {
    const auto n_fractures = static_cast<GlobalIndex>(mesh_->single_fractures.size());
    std::vector<PatchEntity<dim>> all;
    for (LocalIndex f = 0; f < mesh_->n_owned_fracture_faces; ++f) {
      const auto& face = mesh_->fracture_faces[f];
      auto& entity = all.emplace_back();
      entity.centre = face.centre;
      for (int k = 0; k < dim; ++k) {
        entity.corner[k] = face.corners[k] * n_fractures + face.single;
        entity.at[k] = at(face.nodes[mesh::minus][k]);
      }
    }
    Places of_fracture, of_all;
    std::vector<std::array<int, 2>> place;
    for (LocalIndex f = 0; f < mesh_->n_owned_fracture_faces; ++f)
      for (int k = 0; k < dim; ++k)
        place.push_back({of_fracture.add(all[f].corner[k]), of_all.add(mesh_->fracture_faces[f].corners[k])});
    of_fracture.close(mesh_->comm);
    of_all.close(mesh_->comm);
    std::vector<std::array<Real, 1>> by_fracture(of_fracture.size()), by_all(of_all.size());
    for (const auto& [one, any] : place) {
      by_fracture[one][0] += 1;
      by_all[any][0] += 1;
    }
    of_fracture.sum_over_ranks(by_fracture);
    of_all.sum_over_ranks(by_all);
    for (std::size_t k = 0; k < place.size(); ++k)
      all[k / dim].is_regular[k % dim] = by_fracture[place[k][0]] == by_all[place[k][1]];
    return all;
  }

  RCP<const mesh::Mesh> mesh_;
  Flux flow_;
  std::vector<typename Flux::Constrained> constrained_;
  AroundCells around_cells_;
  AroundFaces around_faces_;
};

}  // namespace

std::unique_ptr<FluxTruncation> make_flux_truncation(RCP<const mesh::Mesh> mesh, const fields::Layout& cells,
                                                     const fields::Layout& facets, ConstView<char*> constrained_facets,
                                                     HybridFluxParameters parameters) {
  SPREKK_CHECK(mesh::is_simplex(mesh->shape), "the estimate of the error of fluxes is of triangles and tetrahedra");
  return mesh::for_corners(mesh->shape, [&](auto shape) -> std::unique_ptr<FluxTruncation> {
    if constexpr (mesh::is_simplex(shape()))
      return std::make_unique<Truncation<shape()>>(mesh, Potentials::Layouts{&cells, &facets}, constrained_facets,
                                                   std::move(parameters));
    else
      return nullptr;
  });
}

}  // namespace sprekk::transport
