#include "mesh/box.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "base/memory.hpp"
#include "base/parameters.hpp"
#include "base/text.hpp"
#include "mesh/periodic.hpp"
#include "mesh/raise_order.hpp"
#include "mesh/renumber.hpp"
#include "mesh/split.hpp"

namespace sprekk::mesh {
namespace {

constexpr Real max_blocks = 1e9;  // limit of the memory of one rank

using Lattice = std::array<int, 3>;  ///< point of the structured mesh; the last component is 0 in 2D
using Corners = std::vector<int>;    ///< corners of a square or cube; bit i set: upper end in direction i

constexpr std::array<const char*, 6> boundary_names{"west", "east", "south", "north", "bottom", "top"};
constexpr std::array<const char*, 4> cell_names{"triangle", "quadrilateral", "tetrahedron",
                                                "hexahedron"};  // in the order of Shape

Shape shape_of(const std::string& cell) {
  const auto found = std::find(cell_names.begin(), cell_names.end(), cell);
  SPREKK_CHECK(found != cell_names.end(), "box mesh: cell \"{}\": unknown; may be {}", cell,
               fmt::join(cell_names, ", "));
  return static_cast<Shape>(found - cell_names.begin());
}

/// Cells that fill one square or cube; `odd` selects the other diagonal of a square.
std::vector<Corners> cells_of_block(Shape shape, bool odd) {
  switch (shape) {
    case Shape::quadrilateral:
      return {{0, 1, 3, 2}};
    case Shape::triangle:
      return odd ? std::vector<Corners>{{0, 1, 2}, {1, 3, 2}} : std::vector<Corners>{{0, 1, 3}, {0, 3, 2}};
    case Shape::hexahedron:
      return {{0, 1, 3, 2, 4, 5, 7, 6}};
    default:
      return {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};
  }
}

/// Position of a fracture on the lattice.
struct Rectangle {
  Lattice lower, upper;
  int normal;
};

class BoxBuilder {
 public:
  explicit BoxBuilder(const BoxMesh& box) : box_(box), shape_(shape_of(box.cell)), dim_(dimension(shape_)) {
    check();
    for (int i = 0; i < dim_; ++i) n_blocks_[i] = box.cells[i];
    axis_ = rotation_axis();
    mesh_.shape = shape_;
    mesh_.region_names = {"bulk"};
    mesh_.boundary_names.assign(boundary_names.begin(), boundary_names.begin() + 2 * dim_);
  }

  /// Mistakes in the fractures, one text each.
  std::vector<std::string> defects() const {
    std::vector<std::string> errors;
    for (const auto& [name, fracture] : box_.fractures) try {
        rectangle(name, fracture);
        orientation(name, fracture);
      } catch (const Error& error) {
        errors.push_back(error.what());
      }
    return errors;
  }

  GlobalMesh build() {
    add_nodes(false);
    for (int k = 0; k < std::max(n_blocks_[2], 1); ++k)
      for (int j = 0; j < n_blocks_[1]; ++j)
        for (int i = 0; i < n_blocks_[0]; ++i) add_cells({i, j, k});
    mesh_.cell_region.assign(mesh_.cells.size() / n_nodes(shape_), 0);
    for (const auto& [name, region] : box_.regions) add_region(name, region);
    mesh_.coordinates.clear();
    add_nodes(true);
    add_boundaries();
    std::vector<MarkedFace> marked;
    std::vector<Orientation> orientations;
    for (const auto& [name, fracture] : box_.fractures) {
      mark(name, fracture, marked);
      mesh_.fracture_names.push_back(name);
      orientations.push_back(orientation(name, fracture));
    }
    if (box_.order == 2) mesh_ = raise_order(std::move(mesh_));
    return split(std::move(mesh_), marked, orientations);
  }

 private:
  const BoxMesh& box_;
  const Shape shape_;
  const int dim_;
  Lattice n_blocks_{};
  Vector axis_{};
  GlobalMesh mesh_;

