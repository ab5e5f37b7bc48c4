#include "mesh/msh_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <tuple>
#include <unordered_map>
#include <unordered_set>

#include "base/check.hpp"
#include "base/text.hpp"
#include "mesh/cell_geometry.hpp"
#include "mesh/face_groups.hpp"
#include "mesh/msh_file.hpp"
#include "mesh/raise_order.hpp"

namespace sprekk::mesh {
namespace {

using Element = MshFile::Element;

std::string text(const Vector& x) { return fmt::format("({:.9g}, {:.9g}, {:.9g})", x[0], x[1], x[2]); }

class MshBuilder {
 public:
  MshBuilder(const MshFile& msh, const std::string& file, const MshOptions& options)
      : msh_(msh), file_(file), options_(options) {}

  GlobalMesh build() {
    choose_shape();
    add_cells();
    add_nodes();
    check_cells();
    neighbour_ = neighbours();
    check_faces();
    name_fractures();
    name_single_fractures();
    add_faces();
    set_order();
    std::vector<Orientation> orientations;
    for (const auto& [name, orientation] : options_.fractures) orientations.push_back(orientation);
    try {
      return split(std::move(mesh_), marked_, orientations);
    } catch (const Error& error) {
      fail("{}", error.what());
    }
  }

 private:
  const MshFile& msh_;
  const std::string& file_;
  const MshOptions& options_;
  GlobalMesh mesh_;
  Real size_ = 0;                                        ///< diagonal of the bounding box, m
  std::vector<const Element*> cell_;                     ///< [cell]
  std::vector<GlobalIndex> node_of_point_;               ///< [point of the file] node, or -1 if dropped
  std::vector<GlobalIndex> neighbour_;                   ///< see face_neighbours()
  std::vector<MarkedFace> marked_;                       ///< of the fractures
  std::map<std::pair<int, int>, int> single_of_entity_;  ///< by group and entity; index into single_fractures
  std::vector<int> whole_;                               ///< [fracture] its only single fracture; -1 if it has several
  InnerFaces inner_;

  template <class... Arguments>
  [[noreturn]] void fail(fmt::format_string<Arguments...> message, Arguments&&... arguments) const {
    throw Error(file_ + ": " + fmt::format(message, std::forward<Arguments>(arguments)...));
  }

  GlobalIndex node(const Element& element, int k) const { return msh_.element_nodes[element.first_node + k]; }

  void choose_shape() {
    const auto highest = std::max_element(msh_.elements.begin(), msh_.elements.end(),
                                          [](const auto& a, const auto& b) { return a.type->dim < b.type->dim; });
    const auto* type = highest->type;
    if (!type->shape)
      fail("has elements of dimension {} at most; needs triangles, quadrilaterals, tetrahedra or hexahedra", type->dim);
    mesh_.shape = *type->shape;
    for (const auto& element : msh_.elements) {
      if (element.type->dim != type->dim) continue;
      if (element.type != type)
        fail("element {} is a {} and element {} a {}; all cells must have one shape", highest->tag, type->name,
             element.tag, element.type->name);
      cell_.push_back(&element);
    }
  }

  void add_cells() {
    const int dim = mesh_.dim();
    std::unordered_set<GlobalIndex> tags;
    for (const auto* cell : cell_)
      if (!tags.insert(cell->tag).second) fail("element {} occurs twice", cell->tag);
    const auto order = nodes_in_msh(mesh_.shape);
    const auto has_region = [&](const Element* cell) { return !msh_.group_sets[cell->groups].empty(); };
    const bool has_regions = std::any_of(cell_.begin(), cell_.end(), has_region);
    if (!has_regions) mesh_.region_names = {"bulk"};
    const auto region_of_set = regions_of_sets();
    for (const auto* cell : cell_) {
      const auto& groups = msh_.group_sets[cell->groups];
      if (has_regions && groups.empty())
        fail("element {} is in no physical group although others are; each cell needs a region", cell->tag);
      const int region = region_of_set[cell->groups];
      if (!groups.empty() && region < 0)
        fail(
            "element {} is in the physical groups \"{}\" and \"{}\", of which none is a part of the other; a cell has "
            "one region",
            cell->tag, msh_.group_name(dim, groups[0]), msh_.group_name(dim, groups[1]));
      mesh_.cell_region.push_back(groups.empty() ? 0 : index_of(msh_.group_name(dim, region), mesh_.region_names));
      for (int k : order) mesh_.cells.push_back(node(*cell, k));
      auto nodes = std::vector<GlobalIndex>(mesh_.cells.end() - order.size(), mesh_.cells.end());
      std::sort(nodes.begin(), nodes.end());
      const auto twice = std::adjacent_find(nodes.begin(), nodes.end());
      if (twice != nodes.end()) fail("element {} has node {} twice", cell->tag, msh_.node_tags[*twice]);
    }
  }

