#include "mesh/distribute.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>

#include "base/check.hpp"
#include "mesh/bodies.hpp"
#include "mesh/facets.hpp"
#include "mesh/partition.hpp"

namespace sprekk::mesh {
namespace {

/// Entities of one kind on this rank, owned ones first.
struct Numbering {
  std::vector<GlobalIndex> ids;      ///< [local]
  std::vector<LocalIndex> local_of;  ///< [global] local number; -1 if not on this rank
  LocalIndex n_owned = 0;

  void append(GlobalIndex id) {
    local_of[id] = static_cast<LocalIndex>(ids.size());
    ids.push_back(id);
  }
};

/// Numbers the owned entities first, then the other local ones.
Numbering number(const std::vector<bool>& is_local, const std::vector<int>& owner, int rank) {
  const auto n = static_cast<GlobalIndex>(owner.size());
  Numbering result;
  result.local_of.assign(n, -1);
  for (GlobalIndex id = 0; id < n; ++id)
    if (owner[id] == rank) result.append(id);
  result.n_owned = static_cast<LocalIndex>(result.ids.size());
  for (GlobalIndex id = 0; id < n; ++id)
    if (is_local[id] && owner[id] != rank) result.append(id);
  return result;
}

/// Builds the part of any rank, without its communicator.
class Distributor {
 public:
  /// Stores references to the arguments. Throws an Error if a part is not a rank or a node belongs to no cell.
  Distributor(const GlobalMesh& global, const std::vector<int>& part, int n_ranks)
      : global_(global),
        part_(part),
        nodes_per_cell_(n_nodes(global.shape)),
        pieces_(find_pieces(global)),
        at_points_(find_faces_at_points(global)) {
    check(n_ranks);
    node_owner_ = node_owners(n_ranks);
    report_ = report(global, part, n_ranks);
    number_enriched();
  }

  Mesh build(int rank) {
    rank_ = rank;
    mesh_ = Mesh();
    mesh_.shape = global_.shape;
    mesh_.region_names = global_.region_names;
    mesh_.boundary_names = global_.boundary_names;
    mesh_.fracture_names = global_.fracture_names;
    mesh_.single_fractures = global_.single_fractures;
    mesh_.n_global_nodes = global_.n_nodes();
    mesh_.n_global_cells = global_.n_cells();
    mesh_.n_pieces = pieces_.n();
    mesh_.n_global_fracture_faces = static_cast<GlobalIndex>(global_.fracture_faces.size());
    mesh_.partition = report_;
    cells_ = number(local_cells(), part_, rank_);
    nodes_ = number(nodes_of([&](GlobalIndex cell) { return cells_.local_of[cell] >= 0; }), node_owner_, rank_);
    fill_nodes();
    fill_enriched();
    fill_cells();
    fill_fracture_faces();
    fill_boundary_faces();
    return std::move(mesh_);
  }

 private:
  const GlobalMesh& global_;
  const std::vector<int>& part_;
  const int nodes_per_cell_;
  const Bodies pieces_;
  const std::vector<std::vector<GlobalIndex>> at_points_;  // see find_faces_at_points()
  int rank_ = 0;
  std::vector<int> node_owner_;
  PartitionReport report_;
  std::vector<GlobalIndex> enriched_;  // [node] number among the enriched nodes, or -1; empty without tips
  GlobalIndex n_enriched_ = 0;
  Numbering cells_, nodes_;
  Mesh mesh_;

  void check(int n_ranks) const {
    SPREKK_CHECK(static_cast<GlobalIndex>(part_.size()) == global_.n_cells(), "distribute: {} parts for {} cells",
                 part_.size(), global_.n_cells());
    for (std::size_t cell = 0; cell < part_.size(); ++cell)
      SPREKK_CHECK(part_[cell] >= 0 && part_[cell] < n_ranks, "distribute: cell {} is in part {}; there are {} ranks",
                   cell, part_[cell], n_ranks);
  }

  GlobalIndex node(GlobalIndex cell, int k) const { return global_.cells[cell * nodes_per_cell_ + k]; }

