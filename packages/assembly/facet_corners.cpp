#include "assembly/facet_corners.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "base/over_ranks.hpp"
#include "mesh/exchange.hpp"
#include "mesh/facets.hpp"
#include "mesh/union_find.hpp"

namespace sprekk::assembly {
namespace {

using fields::CrsMatrix;
using fields::Map;
using GlobalIndices = std::vector<GlobalIndex>;

/// Unknowns at the corners of local facets, by global number.
class Corners {
 public:
  explicit Corners(const mesh::Mesh& mesh)
      : mesh_(mesh),
        n_(mesh::n_face_corners(mesh.shape)),
        in_fracture_(mesh.facets->id.size(), 0),
        of_nodes_({mesh.node_id.begin(), mesh.node_id.begin() + mesh.n_free_nodes}, mesh.n_owned_nodes, mesh.comm),
        of_faces_(face_ids(mesh), mesh.n_owned_fracture_faces, mesh.comm) {
    for (const LocalIndex facet : mesh.facets->fracture_face) in_fracture_[facet] = 1;
    number_nodes();
    join_faces();
    number_faces();
  }

  const RCP<const Map>& map() const { return map_; }  ///< of the unknowns of this rank

  /// Calls visit(facet, corners) for the owned facets, each at least once.
  template <class Visit>
  void for_facets(const Visit& visit) const {
    const auto owned = [&](LocalIndex facet, const GlobalIndices& corners) {
      if (facet < mesh_.facets->n_owned) visit(facet, corners);
    };
    GlobalIndices corners(n_);
    for_rock_facets([&](LocalIndex facet, const auto& nodes) {
      std::transform(nodes.begin(), nodes.begin() + n_, corners.begin(), [&](LocalIndex node) { return node_[node]; });
      owned(facet, corners);
    });
    for (LocalIndex face = 0; face < mesh_.n_fracture_faces(); ++face) {
      const auto at = [&](int k) { return face_[face * n_ + k % n_]; };
      for (int k = 0; k < n_; ++k) corners[k] = at(k);
      owned(mesh_.facets->fracture_face[face], corners);
      for (int k = 0; k < n_; ++k)
        owned(mesh_.facets->ridge[face * n_ + k],
              mesh_.dim() == 2 ? GlobalIndices{at(k)} : GlobalIndices{at(k), at(k + 1)});
    }
  }

  RCP<const fields::MultiVector> places() const {
    const auto result = rcp(new fields::MultiVector(map_, mesh_.dim()));
    const auto view = result->getLocalViewHost(Tpetra::Access::OverwriteAll);
    const auto set = [&](GlobalIndex number, LocalIndex node) {
      if (const LocalIndex local = map_->getLocalElement(number); local >= 0)
        for (int i = 0; i < mesh_.dim(); ++i) view(local, i) = mesh_.coordinates[node * mesh_.dim() + i];
    };
    for (LocalIndex node = 0; node < mesh_.n_owned_nodes; ++node) set(node_[node], node);
    for (LocalIndex face = 0; face < mesh_.n_owned_fracture_faces; ++face)
      for (int k = 0; k < n_; ++k) set(face_[face * n_ + k], mesh_.fracture_faces[face].nodes[mesh::minus][k]);
    return result;
  }

 private:
  static GlobalIndices face_ids(const mesh::Mesh& mesh) {
    GlobalIndices ids;
    for (const auto& face : mesh.fracture_faces) ids.push_back(face.id);
    return ids;
  }

  /// Calls visit(facet, nodes) for the faces of local cells outside of fractures.
  template <class Visit>
  void for_rock_facets(const Visit& visit) const {
    const int n_faces = mesh::n_faces(mesh_.shape);
    std::array<LocalIndex, 4> nodes{};
    for (LocalIndex face = 0; face < mesh_.n_cells() * n_faces; ++face) {
      const LocalIndex facet = mesh_.facets->of_cell[face];
      if (facet < 0 || in_fracture_[facet]) continue;
      const LocalIndex* const of_cell = &mesh_.cells[face / n_faces * mesh_.nodes_per_cell()];
      for (int k = 0; k < n_; ++k)
        nodes[k] = mesh_.free_node(of_cell[mesh::face_nodes(mesh_.shape)[face % n_faces][k]]);
      visit(facet, nodes);
    }
  }

  /// Marks the owned nodes with facets in rock. Collective.
  void number_nodes() {
    node_.assign(mesh_.n_free_nodes, 0);
    for_rock_facets([&](LocalIndex, const auto& nodes) {
      for (int k = 0; k < n_; ++k) node_[nodes[k]] = 1;
    });
    of_nodes_.to_largest(node_);
  }

  /// Joins the corners of local faces at a common ridge: [face * n + corner] representative.
  void join_faces() {
    const LocalIndex n = mesh_.n_fracture_faces() * n_;
    mesh::UnionFind joined(n);
    std::map<std::pair<LocalIndex, GlobalIndex>, LocalIndex> first;  // by ridge and point
    for (LocalIndex ridge = 0; ridge < n; ++ridge)
      for (int end = 0; end < mesh_.dim() - 1; ++end) {
        const LocalIndex face = ridge / n_, corner = face * n_ + (ridge % n_ + end) % n_;
        const GlobalIndex point = mesh_.fracture_faces[face].corners[corner % n_];
        joined.join(corner, first.try_emplace({mesh_.facets->ridge[ridge], point}, corner).first->second);
      }
    for (LocalIndex corner = 0; corner < n; ++corner) joined_.push_back(static_cast<LocalIndex>(joined.find(corner)));
  }

