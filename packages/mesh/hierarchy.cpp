#include "mesh/hierarchy.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "base/check.hpp"
#include "mesh/facets.hpp"

namespace sprekk::mesh {
namespace {

/// Returns the map from cells to facets or back; facet i and lower-dimensional cell cells[i] share measures[i]. Rows
/// (average) or columns (integrate) are scaled to the sum 1.
Map scaled_map(const std::vector<GlobalIndex>& cells, const std::vector<Real>& measures, GlobalIndex n_cells,
               bool to_cells, bool rows) {
  const auto n_facets = static_cast<GlobalIndex>(cells.size());
  Map map{to_cells ? n_cells : n_facets, to_cells ? n_facets : n_cells, {}};
  std::vector<Real> sum(rows ? map.n_to : map.n_from);
  for (GlobalIndex i = 0; i < n_facets; ++i) {
    const auto entry = to_cells ? Map::Entry{cells[i], i, measures[i]} : Map::Entry{i, cells[i], measures[i]};
    sum[rows ? entry.to : entry.from] += measures[i];
    map.entries.push_back(entry);
  }
  for (auto& entry : map.entries) entry.weight /= sum[rows ? entry.to : entry.from];
  return map;
}

class HierarchyBuilder {
 public:
  explicit HierarchyBuilder(const GlobalMesh& mesh)
      : mesh_(mesh), dim_(mesh.dim()), n_fractures_(static_cast<int>(mesh.fracture_names.size())) {
    SPREKK_CHECK(mesh.fracture_faces.empty() || static_cast<GlobalIndex>(mesh.parent_node.size()) == mesh.n_nodes(),
                 "hierarchy: {} parent nodes for {} nodes; the mesh must come from split()", mesh.parent_node.size(),
                 mesh.n_nodes());
  }

  Hierarchy build() {
    add_bulk();
    add_fractures();
    find_ridges();
    find_tips();
    add_intersections();
    if (dim_ == 3) add_points();
    for (auto& interface : result_.interfaces) project(interface);
    return std::move(result_);
  }

 private:
  const GlobalMesh& mesh_;
  const int dim_, n_fractures_;
  Hierarchy result_;
  std::map<std::string, int> n_named_;
  std::vector<GlobalIndex> position_;                        ///< [fracture face] index in the cells of its fracture
  std::map<std::array<GlobalIndex, 2>, GlobalIndex> known_;  ///< number of the ridge with these nodes, sorted
  std::vector<int> line_of_;                                 ///< [ridge] subdomain of its intersection, or -1
  std::vector<std::vector<GlobalIndex>> lower_cells_;        ///< [interface][facet] coinciding cell

  int n_subdomains() const { return static_cast<int>(result_.subdomains.size()); }

  void add_bulk() {
    Subdomain bulk{"bulk", dim_, {}, {}, {}};
    for (GlobalIndex cell = 0; cell < mesh_.n_cells(); ++cell) {
      Real volume = 0;  // by the divergence theorem
      const Vector origin = face_centre(mesh_, cell, 0);
      for (int f = 0; f < n_faces(mesh_.shape); ++f)
        volume += dot(area_vector(mesh_, cell, f), face_centre(mesh_, cell, f) - origin) / dim_;
      bulk.cells.push_back(cell);
      bulk.measures.push_back(volume);
    }
    result_.subdomains.push_back(std::move(bulk));
  }

  void add_fractures() {
    for (int f = 0; f < n_fractures_; ++f) {
      n_named_[mesh_.fracture_names[f]] = 1;
      result_.subdomains.push_back({mesh_.fracture_names[f], dim_ - 1, {f}, {}, {}});
      for (Side side : {minus, plus}) add_interface(0, 1 + f, side);
    }
    for (std::size_t id = 0; id < mesh_.fracture_faces.size(); ++id) {
      const auto& face = mesh_.fracture_faces[id];
      auto& fracture = result_.subdomains[1 + face.fracture];
      const Real area = norm(area_vector(mesh_, face.cell[minus], face.local_face[minus]));
      for (int side : {minus, plus})
        add_facet(2 * face.fracture + side, {face.cell[side], face.local_face[side]}, fracture.n_cells(), area);
      position_.push_back(fracture.n_cells());
      fracture.cells.push_back(static_cast<GlobalIndex>(id));
      fracture.measures.push_back(area);
    }
  }

  int add_interface(int higher, int lower, std::optional<Side> side) {
    result_.interfaces.push_back({higher, lower, side, {}, {}, {}, {}});
    lower_cells_.emplace_back();
    return static_cast<int>(lower_cells_.size()) - 1;
  }

