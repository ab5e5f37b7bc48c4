#include "physics/flow/flow_error.hpp"

#include "base/check.hpp"
#include "base/over_ranks.hpp"
#include "physics/flow/well_connections.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace sprekk::physics {

namespace {

class FlowError final : public MeshError {
 public:
  FlowError(assembly::System& system, HybridErrorParameters parameters, WellsParameters wells)
      : system_(system), wells_(std::move(wells)), blocks_{block("pressure"), block("face pressure")} {
    const auto& mesh = system.mesh();
    connections_ = find_well_connections(mesh, wells_).all;
    index_of_wells_.resize(wells_.wells.size());
    for (auto& c : connections_) {
      if (c.face >= 0) c.index *= wells_.faces[c.face].transmissivity();
      index_of_wells_[c.well] += c.index;
      if (c.face < 0 || mesh.dim() == 3) continue;
      const Real distance = distance_along(c);
      Real& most = parameters.fed[c.face];  // of several wells in a face
      if (std::abs(distance) > std::abs(most)) most = distance;
    }
    index_of_wells_ = base::sum_over_ranks(*mesh.comm, index_of_wells_);
    for (const auto& one : parameters.held) conditions_[one.name] = one.boundary;
    const auto& layouts = system.layouts();
    error_ = make_hybrid_error(Teuchos::rcpFromRef(mesh), layouts[blocks_[0]], layouts[blocks_[1]],
                               system.constrained(blocks_[1]), std::move(parameters));
    find_cells_at_wells();
  }

  const std::vector<LocalIndex>& cells() const override { return error_->cells(); }
  std::size_t n_of_energy() const override { return error_->n_of_energy(); }
  Parts of_state(const fields::BlockVector& x, Real t) override {
    return without_wells(error_->of_state(*x[blocks_[0]], *x[blocks_[1]], t));
  }
  Parts of_answer(const fields::BlockVector& x, const fields::BlockVector& dx) override {
    return without_wells(error_->of_answer(*x[blocks_[0]], *x[blocks_[1]], *dx[blocks_[0]], *dx[blocks_[1]]));
  }

  bool knows(const std::string& what) const override { return what == "pressure" || what == "flow"; }

  Real value(const Functional& J, const fields::BlockVector& x) override {
    for (const auto& well : wells_.wells)
      SPREKK_CHECK(
          !in_rock_.count(well.name),
          "Sprekk > Flow > Wells > {} > \"points\": in rock, must be on a fracture with \"Accuracy\": finer cells "
          "do not make its pressure more accurate, and are soon smaller than its radius",
          well.name);
    if (!J.well.empty()) return total({"wells", J.well, J.what == "flow" ? "rate" : "pressure"}, x);
    return J.what == "flow" ? through(J.boundary, x) : mean(J, x);
  }

  void add_derivative(const Functional& J, const fields::BlockVector&, fields::BlockVector& right_side) override {
    const auto at = [&](int k) { return right_side[blocks_[k]]->getLocalViewHost(Tpetra::Access::ReadWrite); };
    const std::array rows = {at(0), at(1)};
    if (!J.well.empty()) return add_well(J, rows);
    if (J.what == "flow") return add_boundary(J.boundary, rows[1]);
    const auto faces = faces_of(J);
    const Real area = area_of(faces);
    const auto& mesh = system_.mesh();
    for (const LocalIndex f : faces) rows[1](mesh.facets->fracture_face[f], 0) += mesh.fracture_faces[f].area / area;
  }

 private:
  int block(const std::string& name) const {
    const auto& blocks = system_.blocks();
    return static_cast<int>(std::find_if(blocks.begin(), blocks.end(), [&](const auto& b) { return b.name == name; }) -
                            blocks.begin());
  }

  /// From the middle of a fracture face to its well.
  Real distance_along(const WellConnection& c) const {
    const auto& face = system_.mesh().fracture_faces[c.face];
    const auto& x = wells_.wells[c.well].points[0];
    return mesh::dot(mesh::operator-(x, face.centre), face.frame[1]);
  }
  void find_cells_at_wells() {
    const auto& mesh = system_.mesh();
    const int n = mesh.nodes_per_cell();
    std::vector<GlobalIndex> nodes;
    for (const auto& c : connections_)
      for (int k = 0; k < n && c.face < 0; ++k) nodes.push_back(mesh.node_id[mesh.cells[c.row * n + k]]);
    nodes = base::gather_over_ranks(*mesh.comm, nodes);
    std::vector<int> in_rock(wells_.wells.size(), 0);
    for (const auto& c : connections_)
      if (c.face < 0) in_rock[c.well] = 1;
    in_rock = base::max_over_ranks(*mesh.comm, in_rock);
    for (std::size_t w = 0; w < in_rock.size(); ++w)
      if (in_rock[w]) in_rock_.insert(wells_.wells[w].name);
    const std::set<GlobalIndex> at_wells(nodes.begin(), nodes.end());
    is_at_well_.resize(mesh.n_owned_cells, 0);
    for (LocalIndex k = 0; k < mesh.n_owned_cells * n; ++k)
      if (at_wells.count(mesh.node_id[mesh.cells[k]])) is_at_well_[k / n] = 1;
  }
  Parts without_wells(Parts parts) const {
    for (std::size_t k = 0; k < parts.error.size(); ++k)
      if (is_at_well_[cells()[k]]) parts.error[k] = 0;
    return parts;
  }