  /// Spreads the largest value of joined corners, [face * n + corner], over all ranks. The owner of a face has all
  /// faces at its ridges, so values travel from face to face. Collective.
  void spread_largest(GlobalIndices& values) const {
    const auto n_owned = static_cast<std::ptrdiff_t>(mesh_.n_owned_fracture_faces) * n_;
    of_faces_(values, n_);
    bool changed = true;
    while (changed) {
      const GlobalIndices before(values.begin(), values.begin() + n_owned);
      for (std::size_t i = 0; i < values.size(); ++i) values[joined_[i]] = std::max(values[joined_[i]], values[i]);
      for (std::size_t i = 0; i < values.size(); ++i) values[i] = values[joined_[i]];
      changed = base::on_any_rank(*mesh_.comm, !std::equal(before.begin(), before.end(), values.begin()));
      of_faces_(values, n_);
    }
  }

  /// Numbers the unknowns of this rank: those of its nodes, then those of fractures, which belong to the face with the
  /// largest number. Collective.
  void number_faces() {
    GlobalIndices own;
    for (const auto& face : mesh_.fracture_faces)
      for (int k = 0; k < n_; ++k) own.push_back(face.id * n_ + k);
    auto largest = own;
    spread_largest(largest);
    const std::size_t n_owned_corners = static_cast<std::size_t>(mesh_.n_owned_fracture_faces) * n_;
    LocalIndex n = static_cast<LocalIndex>(std::count(node_.begin(), node_.begin() + mesh_.n_owned_nodes, 1));
    for (std::size_t i = 0; i < n_owned_corners; ++i) n += largest[i] == own[i];
    const auto unknown = Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid();
    map_ = rcp(new const Map(unknown, static_cast<std::size_t>(n), 0, mesh_.comm));
    LocalIndex next = 0;
    for (LocalIndex node = 0; node < mesh_.n_owned_nodes; ++node)
      node_[node] = node_[node] ? map_->getGlobalElement(next++) : -1;
    of_nodes_(node_);
    face_.assign(own.size(), -1);
    for (std::size_t i = 0; i < n_owned_corners; ++i)
      if (largest[i] == own[i]) face_[i] = map_->getGlobalElement(next++);
    spread_largest(face_);
  }

  const mesh::Mesh& mesh_;
  const int n_;                    // corners of a face
  std::vector<char> in_fracture_;  // [facet] 1: fracture face
  mesh::GhostExchange of_nodes_, of_faces_;
  std::vector<LocalIndex> joined_;
  GlobalIndices node_;  // [free node] number, -1: none
  GlobalIndices face_;  // [face * n + corner] number
  RCP<const Map> map_;
};

/// Returns the columns: the unknowns of this rank, then others in ascending order. Collective.
RCP<const Map> columns_of(const Corners& corners, const mesh::Mesh& mesh) {
  GlobalIndices all, others;
  for (const GlobalIndex number : base::local_elements(*corners.map())) all.push_back(number);
  corners.for_facets([&](LocalIndex, const GlobalIndices& of_facet) {
    for (const GlobalIndex number : of_facet)
      if (!corners.map()->isNodeGlobalElement(number)) others.push_back(number);
  });
  std::sort(others.begin(), others.end());
  all.insert(all.end(), others.begin(), std::unique(others.begin(), others.end()));
  return fields::make_map(all, mesh.comm);
}

}  // namespace

FacetCorners facet_corners(const mesh::Mesh& mesh, const fields::Layout& layout) {
  const Corners corners(mesh);
  const auto columns = columns_of(corners, mesh);
  std::vector<std::size_t> start(layout.n_owned() + 1, 0);
  corners.for_facets([&](LocalIndex facet, const GlobalIndices& of_facet) { start[facet + 1] = of_facet.size(); });
  for (std::size_t row = 1; row < start.size(); ++row) start[row] += start[row - 1];
  std::vector<LocalIndex> column(start.back());
  std::vector<Real> value(start.back());
  corners.for_facets([&](LocalIndex facet, const GlobalIndices& of_facet) {
    const auto begin = column.begin() + static_cast<std::ptrdiff_t>(start[facet]);
    std::transform(of_facet.begin(), of_facet.end(), begin,
                   [&](GlobalIndex number) { return columns->getLocalElement(number); });
    std::sort(begin, begin + static_cast<std::ptrdiff_t>(of_facet.size()));
    std::fill_n(value.begin() + static_cast<std::ptrdiff_t>(start[facet]), of_facet.size(),
                1 / static_cast<Real>(of_facet.size()));
  });
  const auto shared = [](auto& values) { return Teuchos::arcp(rcp(new auto(std::move(values)))); };
  const auto P = rcp(new CrsMatrix(layout.owned(), columns, shared(start), shared(column), shared(value)));
  P->expertStaticFillComplete(corners.map(), layout.owned());
  return {P, corners.places()};
}

}  // namespace sprekk::assembly