  /// Returns for each set of groups the group that is the region of its cells, or -1. It is the group contained in all
  /// others of the set; among equal groups the first. Groups without a name are only considered if none of the set has
  /// a name.
  std::vector<int> regions_of_sets() const {
    std::map<int, std::set<int>> sets_of_group;  // sets that contain cells
    for (const auto* cell : cell_)
      for (const int group : msh_.group_sets[cell->groups]) sets_of_group[group].insert(cell->groups);
    const auto has_name = [&](int group) { return msh_.group_names.count({mesh_.dim(), group}) > 0; };
    const auto is_part = [&](int a, int b) {
      const auto &of_a = sets_of_group[a], &of_b = sets_of_group[b];
      return std::includes(of_b.begin(), of_b.end(), of_a.begin(), of_a.end());
    };
    std::vector<int> regions;
    for (auto groups : msh_.group_sets) {
      if (std::any_of(groups.begin(), groups.end(), has_name))
        groups.erase(std::remove_if(groups.begin(), groups.end(), std::not_fn(has_name)), groups.end());
      const auto found = std::find_if(groups.begin(), groups.end(), [&](int a) {
        return std::all_of(groups.begin(), groups.end(), [&](int b) { return is_part(a, b); });
      });
      regions.push_back(found == groups.end() ? -1 : *found);
    }
    return regions;
  }

  /// Returns the index of a name; appends new names.
  static int index_of(const std::string& name, std::vector<std::string>& names) {
    const auto found = std::find(names.begin(), names.end(), name);
    const auto index = static_cast<int>(found - names.begin());
    if (found == names.end()) names.push_back(name);
    return index;
  }

  /// Adds the points of the cells as nodes. Before this call, mesh_.cells contains indices into the points of the file.
  void add_nodes() {
    const int dim = mesh_.dim();
    std::vector<GlobalIndex> index(msh_.points.size(), -1);
    for (GlobalIndex node : mesh_.cells) index[node] = 0;
    Vector lower = msh_.points[mesh_.cells[0]], upper = lower;
    for (std::size_t k = 0; k < index.size(); ++k) {
      if (index[k] < 0) continue;
      const Vector& x = msh_.points[k];
      index[k] = mesh_.n_nodes();
      mesh_.coordinates.insert(mesh_.coordinates.end(), x.begin(), x.begin() + dim);
      for (int i = 0; i < 3; ++i) lower[i] = std::min(lower[i], x[i]), upper[i] = std::max(upper[i], x[i]);
    }
    for (GlobalIndex& node : mesh_.cells) node = index[node];
    size_ = norm(upper - lower);
    if (dim == 2 && upper[2] - lower[2] > 1e-9 * size_)
      fail("is a surface with z from {} to {}; a mesh of dimension 2 must lie in a plane of constant z", lower[2],
           upper[2]);
    node_of_point_ = std::move(index);
  }

  void check_cells() {
    const CellGeometry geometry(mesh_.shape);
    const auto mirrored = mirrored_nodes(mesh_.shape);
    const int n = n_nodes(mesh_.shape);
    for (GlobalIndex cell = 0; cell < mesh_.n_cells(); ++cell) {
      const auto [minimum, largest] = geometry.scaled_jacobian(mesh_, cell);
      const auto where = [&] { return text(point(mesh_, mesh_.cells[cell * n])); };
      constexpr Real flat = 1e-10;
      if (std::max(std::abs(minimum), std::abs(largest)) <= flat)
        fail("element {} at {} has no volume", cell_[cell]->tag, where());
      if (minimum <= flat && largest >= -flat)
        fail(
            "element {} at {} is twisted or not convex: its scaled Jacobian is {:.3g} at one corner and {:.3g} at "
            "another",
            cell_[cell]->tag, where(), minimum, largest);
      if (largest > 0) continue;
      const std::vector<GlobalIndex> nodes(&mesh_.cells[cell * n], &mesh_.cells[cell * n] + n);
      for (int k = 0; k < n; ++k) mesh_.cells[cell * n + k] = nodes[mirrored[k]];
    }
  }