  void check_length(const std::string& entry, std::size_t length) const {
    SPREKK_CHECK(static_cast<int>(length) == dim_, "box mesh: {}: has {}; cell \"{}\" needs {}", entry,
                 base::counted(length, "component"), box_.cell, dim_);
  }

  void check() const {
    check_length("lower corner", box_.lower_corner.size());
    check_length("upper corner", box_.upper_corner.size());
    check_length("cells", box_.cells.size());
    for (int i = 0; i < dim_; ++i) {
      SPREKK_CHECK(box_.lower_corner[i] < box_.upper_corner[i],
                   "box mesh: upper corner: {} in direction {}; must exceed the lower corner's {}",
                   box_.upper_corner[i], "xyz"[i], box_.lower_corner[i]);
      SPREKK_CHECK(box_.cells[i] > 0, "box mesh: cells: {} in direction {}; must be positive", box_.cells[i], "xyz"[i]);
    }
    const Real blocks = std::accumulate(box_.cells.begin(), box_.cells.end(), Real{1}, std::multiplies<Real>());
    SPREKK_CHECK(blocks <= max_blocks, "box mesh: cells: {{{}}} makes {:.3g} {}, may make {:.0g}",
                 fmt::join(box_.cells, ", "), blocks, dim_ == 2 ? "squares" : "cubes", max_blocks);
    const Real cells = blocks * static_cast<Real>(cells_of_block(shape_, false).size()),
               minimum = sizeof(GlobalIndex) * n_nodes(shape_) * cells + sizeof(Real) * dim_ * blocks;
    SPREKK_CHECK(minimum <= base::memory_limit(),
                 "box mesh: cells: {{{}}} makes {:.3g} cells, which alone take {:.3g} GB; there are {:.3g} GB: take "
                 "fewer, and \"refinements\", which each rank makes for its own part",
                 fmt::join(box_.cells, ", "), cells, minimum / 1e9, base::memory_limit() / 1e9);
  }

  Real block_size(int i) const { return (box_.upper_corner[i] - box_.lower_corner[i]) / n_blocks_[i]; }
  Real plane(int i, int index) const { return box_.lower_corner[i] + index * block_size(i); }

  GlobalIndex node(const Lattice& p) const {
    return p[0] + (n_blocks_[0] + GlobalIndex{1}) * (p[1] + (n_blocks_[1] + GlobalIndex{1}) * p[2]);
  }

  Lattice lattice(GlobalIndex node) const {
    const GlobalIndex nx = n_blocks_[0] + 1, ny = n_blocks_[1] + 1;
    return {static_cast<int>(node % nx), static_cast<int>(node / nx % ny), static_cast<int>(node / (nx * ny))};
  }

  /// Unit vector of the rotation axis.
  Vector rotation_axis() const {
    if (dim_ == 2) return {0, 0, 1};
    check_length("rotation axis", box_.rotation_axis.size());
    const Vector axis{box_.rotation_axis[0], box_.rotation_axis[1], box_.rotation_axis[2]};
    SPREKK_CHECK(norm(axis) > 0, "box mesh: rotation axis: is zero; needs a direction");
    return (1 / norm(axis)) * axis;
  }

  /// Rotated vector, by Rodrigues' formula.
  Vector rotated(const Vector& v) const {
    if (box_.rotation == 0) return v;
    const Real angle = box_.rotation * M_PI / 180, c = std::cos(angle), s = std::sin(angle);
    return c * v + s * cross(axis_, v) + ((1 - c) * dot(axis_, v)) * axis_;
  }

  void add_nodes(bool turned) {
    const GlobalIndex n = node(n_blocks_) + 1;
    for (GlobalIndex id = 0; id < n; ++id) {
      const auto p = lattice(id);
      Vector x{};
      for (int i = 0; i < dim_; ++i) x[i] = plane(i, p[i]);
      if (turned) x = rotated(x);
      mesh_.coordinates.insert(mesh_.coordinates.end(), x.begin(), x.begin() + dim_);
    }
  }