  void add_facet(int interface, Interface::Facet facet, GlobalIndex lower_cell, Real measure) {
    result_.interfaces[interface].facets.push_back(facet);
    result_.interfaces[interface].measures.push_back(measure);
    lower_cells_[interface].push_back(lower_cell);
  }

  void project(Interface& interface) const {
    const auto& cells = lower_cells_[&interface - result_.interfaces.data()];
    const auto map = [&](bool to_lower, bool rows) {
      return scaled_map(cells, interface.measures, result_.subdomains[interface.lower].n_cells(), to_lower, rows);
    };
    interface.to_lower = {map(true, true), map(true, false)};
    interface.to_higher = {map(false, true), map(false, false)};
  }

  /// Parent nodes of the ridge that starts at a corner of a face of a cell.
  std::array<GlobalIndex, 2> ridge_nodes(GlobalIndex cell, int local_face, int corner) const {
    const auto nodes = nodes_of_face(mesh_, cell, local_face);
    if (dim_ == 2) return {mesh_.parent_node[nodes[corner]], -1};
    return {mesh_.parent_node[nodes[corner]], mesh_.parent_node[nodes[(corner + 1) % n_face_corners(mesh_.shape)]]};
  }

  static std::array<GlobalIndex, 2> sorted(std::array<GlobalIndex, 2> nodes) {
    std::sort(nodes.begin(), nodes.end());
    return nodes;
  }

  void find_ridges() {
    for (std::size_t id = 0; id < mesh_.fracture_faces.size(); ++id)
      for (int corner = 0; corner < n_face_corners(mesh_.shape); ++corner) {
        const auto& face = mesh_.fracture_faces[id];
        const auto nodes = ridge_nodes(face.cell[minus], face.local_face[minus], corner);
        const auto [found, is_new] = known_.emplace(sorted(nodes), result_.ridges.size());
        if (is_new) result_.ridges.push_back({nodes, {}});
        result_.ridges[found->second].faces.push_back({static_cast<GlobalIndex>(id), corner});
      }
  }

  void find_tips() {
    result_.tips.resize(n_fractures_);
    if (n_fractures_ == 0) return;
    auto neighbour = face_neighbours(mesh_);
    const int faces_per_cell = n_faces(mesh_.shape);
    for (const auto& face : mesh_.fracture_faces)
      for (int side : {minus, plus}) neighbour[face.cell[side] * faces_per_cell + face.local_face[side]] = 0;
    std::vector<bool> on_boundary(result_.ridges.size(), false);
    for (std::size_t face = 0; face < neighbour.size(); ++face)
      for (int corner = 0; neighbour[face] < 0 && corner < n_face_corners(mesh_.shape); ++corner) {
        const auto nodes = ridge_nodes(face / faces_per_cell, static_cast<int>(face % faces_per_cell), corner);
        if (const auto found = known_.find(sorted(nodes)); found != known_.end()) on_boundary[found->second] = true;
      }
    for (std::size_t r = 0; r < result_.ridges.size(); ++r)
      if (const auto& faces = result_.ridges[r].faces; faces.size() == 1 && !on_boundary[r])
        result_.tips[mesh_.fracture_faces[faces[0].face].fracture].push_back(static_cast<GlobalIndex>(r));
  }

  std::set<int> fractures_at(GlobalIndex ridge) const {
    std::set<int> result;
    for (const auto& at : result_.ridges[ridge].faces) result.insert(mesh_.fracture_faces[at.face].fracture);
    return result;
  }

  int add_subdomain(int dimension, const std::set<int>& fractures) {
    std::vector<std::string> names;
    for (int f : fractures) names.push_back(mesh_.fracture_names[f]);
    auto name = fmt::format("{}", fmt::join(names, "*"));
    if (const int n = ++n_named_[name]; n > 1) name += fmt::format("#{}", n);
    result_.subdomains.push_back({name, dimension, {fractures.begin(), fractures.end()}, {}, {}});
    return n_subdomains() - 1;
  }