  /// Nodes of the selected cells, and the nodes to which these are tied.
  template <class Predicate>
  std::vector<bool> nodes_of(const Predicate& selected) const {
    std::vector<bool> result(global_.n_nodes(), false);
    for (GlobalIndex cell = 0; cell < global_.n_cells(); ++cell)
      if (selected(cell))
        for (int k = 0; k < nodes_per_cell_; ++k)
          result[node(cell, k)] = result[global_.free_node(node(cell, k))] = true;
    return result;
  }

  /// Returns the local cells: cells that share a node with an owned cell, thus also owned cells, and the further ghost
  /// cells documented at Mesh.
  std::vector<bool> local_cells() const {
    const auto is_near = nodes_of([&](GlobalIndex cell) { return part_[cell] == rank_; });
    std::vector<bool> result(global_.n_cells(), false);
    for (GlobalIndex cell = 0; cell < global_.n_cells(); ++cell)
      for (int k = 0; k < nodes_per_cell_ && !result[cell]; ++k)
        result[cell] = is_near[global_.free_node(node(cell, k))];
    for (const auto& face : global_.fracture_faces)
      if (part_[face.cell[minus]] == rank_) result[face.cell[plus]] = true;
    const auto minus_cell = [&](GlobalIndex face) { return global_.fracture_faces[face].cell[minus]; };
    for (const auto& faces : at_points_)
      if (std::any_of(faces.begin(), faces.end(), [&](GlobalIndex face) { return part_[minus_cell(face)] == rank_; }))
        for (const GlobalIndex face : faces) result[minus_cell(face)] = true;
    return result;
  }

  /// Fracture faces at each corner point with several faces.
  static std::vector<std::vector<GlobalIndex>> find_faces_at_points(const GlobalMesh& mesh) {
    std::vector<std::array<GlobalIndex, 2>> ends;  // point, face
    for (std::size_t id = 0; id < mesh.fracture_faces.size(); ++id)
      for (int k = 0; k < n_face_corners(mesh.shape); ++k)
        ends.push_back({corners_of(mesh, id)[k], static_cast<GlobalIndex>(id)});
    std::sort(ends.begin(), ends.end());
    std::vector<std::vector<GlobalIndex>> result;
    for (auto first = ends.begin(), end = first; first != ends.end(); first = end) {
      end = std::find_if(first, ends.end(), [&](const auto& other) { return other[0] != (*first)[0]; });
      if (end - first < 2) continue;
      result.emplace_back();
      std::transform(first, end, std::back_inserter(result.back()), [](const auto& one) { return one[1]; });
    }
    return result;
  }

  /// Points at the corners of a fracture face, in the order of the minus cell's face.
  static std::array<GlobalIndex, 4> corners_of(const GlobalMesh& mesh, GlobalIndex id) {
    const auto& face = mesh.fracture_faces[id];
    const auto nodes = nodes_of_face(mesh, face.cell[minus], face.local_face[minus]);
    std::array<GlobalIndex, 4> corners{-1, -1, -1, -1};
    for (int k = 0; k < n_face_corners(mesh.shape); ++k) corners[k] = mesh.point_of(nodes[k]);
    return corners;
  }

  /// Returns for each node the lowest rank that owns a cell at the node or at a tied node; -1 for tied nodes.
  std::vector<int> node_owners(int n_ranks) const {
    std::vector<int> owner(global_.n_nodes(), n_ranks);
    for (GlobalIndex cell = 0; cell < global_.n_cells(); ++cell)
      for (int k = 0; k < nodes_per_cell_; ++k) {
        int& rank = owner[global_.free_node(node(cell, k))];
        rank = std::min(rank, part_[cell]);
      }
    std::fill(owner.begin() + global_.n_free_nodes(), owner.end(), -1);
    const auto orphan = std::find(owner.begin(), owner.end(), n_ranks);
    SPREKK_CHECK(orphan == owner.end(), "distribute: node {} belongs to no cell", orphan - owner.begin());
    return owner;
  }