  Real total(const std::vector<std::string>& names, const fields::BlockVector& x) {
    Real sum = 0;
    for (const auto& one : system_.totals(x))
      if (one.names == names) sum += one.value;
    return sum;
  }
  /// Into the domain, by what is prescribed.
  Real through(const std::string& boundary, const fields::BlockVector& x) {
    const auto number = index_of(system_.mesh().boundary_names, boundary);
    Real sum = total({"inflows", boundary}, x);
    for (const auto& reaction : system_.reactions(x))
      if (reaction.called.name == "inflows" && reaction.field == "face pressure" && reaction.region < 0 &&
          conditions_.at(reaction.condition) == number)
        sum += reaction.force[0];
    return sum;
  }

  std::vector<LocalIndex> faces_of(const Functional& J) const {
    const auto& mesh = system_.mesh();
    std::vector<LocalIndex> faces;
    for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) {
      const auto& name = mesh.fracture_names[mesh.fracture_faces[f].fracture];
      if (J.fractures.empty() || std::find(J.fractures.begin(), J.fractures.end(), name) != J.fractures.end())
        faces.push_back(f);
    }
    return faces;
  }
  Real area_of(const std::vector<LocalIndex>& faces) const {
    Real sum = 0;
    for (const LocalIndex f : faces) sum += system_.mesh().fracture_faces[f].area;
    return base::sum_over_ranks(*system_.mesh().comm, sum);
  }
  Real mean(const Functional& J, const fields::BlockVector& x) const {
    const auto& mesh = system_.mesh();
    const auto p = x[blocks_[1]]->getLocalViewHost(Tpetra::Access::ReadOnly);
    const auto faces = faces_of(J);
    Real sum = 0;
    for (const LocalIndex f : faces) sum += mesh.fracture_faces[f].area * p(mesh.facets->fracture_face[f], 0);
    return base::sum_over_ranks(*mesh.comm, sum) / area_of(faces);
  }

  /// Of the flow from a well, W (p_w - p), it is that by p_w; of the pressure in one the mean by W.
  template <class Rows>
  void add_well(const Functional& J, const std::array<Rows, 2>& rows) const {
    for (const auto& c : connections_)
      if (wells_.wells[c.well].name == J.well)
        rows[c.face >= 0](c.row, 0) += J.what == "flow" ? c.index : c.index / index_of_wells_[c.well];
  }
  /// Of the flow through a boundary it is that by the pressure there.
  template <class Rows>
  void add_boundary(const std::string& boundary, const Rows& rows) const {
    const auto& mesh = system_.mesh();
    const auto& facets = *mesh.facets;
    const auto held = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), system_.constrained(blocks_[1]));
    const int number = index_of(mesh.boundary_names, boundary);
    const auto set = [&](LocalIndex facet) {
      if (facet < facets.n_owned && held(facet)) rows(facet, 0) = 1;
    };
    for (const auto& face : mesh.boundary_faces)
      if (face.boundary == number) set(facets.of_cell[face.cell * mesh::n_faces(mesh.shape) + face.local_face]);
    for (const auto& rim : facets.rims)
      if (rim.boundary == number) set(facets.ridge[rim.face * mesh::n_face_corners(mesh.shape) + rim.ridge]);
  }

  assembly::System& system_;
  WellsParameters wells_;
  std::array<int, 2> blocks_;  // pressures of cells, of facets
  std::vector<WellConnection> connections_;
  std::vector<Real> index_of_wells_;       // sum of W over all ranks
  std::vector<char> is_at_well_;           // [owned cell]
  std::set<std::string> in_rock_;          // wells
  std::map<std::string, int> conditions_;  // boundaries of those that hold pressures
  std::unique_ptr<HybridError> error_;
};

}  // namespace

std::unique_ptr<MeshError> make_flow_error(assembly::System& system, HybridErrorParameters parameters,
                                           WellsParameters wells) {
  return std::make_unique<FlowError>(system, std::move(parameters), std::move(wells));
}

}  // namespace sprekk::physics