  void add_cells(const Lattice& block) {
    for (const auto& corners : cells_of_block(shape_, (block[0] + block[1]) % 2 == 1))
      for (int corner : corners)
        mesh_.cells.push_back(node({block[0] + (corner & 1), block[1] + (corner >> 1 & 1), block[2] + (corner >> 2)}));
  }

  /// Assigns cells to a region; requires coordinates before the rotation.
  void add_region(const std::string& name, const BoxMesh::Region& region) {
    check_length(fmt::format("region \"{}\": lower corner", name), region.lower_corner.size());
    check_length(fmt::format("region \"{}\": upper corner", name), region.upper_corner.size());
    mesh_.region_names.push_back(name);
    const int per_cell = n_nodes(shape_);
    bool any = false;
    for (GlobalIndex cell = 0; cell < mesh_.n_cells(); ++cell) {
      bool inside = true;
      for (int i = 0; i < dim_; ++i) {
        Real centre = 0;
        for (int k = 0; k < per_cell; ++k)
          centre += mesh_.coordinates[mesh_.cells[cell * per_cell + k] * dim_ + i] / per_cell;
        inside = inside && region.lower_corner[i] < centre && centre < region.upper_corner[i];
      }
      if (inside) mesh_.cell_region[cell] = static_cast<int>(mesh_.region_names.size()) - 1;
      any = any || inside;
    }
    SPREKK_CHECK(any, "region \"{}\": has no cell between its lower and its upper corner", name);
  }

  /// Returns true if all nodes of a face of a cell lie in a lattice box.
  bool is_inside(GlobalIndex cell, int local_face, const Lattice& lower, const Lattice& upper) const {
    for (GlobalIndex node : nodes_of_face(mesh_, cell, local_face)) {
      if (node < 0) continue;
      const auto p = lattice(node);
      for (int i = 0; i < dim_; ++i)
        if (p[i] < lower[i] || p[i] > upper[i]) return false;
    }
    return true;
  }

  /// Calls use(cell, local face) for the faces on a lattice rectangle. The cells are below it; at the lower end of the
  /// box they are above it.
  template <class Use>
  void for_faces(const Lattice& lower, const Lattice& upper, int normal, const Use& use) const {
    const GlobalIndex cells_per_block = static_cast<GlobalIndex>(cells_of_block(shape_, false).size());
    Lattice last = upper, first = lower;
    first[normal] = std::max(lower[normal] - 1, 0);
    last[normal] = first[normal] + 1;
    if (dim_ == 2) last[2] = 1;
    for (int k = first[2]; k < last[2]; ++k)
      for (int j = first[1]; j < last[1]; ++j)
        for (int i = first[0]; i < last[0]; ++i) {
          const GlobalIndex block =
              i + static_cast<GlobalIndex>(n_blocks_[0]) * (j + static_cast<GlobalIndex>(n_blocks_[1]) * k);
          for (GlobalIndex cell = block * cells_per_block; cell < (block + 1) * cells_per_block; ++cell)
            for (int face = 0; face < n_faces(shape_); ++face)
              if (is_inside(cell, face, lower, upper)) use(cell, face);
        }
  }

  void add_boundaries() {
    for (int i = 0; i < dim_; ++i)
      for (int end : {0, 1}) {
        Lattice lower{}, upper = n_blocks_;
        lower[i] = upper[i] = end * n_blocks_[i];
        for_faces(lower, upper, i, [&](GlobalIndex cell, int face) {
          mesh_.boundary_faces.push_back({2 * i + end, cell, face});
        });
      }
  }