  void fill_nodes() {
    const int dim = global_.dim();
    mesh_.n_owned_nodes = nodes_.n_owned;
    for (GlobalIndex id : nodes_.ids) {  // tied nodes are last: they have the highest numbers and no owner
      if (id < global_.n_free_nodes())
        ++mesh_.n_free_nodes;
      else
        mesh_.tied_to.push_back(nodes_.local_of[global_.free_node(id)]);
    }
    mesh_.node_id = nodes_.ids;
    mesh_.coordinates.reserve(dim * nodes_.ids.size());
    for (GlobalIndex id : nodes_.ids)
      mesh_.coordinates.insert(mesh_.coordinates.end(), &global_.coordinates[id * dim],
                               &global_.coordinates[id * dim] + dim);
  }

  /// Numbers the nodes that are not tips but belong to a cell with a tip.
  void number_enriched() {
    if (global_.tip.empty() || order(global_.shape) == 2) return;
    enriched_.assign(global_.n_nodes(), -1);
    for (GlobalIndex cell = 0; cell < global_.n_cells(); ++cell) {
      bool has_tip = false;
      for (int k = 0; k < nodes_per_cell_; ++k) has_tip = has_tip || global_.tip[node(cell, k)];
      for (int k = 0; k < nodes_per_cell_ && has_tip; ++k)
        if (!global_.tip[node(cell, k)]) enriched_[global_.free_node(node(cell, k))] = 0;
    }
    for (auto& number : enriched_)
      if (number == 0) number = n_enriched_++;
  }

  void fill_enriched() {
    if (global_.tip.empty()) return;
    for (GlobalIndex id : nodes_.ids) mesh_.tip.push_back(global_.tip[id]);
    if (enriched_.empty()) return;
    mesh_.n_global_enriched = n_enriched_;
    for (std::size_t i = 0; i < nodes_.ids.size(); ++i) {
      const GlobalIndex id = nodes_.ids[i];
      const bool is_new = enriched_[id] >= 0;  // only the free node of tied nodes is numbered; it comes first
      mesh_.enriched.push_back(is_new                         ? static_cast<LocalIndex>(mesh_.enriched_id.size())
                               : id >= global_.n_free_nodes() ? mesh_.enriched[nodes_.local_of[global_.free_node(id)]]
                                                              : -1);
      if (!is_new) continue;
      mesh_.enriched_id.push_back(enriched_[id]);
      if (static_cast<LocalIndex>(i) < nodes_.n_owned) ++mesh_.n_owned_enriched;
    }
  }

  void fill_cells() {
    mesh_.n_owned_cells = cells_.n_owned;
    mesh_.cell_id = cells_.ids;
    for (auto* of_cell : {&mesh_.cell_owner, &mesh_.cell_region, &mesh_.cell_piece})
      of_cell->reserve(cells_.ids.size());
    mesh_.cells.reserve(nodes_per_cell_ * cells_.ids.size());
    for (GlobalIndex id : cells_.ids) {
      mesh_.cell_owner.push_back(part_[id]);
      mesh_.cell_region.push_back(global_.cell_region[id]);
      mesh_.cell_piece.push_back(pieces_.of_cell[id]);
      for (int k = 0; k < nodes_per_cell_; ++k) mesh_.cells.push_back(nodes_.local_of[node(id, k)]);
    }
  }

  void fill_fracture_faces() {
    std::vector<bool> is_local;
    std::vector<int> owner;
    for (const auto& face : global_.fracture_faces) {
      is_local.push_back(cells_.local_of[face.cell[minus]] >= 0 || cells_.local_of[face.cell[plus]] >= 0);
      owner.push_back(part_[face.cell[minus]]);
    }
    const auto faces = number(is_local, owner, rank_);
    mesh_.n_owned_fracture_faces = faces.n_owned;
    for (GlobalIndex id : faces.ids) mesh_.fracture_faces.push_back(fracture_face(id));
  }

  Mesh::FractureFace fracture_face(GlobalIndex id) const {
    const auto& global = global_.fracture_faces[id];
    const Vector area = area_vector(global_, global.cell[minus], global.local_face[minus]);
    Mesh::FractureFace face;
    face.id = id;
    face.fracture = global.fracture;
    face.single = global.single;
    face.local_face = global.local_face;
    face.corners = corners_of(global_, id);
    face.area = norm(area);
    face.centre = face_centre(global_, global.cell[minus], global.local_face[minus]);
    face.frame = face_frame(area, global_.dim());
    const auto nodes = coinciding_nodes(id);
    for (int side : {minus, plus}) {
      face.cell[side] = cells_.local_of[global.cell[side]];
      for (int k = 0; k < max_face_nodes; ++k)
        face.nodes[side][k] = face.cell[side] < 0 || nodes[side][k] < 0 ? -1 : nodes_.local_of[nodes[side][k]];
    }
    return face;
  }