  void add_intersections() {
    std::map<std::set<int>, std::vector<GlobalIndex>> ridges_of;  // by sets of fractures
    for (std::size_t r = 0; r < result_.ridges.size(); ++r)
      if (const auto fractures = fractures_at(r); fractures.size() > 1)
        ridges_of[fractures].push_back(static_cast<GlobalIndex>(r));
    line_of_.assign(result_.ridges.size(), -1);
    for (const auto& [fractures, ridges] : ridges_of) {
      std::map<GlobalIndex, std::vector<GlobalIndex>> around;  // ridges at each node
      for (GlobalIndex r : ridges)
        for (GlobalIndex node : result_.ridges[r].nodes)
          if (node >= 0) around[node].push_back(r);
      for (GlobalIndex seed : ridges) {
        if (line_of_[seed] >= 0) continue;
        const int line = line_of_[seed] = add_subdomain(dim_ - 2, fractures);
        std::vector<GlobalIndex> piece{seed};
        for (std::size_t next = 0; next < piece.size(); ++next)
          for (GlobalIndex node : result_.ridges[piece[next]].nodes)
            for (GlobalIndex other : around[node])
              if (line_of_[other] < 0) line_of_[other] = line, piece.push_back(other);
        std::sort(piece.begin(), piece.end());
        fill_intersection(line, std::move(piece));
      }
    }
  }

  void fill_intersection(int index, std::vector<GlobalIndex> ridges) {
    auto& subdomain = result_.subdomains[index];
    std::map<int, int> interface_to;
    for (int f : subdomain.fractures) interface_to[f] = add_interface(1 + f, index, std::nullopt);
    for (GlobalIndex r : ridges) {
      const auto& [nodes, faces] = result_.ridges[r];
      const Real measure = dim_ == 2 ? 1 : norm(point(mesh_, nodes[1]) - point(mesh_, nodes[0]));
      for (const auto& at : faces)
        add_facet(interface_to.at(mesh_.fracture_faces[at.face].fracture), {position_[at.face], at.corner},
                  static_cast<GlobalIndex>(subdomain.measures.size()), measure);
      subdomain.measures.push_back(measure);
    }
    subdomain.cells = std::move(ridges);
  }

  void add_points() {
    struct End {
      int line, local;
      GlobalIndex cell;
    };
    struct Node {
      GlobalIndex id;
      std::vector<End> ends;  ///< edge ends of lines
    };
    std::vector<Node> nodes;  // in the order of the ridges
    std::map<GlobalIndex, std::size_t> known;
    std::vector<GlobalIndex> n_in_line(n_subdomains(), 0);
    for (std::size_t r = 0; r < result_.ridges.size(); ++r) {
      if (line_of_[r] < 0) continue;
      const GlobalIndex cell = n_in_line[line_of_[r]]++;
      for (int local : {0, 1}) {
        const auto [found, is_new] = known.emplace(result_.ridges[r].nodes[local], nodes.size());
        if (is_new) nodes.push_back({found->first, {}});
        nodes[found->second].ends.push_back({line_of_[r], local, cell});
      }
    }
    std::map<std::set<int>, std::vector<const Node*>> points_of;  // by sets of fractures
    for (const auto& node : nodes) {
      std::set<int> lines, fractures;
      for (const auto& end : node.ends) {
        const auto& meeting = result_.subdomains[end.line].fractures;
        lines.insert(end.line);
        fractures.insert(meeting.begin(), meeting.end());
      }
      if (lines.size() > 1) points_of[fractures].push_back(&node);
    }
    for (const auto& [fractures, points] : points_of)
      for (const auto* node : points) {
        const int index = add_subdomain(0, fractures);
        result_.subdomains[index].cells = {node->id};
        result_.subdomains[index].measures = {1};
        std::map<int, int> interface_to;
        for (const auto& end : node->ends) interface_to[end.line];
        for (auto& [line, interface] : interface_to) interface = add_interface(line, index, std::nullopt);
        for (const auto& end : node->ends) add_facet(interface_to[end.line], {end.cell, end.local}, 0, 1);
      }
  }
};

}  // namespace

Real Subdomain::measure() const { return std::accumulate(measures.begin(), measures.end(), Real{0}); }

std::vector<Real> Map::operator()(const std::vector<Real>& x) const {
  SPREKK_CHECK(static_cast<GlobalIndex>(x.size()) == n_from, "map: {} values; needs {}", x.size(), n_from);
  std::vector<Real> y(n_to);
  for (const auto& entry : entries) y[entry.to] += entry.weight * x[entry.from];
  return y;
}

int Hierarchy::count(int dimension) const {
  return static_cast<int>(std::count_if(subdomains.begin(), subdomains.end(),
                                        [&](const Subdomain& s) { return s.dimension == dimension; }));
}

Hierarchy make_hierarchy(const GlobalMesh& mesh) { return HierarchyBuilder(mesh).build(); }

}  // namespace sprekk::mesh
