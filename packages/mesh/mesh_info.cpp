#include "mesh/mesh_info.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>

#include "base/check.hpp"
#include "mesh/cell_geometry.hpp"

namespace sprekk::mesh {
namespace {

using Ridge = std::array<GlobalIndex, 2>;  ///< parent nodes of its corners, sorted; in 2D twice the same

std::vector<MeshInfo::Part> parts(const std::vector<std::string>& names) {
  std::vector<MeshInfo::Part> result;
  for (const auto& name : names) result.push_back({name, 0, 0});
  return result;
}

void add(MeshInfo::Part& part, Real measure) {
  ++part.n;
  part.measure += measure;
}

/// Calls use(ridge) for the ridges around a face of a cell. Ridges consist of nodes before splitting.
template <class Use>
void for_ridges(const GlobalMesh& mesh, GlobalIndex cell, int local_face, const Use& use) {
  const int n = n_face_corners(mesh.shape);
  const auto nodes = nodes_of_face(mesh, cell, local_face);
  const auto parent = [&](int k) { return mesh.parent_node.empty() ? nodes[k] : mesh.parent_node[nodes[k]]; };
  for (int k = 0; k < n; ++k) {
    const auto a = parent(k), b = n == 2 ? a : parent((k + 1) % n);
    use(Ridge{std::min(a, b), std::max(a, b)});
  }
}

/// Ridges of fractures on the boundary faces of the mesh; sides of fractures are no boundary faces.
std::set<Ridge> boundary_ridges(const GlobalMesh& mesh, const std::map<Ridge, std::vector<int>>& of_fractures) {
  const int per_cell = n_faces(mesh.shape);
  const auto neighbour = face_neighbours(mesh);
  std::vector<bool> is_side(neighbour.size(), false);
  for (const auto& face : mesh.fracture_faces)
    for (int side : {minus, plus}) is_side[face.cell[side] * per_cell + face.local_face[side]] = true;
  std::set<Ridge> result;
  for (GlobalIndex face = 0; face < static_cast<GlobalIndex>(neighbour.size()); ++face)
    if (neighbour[face] < 0 && !is_side[face])
      for_ridges(mesh, face / per_cell, static_cast<int>(face % per_cell), [&](const Ridge& ridge) {
        if (of_fractures.count(ridge)) result.insert(ridge);
      });
  return result;
}

void describe_fractures(const GlobalMesh& mesh, MeshInfo& info) {
  std::map<Ridge, std::vector<int>> fractures_at;
  for (const auto& face : mesh.fracture_faces) {
    add(info.fractures[face.fracture], norm(area_vector(mesh, face.cell[minus], face.local_face[minus])));
    for_ridges(mesh, face.cell[minus], face.local_face[minus],
               [&](const Ridge& ridge) { fractures_at[ridge].push_back(face.fracture); });
  }
  const auto on_boundary = boundary_ridges(mesh, fractures_at);
  std::set<GlobalIndex> tip_nodes;
  std::map<GlobalIndex, int> n_lines_at;
  for (const auto& [ridge, fractures] : fractures_at) {
    if (fractures.size() == 1 && !on_boundary.count(ridge)) {
      ++info.n_tips;
      tip_nodes.insert(ridge.begin(), ridge.end());
    }
    if (fractures.size() > 2 || fractures.front() != fractures.back()) {
      ++info.n_intersections;
      for (GlobalIndex node : ridge) ++n_lines_at[node];
    }
  }
  info.n_tip_nodes = static_cast<GlobalIndex>(tip_nodes.size());
  info.n_intersection_points = mesh.dim() == 2 ? info.n_intersections
                                               : std::count_if(n_lines_at.begin(), n_lines_at.end(),
                                                               [](const auto& entry) { return entry.second > 2; });
  for (std::size_t node = 0; node < mesh.parent_node.size(); ++node)
    if (mesh.parent_node[node] != static_cast<GlobalIndex>(node)) ++info.n_copies;
}

void describe_cells(const GlobalMesh& mesh, MeshInfo& info) {
  const CellGeometry geometry(mesh.shape);
  const int n = n_nodes(mesh.shape);
  info.shortest_edge = std::numeric_limits<Real>::infinity();
  info.smallest_scaled_jacobian = std::numeric_limits<Real>::infinity();
  for (GlobalIndex cell = 0; cell < mesh.n_cells(); ++cell) {
    add(info.regions[mesh.cell_region[cell]], geometry.volume(mesh, cell));
    Real shortest = std::numeric_limits<Real>::infinity(), longest = 0;
    for (const auto& edge : geometry.edges()) {
      const Real length =
          norm(point(mesh, mesh.cells[cell * n + edge.to]) - point(mesh, mesh.cells[cell * n + edge.from]));
      shortest = std::min(shortest, length);
      longest = std::max(longest, length);
      info.mean_edge += length;
    }
    info.shortest_edge = std::min(info.shortest_edge, shortest);
    info.longest_edge = std::max(info.longest_edge, longest);
    if (longest / shortest > info.largest_edge_ratio) {
      info.largest_edge_ratio = longest / shortest;
      info.cell_of_largest_edge_ratio = cell;
    }
    const Real jacobian = geometry.scaled_jacobian(mesh, cell)[0];
    if (jacobian < info.smallest_scaled_jacobian) {
      info.smallest_scaled_jacobian = jacobian;
      info.cell_of_smallest_scaled_jacobian = cell;
    }
  }
  info.mean_edge /= static_cast<Real>(mesh.n_cells() * static_cast<GlobalIndex>(geometry.edges().size()));
}

const char* name_of(Shape shape) {
  constexpr const char* names[] = {"triangles", "quadrilaterals", "tetrahedra", "hexahedra"};
  return names[static_cast<int>(linear(shape))];
}

}  // namespace

MeshInfo describe(const GlobalMesh& mesh) {
  SPREKK_CHECK(mesh.n_cells() > 0, "mesh: has no cells");
  MeshInfo info;
  info.shape = mesh.shape;
  info.n_cells = mesh.n_cells();
  info.n_nodes = mesh.n_nodes();
  info.n_fracture_faces = static_cast<GlobalIndex>(mesh.fracture_faces.size());
  info.regions = parts(mesh.region_names);
  info.boundaries = parts(mesh.boundary_names);
  info.fractures = parts(mesh.fracture_names);
  for (const auto& face : mesh.boundary_faces)
    add(info.boundaries[face.boundary], norm(area_vector(mesh, face.cell, face.local_face)));
  describe_cells(mesh, info);
  describe_fractures(mesh, info);
  info.n_of_nodes = mesh.dim() * info.n_nodes;
  info.n_of_bubbles = 2 * mesh.dim() * info.n_fracture_faces;
  info.n_of_faces = mesh.dim() * info.n_fracture_faces;
  return info;
}

std::string to_text(const MeshInfo& info) {
  const bool flat = dimension(info.shape) == 2;
  std::string text =
      fmt::format("cells         {} {} of order {}\nnodes         {}, {} of them copies along fractures\n",
                  info.n_cells, name_of(info.shape), order(info.shape), info.n_nodes, info.n_copies);
  const auto list = [&](const char* kind, const std::vector<MeshInfo::Part>& parts, const char* items,
                        const char* measure) {
    for (const auto& part : parts)
      text += fmt::format("{:<13} \"{}\": {} {}, {} {:.6g}\n", kind, part.name, part.n, items, measure, part.measure);
  };
  list("region", info.regions, "cells", flat ? "area" : "volume");
  list("boundary", info.boundaries, "faces", flat ? "length" : "area");
  list("fracture", info.fractures, "faces", flat ? "length" : "area");
  if (flat)
    text += fmt::format("tips          {} points\nintersections {} points\n", info.n_tips, info.n_intersections);
  else
    text += fmt::format("tips          {} edges with {} corners\nintersections {} edges, which meet in {} points\n",
                        info.n_tips, info.n_tip_nodes, info.n_intersections, info.n_intersection_points);
  text += fmt::format("edges         {:.6g} to {:.6g}, mean {:.6g}\n", info.shortest_edge, info.longest_edge,
                      info.mean_edge);
  text += fmt::format(
      "quality       largest ratio of edges {:.4g} in cell {}, smallest scaled Jacobian {:.4g} in cell {}\n",
      info.largest_edge_ratio, info.cell_of_largest_edge_ratio, info.smallest_scaled_jacobian,
      info.cell_of_smallest_scaled_jacobian);
  return text + fmt::format("vectors       {} components at nodes, {} at bubbles, {} on fracture faces\n",
                            info.n_of_nodes, info.n_of_bubbles, info.n_of_faces);
}

}  // namespace sprekk::mesh