  /// Global nodes of both sides of a fracture face, in the order of the minus cell's face. Throws an Error if the sides
  /// are more than 1e-8 of their size apart.
  std::array<std::array<GlobalIndex, max_face_nodes>, 2> coinciding_nodes(GlobalIndex id) const {
    const auto& face = global_.fracture_faces[id];
    const int n = n_face_nodes(global_.shape);
    const auto first = nodes_of_face(global_, face.cell[minus], face.local_face[minus]);
    const auto other = nodes_of_face(global_, face.cell[plus], face.local_face[plus]);
    std::array<std::array<GlobalIndex, max_face_nodes>, 2> result{first, first};
    const Real size = norm(point(global_, first[1]) - point(global_, first[0]));
    for (int k = 0; k < n; ++k) {
      const auto distance = [&](GlobalIndex b) { return norm(point(global_, b) - point(global_, first[k])); };
      result[plus][k] = *std::min_element(other.begin(), other.begin() + n,
                                          [&](GlobalIndex a, GlobalIndex b) { return distance(a) < distance(b); });
      SPREKK_CHECK(distance(result[plus][k]) <= 1e-8 * size,
                   "fracture \"{}\": the sides of face {} do not coincide: nodes {} and {} are {} m apart",
                   global_.fracture_names[face.fracture], id, first[k], result[plus][k], distance(result[plus][k]));
    }
    return result;
  }

  void fill_boundary_faces() {
    for (bool owned : {true, false})
      for (const auto& face : global_.boundary_faces)
        if (const LocalIndex cell = cells_.local_of[face.cell]; cell >= 0 && (cell < cells_.n_owned) == owned)
          mesh_.boundary_faces.push_back({face.boundary, cell, face.local_face, owned});
  }
};

/// Calls put(x) for each member of a mesh except communicator, facets and origin, which are set later. A new member
/// missing here causes a compile error.
template <class Members, class Put>
void for_members(Members& mesh, const Put& put) {
  auto& [comm, shape, n_owned_nodes, n_owned_cells, n_owned_fracture_faces, n_free_nodes, tied_to, node_id, cell_id,
         cell_owner, coordinates, cells, cell_region, cell_piece, fracture_faces, boundary_faces, region_names,
         boundary_names, fracture_names, single_fractures, n_global_nodes, n_global_cells, n_global_fracture_faces,
         n_pieces, tip, enriched, enriched_id, n_owned_enriched, n_global_enriched, partition, facets, origin] = mesh;
  const auto put_all = [&](auto&... members) { (put(members), ...); };
  put_all(shape, n_owned_nodes, n_owned_cells, n_owned_fracture_faces, n_free_nodes, tied_to, node_id, cell_id,
          cell_owner, coordinates, cells, cell_region, cell_piece, fracture_faces, boundary_faces, region_names,
          boundary_names, fracture_names, single_fractures, n_global_nodes, n_global_cells, n_global_fracture_faces,
          n_pieces, tip, enriched, enriched_id, n_owned_enriched, n_global_enriched, partition);
}

class Packer {
 public:
  std::vector<char> bytes;

  template <class T>
  void operator()(const T& value) {
    append(&value, 1);
  }
  template <class T>
  void operator()(const std::vector<T>& values) {
    (*this)(values.size());
    append(values.data(), values.size());
  }
  void operator()(const std::vector<std::string>& names) {
    (*this)(names.size());
    for (const auto& name : names) (*this)(std::vector<char>(name.begin(), name.end()));
  }
  void operator()(const std::vector<SingleFracture>& fractures) {
    (*this)(fractures.size());
    for (const auto& [name, set, properties] : fractures) {
      std::vector<std::string> texts = {name};
      for (const auto& [entry, value] : properties) texts.insert(texts.end(), {entry, value});
      (*this)(texts);
      (*this)(set);
    }
  }