  SortedCorners corners_of_face(GlobalIndex face) const {
    const int n = n_faces(mesh_.shape);
    return sorted_corners(mesh_, face / n, static_cast<int>(face % n));
  }

  Vector centre(GlobalIndex face) const {
    return face_centre(mesh_, face / n_faces(mesh_.shape), static_cast<int>(face % n_faces(mesh_.shape)));
  }
  const Element& cell_at(GlobalIndex face) const { return *cell_[face / n_faces(mesh_.shape)]; }

  std::vector<GlobalIndex> neighbours() const {
    try {
      return face_neighbours(mesh_);
    } catch (const Error&) {
      std::map<SortedCorners, std::vector<GlobalIndex>> faces;
      for (GlobalIndex face = 0; face < mesh_.n_cells() * n_faces(mesh_.shape); ++face) {
        auto& same = faces[corners_of_face(face)];
        same.push_back(face);
        if (same.size() == 3)
          fail("elements {}, {} and {} share the face at {}; at most two may", cell_at(same[0]).tag,
               cell_at(same[1]).tag, cell_at(same[2]).tag, text(centre(face)));
      }
      throw;
    }
  }

  /// Checks faces. Adjacent cells must lie on opposite sides of their common face with the same nodes. Free faces must
  /// not touch each other.
  void check_faces() const {
    const int n = n_faces(mesh_.shape);
    const auto local = [&](GlobalIndex face) { return static_cast<int>(face % n); };
    std::vector<GlobalIndex> free_faces;
    for (GlobalIndex face = 0; face < static_cast<GlobalIndex>(neighbour_.size()); ++face) {
      const GlobalIndex other = neighbour_[face];
      if (other < 0) free_faces.push_back(face);
      if (other < face) continue;
      if (dot(area_vector(mesh_, face / n, local(face)), area_vector(mesh_, other / n, local(other))) >= 0)
        fail("elements {} and {} lie on the same side of the face that they share at {}; cells must not overlap",
             cell_at(face).tag, cell_at(other).tag, text(centre(face)));
      auto nodes = nodes_of_face(mesh_, face / n, local(face)), others = nodes_of_face(mesh_, other / n, local(other));
      std::sort(nodes.begin(), nodes.end());
      std::sort(others.begin(), others.end());
      if (nodes != others)
        fail("elements {} and {} have the same corners but not the same nodes on their common face at {}",
             cell_at(face).tag, cell_at(other).tag, text(centre(face)));
    }
    check_free(free_faces);
  }

  /// Checks that no centre of a free face lies on another free face. Otherwise, two parts of the mesh touch without
  /// common nodes, or one has nodes within the faces of the other. Candidates are found by sorting along an oblique
  /// direction.
  void check_free(const std::vector<GlobalIndex>& faces) const {
    const Vector along{0.6127, 0.5431, 0.5741};  // parallel to no axis, because many faces would have equal values
    const int n = n_faces(mesh_.shape);
    struct Centre {
      Real along;
      GlobalIndex face;
      Vector x;
    };
    std::vector<Centre> centres;
    for (GlobalIndex face : faces) {
      const auto x = centre(face);
      centres.push_back({dot(along, x), face, x});
    }
    std::sort(centres.begin(), centres.end(),
              [](const auto& a, const auto& b) { return std::tie(a.along, a.face) < std::tie(b.along, b.face); });
    for (GlobalIndex face : faces) {
      const auto corners = corner_points(face);
      const Vector middle = centre(face), area = area_vector(mesh_, face / n, static_cast<int>(face % n));
      const Vector normal = (1 / norm(area)) * area;
      Real lowest = dot(along, corners[0]), highest = lowest;
      for (const auto& x : corners)
        lowest = std::min(lowest, dot(along, x)), highest = std::max(highest, dot(along, x));
      auto other = std::lower_bound(centres.begin(), centres.end(), lowest - 1e-8 * size_,
                                    [](const Centre& a, Real value) { return a.along < value; });
      for (; other != centres.end() && other->along <= highest + 1e-8 * size_; ++other) {
        if (other->face == face || !lies_on(corners, middle, normal, other->x)) continue;
        fail(
            "elements {} and {} touch at {} without sharing nodes; join them (gmsh: Coherence, BooleanFragments), also "
            "where a fracture is to be, as Sprekk opens it",
            cell_at(std::min(face, other->face)).tag, cell_at(std::max(face, other->face)).tag, text(other->x));
      }
    }
  }