  /// Index of the mesh plane at a coordinate of a fracture. Throws an Error if the coordinate is not on a mesh plane.
  int plane_index(const std::string& fracture, int i, Real x) const {
    const Real position = (x - box_.lower_corner[i]) / block_size(i), index = std::round(position);
    const int below = std::clamp(static_cast<int>(std::floor(position)), 0, n_blocks_[i] - 1);
    SPREKK_CHECK(std::abs(position - index) < 1e-6 && index >= 0 && index <= n_blocks_[i],
                 "fracture \"{}\": {} = {} is on no mesh plane; the nearest are {} and {}", fracture, "xyz"[i], x,
                 plane(i, below), plane(i, below + 1));
    return static_cast<int>(index);
  }

  Rectangle rectangle(const std::string& name, const BoxMesh::Fracture& fracture) const {
    check_length(fmt::format("fracture \"{}\": lower corner", name), fracture.lower_corner.size());
    check_length(fmt::format("fracture \"{}\": upper corner", name), fracture.upper_corner.size());
    Lattice lower{}, upper{};
    int normal = -1, n_normals = 0;
    for (int i = 0; i < dim_; ++i) {
      lower[i] = plane_index(name, i, fracture.lower_corner[i]);
      upper[i] = plane_index(name, i, fracture.upper_corner[i]);
      SPREKK_CHECK(lower[i] <= upper[i], "fracture \"{}\": its upper corner {} is below its lower corner {} in {}",
                   name, fracture.upper_corner[i], fracture.lower_corner[i], "xyz"[i]);
      if (lower[i] == upper[i]) normal = i, ++n_normals;
    }
    SPREKK_CHECK(n_normals == 1,
                 "fracture \"{}\": its corners ({}) and ({}) agree in {} directions; they must agree in one", name,
                 fmt::join(fracture.lower_corner, ", "), fmt::join(fracture.upper_corner, ", "), n_normals);
    SPREKK_CHECK(lower[normal] > 0 && lower[normal] < n_blocks_[normal],
                 "fracture \"{}\": has no interior face: {} = {} is the {} boundary", name, "xyz"[normal],
                 fracture.lower_corner[normal], boundary_names[2 * normal + (lower[normal] > 0)]);
    return {lower, upper, normal};
  }

  void mark(const std::string& name, const BoxMesh::Fracture& fracture, std::vector<MarkedFace>& marked) const {
    const auto [lower, upper, normal] = rectangle(name, fracture);
    const int index = static_cast<int>(mesh_.fracture_names.size());
    for_faces(lower, upper, normal, [&](GlobalIndex cell, int face) { marked.push_back({index, cell, face}); });
  }