 private:
  template <class T>
  void append(const T* values, std::size_t n) {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto* first = reinterpret_cast<const char*>(values);
    bytes.insert(bytes.end(), first, first + n * sizeof(T));
  }
};

/// Reads data in the order written by a Packer.
class Unpacker {
 public:
  explicit Unpacker(const std::vector<char>& bytes) : next_(bytes.data()) {}

  template <class T>
  void operator()(T& value) {
    take(&value, 1);
  }
  template <class T>
  void operator()(std::vector<T>& values) {
    values.resize(size());
    take(values.data(), values.size());
  }
  void operator()(std::vector<std::string>& names) {
    names.resize(size());
    for (auto& name : names) {
      name.resize(size());
      take(name.data(), name.size());
    }
  }
  void operator()(std::vector<SingleFracture>& fractures) {
    fractures.resize(size());
    for (auto& [name, set, properties] : fractures) {
      std::vector<std::string> texts;
      (*this)(texts);
      name = texts[0];
      for (std::size_t k = 1; k < texts.size(); k += 2) properties[texts[k]] = texts[k + 1];
      (*this)(set);
    }
  }

 private:
  const char* next_;

  std::size_t size() {
    std::size_t n = 0;
    take(&n, 1);
    return n;
  }
  template <class T>
  void take(T* values, std::size_t n) {
    std::copy_n(next_, n * sizeof(T), reinterpret_cast<char*>(values));
    next_ += n * sizeof(T);
  }
};

/// Sends bytes from rank 0 to another rank; both ranks call it. The data are divided, because MPI counts are int.
void transfer(const Comm& comm, int to, std::vector<char>& bytes) {
  constexpr long long piece = 1 << 30;
  const bool sends = comm.getRank() == 0;
  auto size = static_cast<long long>(bytes.size());
  const auto move = [&](int n, auto* data) {
    if (sends)
      Teuchos::send(comm, n, data, to);
    else
      Teuchos::receive(comm, 0, n, data);
  };
  move(1, &size);
  bytes.resize(size);
  for (long long start = 0; start < size; start += piece)
    move(static_cast<int>(std::min(piece, size - start)), bytes.data() + start);
}

/// Returns every rank's part of the mesh that prepare() makes on rank 0. The part of the last rank is sent first.
/// Collective.
RCP<const Mesh> scatter(const std::function<const GlobalMesh&()>& prepare, RCP<const Comm> comm) {
  const bool is_root = comm->getRank() == 0;
  std::vector<int> part;
  std::unique_ptr<Distributor> distributor;
  base::collectively(*comm, [&] {
    if (!is_root) return;
    const auto& mesh = prepare();
    part = partition(mesh, comm->getSize());
    distributor = std::make_unique<Distributor>(mesh, part, comm->getSize());
  });
  const auto result = rcp(new Mesh);
  for (int rank = comm->getSize() - 1; rank >= 0; --rank) {
    Packer packer;
    base::collectively(*comm, [&] {
      if (!is_root) return;
      *result = distributor->build(rank);
      if (rank > 0) for_members(*result, [&](const auto& member) { packer(member); });
    });
    if (rank == 0 || (!is_root && comm->getRank() != rank)) continue;
    transfer(*comm, rank, packer.bytes);
    Unpacker unpacker(packer.bytes);
    if (!is_root) for_members(*result, [&](auto& member) { unpacker(member); });
  }
  result->comm = comm;
  return result;
}

}  // namespace

RCP<const Mesh> distribute(const GlobalMesh& mesh, const std::vector<int>& part, RCP<const Comm> comm) {
  const auto result = rcp(new Mesh);
  base::collectively(*comm, [&] { *result = Distributor(mesh, part, comm->getSize()).build(comm->getRank()); });
  result->comm = comm;
  return result;
}

RCP<const Mesh> make_distributed(const GlobalMesh& mesh, RCP<const Comm> comm) {
  return scatter([&]() -> const GlobalMesh& { return mesh; }, comm);
}

RCP<const Mesh> make_distributed(const std::function<GlobalMesh()>& make, RCP<const Comm> comm) {
  GlobalMesh mesh;
  return scatter([&]() -> const GlobalMesh& { return mesh = make(); }, comm);
}

}  // namespace sprekk::mesh