  std::vector<Vector> corner_points(GlobalIndex face) const {
    const int n = n_faces(mesh_.shape);
    const auto nodes = nodes_of_face(mesh_, face / n, static_cast<int>(face % n));
    std::vector<Vector> points;
    for (int k = 0; k < n_face_corners(mesh_.shape); ++k) points.push_back(point(mesh_, nodes[k]));
    return points;
  }

  /// Returns true if x lies on the face with the given corners, including its edges.
  bool lies_on(const std::vector<Vector>& corners, const Vector& middle, const Vector& normal, const Vector& x) const {
    const Real tolerance = 1e-8 * size_;
    if (std::abs(dot(normal, x - middle)) > tolerance) return false;
    const std::size_t n = corners.size();
    for (std::size_t k = 0; k < n; ++k) {
      const Vector edge = corners[(k + 1) % n] - corners[k], from = x - corners[k];
      // 2D: between both ends; 3D: on the inner side of every edge
      if (n == 2 ? dot(edge, from) < -tolerance * norm(edge) : dot(cross(edge, from), normal) < -tolerance * norm(edge))
        return false;
    }
    return true;
  }

  /// Sets the names of the fractures. Throws an Error if a name is not a group of faces.
  void name_fractures() {
    const int dim = mesh_.dim() - 1;
    std::vector<std::string> names;
    for (const auto& element : msh_.elements)
      if (element.type->dim == dim)
        for (int group : msh_.group_sets[element.groups]) index_of(msh_.group_name(dim, group), names);
    for (const auto& [name, orientation] : options_.fractures) {
      mesh_.fracture_names.push_back(name);
      if (std::find(names.begin(), names.end(), name) != names.end()) continue;
      for (const auto& [key, known] : msh_.group_names)
        if (known == name)
          fail("fracture \"{}\": the physical group has dimension {}{}", name, key.first,
               key.first == dim ? " and no elements (gmsh drops groups where it saves all elements)"
                                : fmt::format("; a fracture in this mesh has dimension {}", dim));
      fail("fracture \"{}\": unknown; the physical groups of dimension {} are {}{}", name, dim,
           names.empty() ? "none" : base::quoted_list(names), base::did_you_mean(name, names));
    }
  }

  /// Sets the single fractures from the lines of the file. A set without lines is one single fracture. If the file has
  /// no such line, split() sets them.
  void name_single_fractures() {
    if (msh_.fractures.empty()) return;
    std::map<std::string, std::vector<const MshFile::Fracture*>> of_set;
    for (const auto& fracture : msh_.fractures)
      of_set[msh_.group_name(mesh_.dim() - 1, fracture.group)].push_back(&fracture);
    auto& singles = mesh_.single_fractures;
    std::map<std::string, int> known;
    for (int set = 0; set < static_cast<int>(mesh_.fracture_names.size()); ++set) {
      const auto& name_of_set = mesh_.fracture_names[set];
      for (const auto* fracture : of_set[name_of_set]) {
        const auto [found, is_new] = known.emplace(fracture->name, static_cast<int>(singles.size()));
        if (is_new) singles.push_back({fracture->name, set, fracture->properties});
        const auto& one = singles[found->second];
        if (one.set != set)
          fail("$Fractures: \"{}\" is in the sets \"{}\" and \"{}\"; fractures of two sets need two names", one.name,
               mesh_.fracture_names[one.set], name_of_set);
        if (one.properties != fracture->properties)
          fail("$Fractures: \"{}\" occurs twice with different entries; one name is one fracture", one.name);
        single_of_entity_[{fracture->group, fracture->entity}] = found->second;
      }
      whole_.push_back(of_set[name_of_set].empty() ? static_cast<int>(singles.size()) : -1);
      if (of_set[name_of_set].empty()) singles.push_back({name_of_set, set});
    }
  }