  Orientation orientation(const std::string& name, const BoxMesh::Fracture& fracture) const {
    Orientation result{std::nullopt, fracture.swap_sides};
    if (!fracture.reference_normal) return result;
    check_length(fmt::format("fracture \"{}\": reference normal", name), fracture.reference_normal->size());
    Vector reference{};
    std::copy_n(fracture.reference_normal->begin(), dim_, reference.begin());
    result.reference = rotated(reference);
    return result;
  }
};

/// Mistakes in a box that are detectable without a mesh.
std::vector<std::string> defects(const BoxMesh& box) {
  try {
    return BoxBuilder(box).defects();
  } catch (const Error& error) {
    return {error.what()};
  }
}

}  // namespace

void BoxMesh::Fracture::describe(base::Section& s) {
  s.required(lower_corner, "lower corner", "m", base::any(), "lowest coordinates before the rotation, on mesh planes");
  s.required(upper_corner, "upper corner", "m", base::any(),
             "highest coordinates before the rotation; equal to the lower corner in the direction of the normal and "
             "only there");
  s.entry(reference_normal, "reference normal", "-",
          "reference vector of the orientation, which turns with the box: its product with the normal, from side - to "
          "side +, is positive; absent: the last nonzero component (z, y, x) of the rotated normal is positive");
  s.entry(swap_sides, "swap sides", "-", "exchange of side - and side +");
}

void BoxMesh::Region::describe(base::Section& s) {
  s.required(lower_corner, "lower corner", "m", base::any(), "lowest coordinates before the rotation");
  s.required(upper_corner, "upper corner", "m", base::any(), "highest coordinates before the rotation");
}

void describe_periodic(base::Section& s, std::vector<std::string>& periodic, const std::string& meaning) {
  s.entry(periodic, "periodic", "-", meaning);
  auto sorted = periodic;
  std::sort(sorted.begin(), sorted.end());
  const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
  if (twice != sorted.end()) s.fail("periodic", fmt::format("has \"{}\" twice", base::shortened(*twice)));
}

void describe_refinements(base::Section& s, int& refinements, const std::vector<std::string>& periodic) {
  s.entry(refinements, "refinements", "-", base::between(0, 20),
          "number of uniform refinements, each into 4 (2D) or 8 (3D) cells per cell, by all ranks in parallel after "
          "the distribution of the mesh; for meshes larger than the memory of one rank");
  if (refinements > 0 && !periodic.empty())
    s.fail("refinements",
           fmt::format("is {}, must be 0 with \"periodic\"; make the cells smaller instead", refinements));
}

void describe_tips(base::Section& s, std::string& tips) {
  s.choice(tips, "tips", {"enriched", "plain"},
           "treatment of crack tips; enriched: node fields grow with the square root of the distance from the tip, "
           "by further unknowns at order 1, by quarter-point nodes at order 2 (Barsoum 1976); plain: no enrichment");
}

void BoxMesh::describe(base::Section& s) {
  s.required_choice(cell, "cell", {cell_names.begin(), cell_names.end()}, "shape of the cells");
  s.required(lower_corner, "lower corner", "m", base::any(),
             "lowest coordinates before the rotation; 2 or 3 elements, the dimension of the box");
  s.required(upper_corner, "upper corner", "m", base::any(), "highest coordinates before the rotation");
  s.required(cells, "cells", "-", base::at_least(1),
             "number of squares or cubes per direction; a square contains 2 triangles, a cube 6 tetrahedra");
  s.entry(order, "order", "-", base::between(1, 2),
          "polynomial order of the node fields in each cell: 1 (linear) or 2 (quadratic)");
  describe_tips(s, tips);
  s.named_sections(regions, "regions", "boxes of cells with their own material");
  s.named_sections(fractures, "fractures", "plane fractures along mesh planes");
  s.entry(rotation, "rotation", "degree", base::between(-360, 360),
          "rotation angle of the box, counter-clockwise about the origin");
  s.entry(rotation_axis, "rotation axis", "-", base::any().size(3), "axis of the rotation in 3D, through the origin");
  describe_periodic(
      s, periodic, "directions of periodicity (x, y, z before the rotation), with equal node fields on opposite sides");
  describe_refinements(s, refinements, periodic);
  s.entry(renumbering_seed, "renumbering seed", "-", base::at_least(0),
          "seed of a random order of nodes and cells; absent: regular order");
  if (!s.complete()) return;
  for (const auto& defect : defects(*this)) s.fail(defect);
}

GlobalMesh make_box(const BoxMesh& box) {
  auto mesh = BoxBuilder(box).build();
  if (box.renumbering_seed) mesh = renumbered(mesh, *box.renumbering_seed);
  std::vector<std::pair<std::string, std::string>> sides;
  for (const auto& direction : box.periodic) {
    const auto axis = std::string("xyz").substr(0, mesh.dim()).find(direction);
    SPREKK_CHECK(direction.size() == 1 && axis != std::string::npos, "box mesh: periodic: is \"{}\", must be {}",
                 direction, mesh.dim() == 2 ? "x or y" : "x, y or z");
    sides.emplace_back(boundary_names[2 * axis], boundary_names[2 * axis + 1]);
  }
  return tie_periodic(mesh, sides);
}

}  // namespace sprekk::mesh