  int single_of(const Element& element, int set) const {
    if (msh_.fractures.empty()) return set;
    for (int group : msh_.group_sets[element.groups])
      if (const auto found = single_of_entity_.find({group, element.entity}); found != single_of_entity_.end())
        return found->second;
    if (whole_[set] < 0)
      fail("element {}: its entity {} is no fracture of the set \"{}\" in $Fractures", element.tag, element.entity,
           mesh_.fracture_names[set]);
    return whole_[set];
  }

  std::optional<SortedCorners> corners(const Element& element) const {
    SortedCorners key{-1, -1, -1, -1};
    for (int k = 0; k < element.type->n_corners; ++k) {
      key[k] = node_of_point_[node(element, k)];
      if (key[k] < 0) return std::nullopt;
    }
    std::sort(key.begin(), key.begin() + element.type->n_corners);
    return key;
  }

  /// Finds the cell face of every element in a group of dimension d - 1.
  void add_faces() {
    std::unordered_map<SortedCorners, GlobalIndex, SortedCornersHash> face_at;
    for (const auto& element : msh_.elements)
      if (is_grouped_face(element))
        if (const auto key = corners(element)) face_at.emplace(*key, -1);
    for (GlobalIndex face = 0; face < static_cast<GlobalIndex>(neighbour_.size()) && !face_at.empty(); ++face) {
      const auto found = face_at.find(corners_of_face(face));
      if (found != face_at.end() && found->second < 0) found->second = face;
    }
    std::set<std::pair<GlobalIndex, std::string>> known;
    for (const auto& element : msh_.elements) {
      if (!is_grouped_face(element)) continue;
      const auto key = corners(element);
      const GlobalIndex face = key ? face_at.at(*key) : -1;
      for (int number : msh_.group_sets[element.groups]) {
        const auto name = msh_.group_name(mesh_.dim() - 1, number);
        if (face < 0)
          fail(
              "element {} at {} of the physical group \"{}\" is no face of a cell; the mesh must conform to it (gmsh: "
              "Curve or Surface {{...}} In, BooleanFragments)",
              element.tag, text(msh_.points[node(element, 0)]), name);
        if (known.emplace(face, name).second) add_face(element, face, name);
      }
    }
    const auto wrong = wrong_fractures(inner_, mesh_.fracture_names, mesh_.boundary_names);
    if (!wrong.empty()) fail("{}", wrong);
  }

  bool is_grouped_face(const Element& element) const {
    return element.type->dim == mesh_.dim() - 1 && !msh_.group_sets[element.groups].empty();
  }

  void add_face(const Element& element, GlobalIndex face, const std::string& name) {
    const GlobalIndex cell = face / n_faces(mesh_.shape);
    const int local_face = static_cast<int>(face % n_faces(mesh_.shape));
    const auto& fractures = mesh_.fracture_names;
    const auto fracture = std::find(fractures.begin(), fractures.end(), name);
    const auto where = [&] { return text(centre(face)); };
    if (neighbour_[face] >= 0) {
      const auto [inner, is_new] = inner_.try_emplace(face);
      if (is_new) inner->second.element = fmt::format("element {} at {}", element.tag, where());
      inner->second.groups.insert(name);
    }
    if (fracture == fractures.end()) {
      if (neighbour_[face] < 0)
        mesh_.boundary_faces.push_back({index_of(name, mesh_.boundary_names), cell, local_face});
      return;
    }
    if (neighbour_[face] < 0)
      fail(
          "element {} at {} of the fracture \"{}\" lies on the boundary of the mesh; a fracture needs cells on both "
          "sides",
          element.tag, where(), name);
    const auto index = static_cast<int>(fracture - fractures.begin());
    marked_.push_back({index, cell, local_face, single_of(element, index)});
  }

  void set_order() {
    const int have = order(mesh_.shape), wanted = options_.order.value_or(have);
    if (wanted < have) fail("has cells of order {}; the scene requires order {}", have, wanted);
    if (wanted > have) mesh_ = raise_order(std::move(mesh_));
  }
};

}  // namespace

GlobalMesh parse_msh(std::string_view text, const std::string& file, const MshOptions& options) {
  return MshBuilder(parse_msh_file(text, file), file, options).build();
}

GlobalMesh read_msh(const std::string& path, const MshOptions& options) {
  return MshBuilder(read_msh_file(path), path, options).build();
}

}  // namespace sprekk::mesh
