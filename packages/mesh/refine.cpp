#include "mesh/refine.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_set>

#include "base/check.hpp"
#include "base/memory.hpp"
#include "mesh/facets.hpp"
#include "mesh/number_facets.hpp"
#include "mesh/raise_order.hpp"
#include "mesh/subdivision.hpp"

namespace sprekk::mesh {
namespace {

/// Divides cells of order 2 into cells of order 1 with the same nodes.
class Divider {
 public:
  explicit Divider(const Mesh& mesh)
      : mesh_(mesh), shape_(linear(mesh.shape)), division_(subdivision(shape_)), ridges_(ridge_ids(mesh)) {}

  RCP<Mesh> divide() {
    choose_children();
    choose_nodes();
    fill_totals();
    fill_nodes();
    fill_cells();
    fill_fracture_faces();
    fill_boundary_faces();
    return result_;
  }

 private:
  using Part = Subdivision::Part;

  const Mesh& mesh_;
  const Shape shape_;
  const Subdivision division_;
  const std::vector<GlobalIndex> ridges_;  // [fracture face * n_face_corners + k] see ridge_ids()
  std::vector<LocalIndex> child_;  // [cell * n_children + k] number of the child; -1 for ghosts no longer required
  std::vector<LocalIndex> node_;   // [node] new number; -1 for ghosts no longer required
  RCP<Mesh> result_ = rcp(new Mesh);

  int n_children() const { return division_.n_children(); }
  LocalIndex node(LocalIndex cell, int k) const { return mesh_.cells[cell * mesh_.nodes_per_cell() + k]; }
  LocalIndex child(LocalIndex cell, int k) const { return cell < 0 ? -1 : child_[cell * n_children() + k]; }

  /// Calls use(node) for the corners of a child.
  template <class Use>
  void for_corners(LocalIndex cell, int child, const Use& use) const {
    for (int i = 0; i < n_corners(shape_); ++i) use(node(cell, division_.children[child][i]));
  }

  /// Part of a side of a fracture face at corner k of side minus, or the inner part.
  const Part& part(const Mesh::FractureFace& face, int side, int k) const {
    int corner = k;
    if (k < n_face_corners(shape_) && face.cell[side] >= 0)  // else only the child's number is used
      for (corner = 0; node(face.cell[side], face_nodes(shape_)[face.local_face[side]][corner]) != face.nodes[side][k];)
        SPREKK_CHECK(++corner < n_face_corners(shape_), "mesh: a corner of fracture face {} is none of its cell",
                     face.id);
    return division_.of_face[face.local_face[side]][corner];
  }

  /// Selects the owned children, those that share a node with them, and those on the opposite side of owned fracture
  /// faces.
  void choose_children() {
    std::vector<bool> is_near(mesh_.n_nodes(), false);
    for (LocalIndex i = 0; i < mesh_.n_owned_cells * mesh_.nodes_per_cell(); ++i) is_near[mesh_.cells[i]] = true;
    child_.assign(mesh_.n_cells() * n_children(), -1);
    for (LocalIndex cell = 0; cell < mesh_.n_cells(); ++cell)
      for (int c = 0; c < n_children(); ++c)
        for_corners(cell, c, [&](LocalIndex node) {
          if (is_near[node]) child_[cell * n_children() + c] = 0;
        });
    for (LocalIndex f = 0; f < mesh_.n_owned_fracture_faces; ++f) {
      const auto& face = mesh_.fracture_faces[f];
      for (int k = 0; k < division_.n_parts(); ++k)
        child_[face.cell[plus] * n_children() + part(face, plus, k).child] = 0;
    }
    choose_around_points();
    LocalIndex n = 0;
    for (LocalIndex& number : child_)
      if (number >= 0) number = n++;
  }

  /// Selects the minus-side children of parts that share a point with a part of an owned face: a corner of the face, or
  /// the middle of a ridge.
  void choose_around_points() {
    const int n = n_face_corners(shape_);
    const std::unordered_set<GlobalIndex> ridges(ridges_.begin(),
                                                 ridges_.begin() + std::ptrdiff_t(n) * mesh_.n_owned_fracture_faces);
    std::unordered_set<GlobalIndex> points;
    for (LocalIndex f = 0; f < mesh_.n_owned_fracture_faces; ++f)
      points.insert(mesh_.fracture_faces[f].corners.begin(), mesh_.fracture_faces[f].corners.begin() + n);
    for (LocalIndex f = 0; f < mesh_.n_fracture_faces(); ++f) {
      const auto& face = mesh_.fracture_faces[f];
      if (face.cell[minus] < 0) continue;
      const auto choose = [&](int k) { child_[face.cell[minus] * n_children() + part(face, minus, k).child] = 0; };
      for (int k = 0; k < n; ++k) {
        if (points.count(face.corners[k])) choose(k);
        if (dimension(shape_) == 2 || !ridges.count(ridges_[f * n + k])) continue;
        choose(k);
        choose((k + 1) % n);
        for (int inner = n; inner < division_.n_parts(); ++inner) choose(inner);
      }
    }
  }

  void choose_nodes() {
    node_.assign(mesh_.n_nodes(), -1);
    for (LocalIndex cell = 0; cell < mesh_.n_cells(); ++cell)
      for (int c = 0; c < n_children(); ++c)
        if (child(cell, c) >= 0) for_corners(cell, c, [&](LocalIndex node) { node_[node] = 0; });
    LocalIndex n = 0;
    for (LocalIndex& number : node_)
      if (number >= 0) number = n++;
  }

  void fill_totals() {
    const int cells = n_children(), faces = division_.n_parts();
    auto& r = *result_;
    r.comm = mesh_.comm;
    r.shape = shape_;
    r.region_names = mesh_.region_names;
    r.boundary_names = mesh_.boundary_names;
    r.fracture_names = mesh_.fracture_names;
    r.single_fractures = mesh_.single_fractures;
    r.n_owned_nodes = mesh_.n_owned_nodes;
    r.n_owned_cells = mesh_.n_owned_cells * cells;
    r.n_owned_fracture_faces = mesh_.n_owned_fracture_faces * faces;
    r.n_global_nodes = mesh_.n_global_nodes;
    r.n_global_cells = mesh_.n_global_cells * cells;
    r.n_global_fracture_faces = mesh_.n_global_fracture_faces * faces;
    r.n_pieces = mesh_.n_pieces;
    r.partition = mesh_.partition;
    for (int i : {0, 1}) {
      r.partition.cells[i] *= cells;
      r.partition.fracture_faces[i] *= faces;
    }
    r.partition.edge_cut *= faces;
    r.partition.separated_faces *= faces;
  }

  void fill_nodes() {
    const int dim = mesh_.dim();
    for (LocalIndex node = 0; node < mesh_.n_nodes(); ++node) {
      if (node_[node] < 0) continue;
      result_->node_id.push_back(mesh_.node_id[node]);
      const auto x = mesh_.coordinates.begin() + node * dim;
      result_->coordinates.insert(result_->coordinates.end(), x, x + dim);
    }
    result_->n_free_nodes = result_->n_nodes();
  }

  void fill_cells() {
    for (LocalIndex cell = 0; cell < mesh_.n_cells(); ++cell)
      for (int c = 0; c < n_children(); ++c) {
        if (child(cell, c) < 0) continue;
        result_->cell_id.push_back(mesh_.cell_id[cell] * n_children() + c);
        result_->cell_owner.push_back(mesh_.cell_owner[cell]);
        result_->cell_region.push_back(mesh_.cell_region[cell]);
        result_->cell_piece.push_back(mesh_.cell_piece[cell]);
        for_corners(cell, c, [&](LocalIndex node) { result_->cells.push_back(node_[node]); });
      }
  }

  void fill_fracture_faces() {
    for (const auto& face : mesh_.fracture_faces)
      for (int k = 0; k < division_.n_parts(); ++k) {
        const std::array<const Part*, 2> parts{&part(face, minus, k), &part(face, plus, k)};
        const std::array<LocalIndex, 2> cells{child(face.cell[minus], parts[minus]->child),
                                              child(face.cell[plus], parts[plus]->child)};
        if (cells[minus] >= 0 || cells[plus] >= 0) add_fracture_face(face, k, parts, cells);
      }
  }

  /// Adds a part of a fracture face. Corners have the order of the part on side minus.
  void add_fracture_face(const Mesh::FractureFace& parent, int k, const std::array<const Part*, 2>& parts,
                         const std::array<LocalIndex, 2>& cells) {
    Mesh::FractureFace face;
    face.id = parent.id * division_.n_parts() + k;
    face.fracture = parent.fracture;
    face.single = parent.single;
    face.cell = cells;
    face.corners.fill(-1);
    for (int i = 0; i < n_face_corners(shape_); ++i) face.corners[i] = point(parent, parts[minus]->nodes[i]);
    FaceCorners corners{{}, n_face_corners(shape_)};
    for (int side : {minus, plus}) {
      face.local_face[side] = parts[side]->local_face;
      face.nodes[side].fill(-1);
      for (int i = 0; i < corners.n && cells[side] >= 0; ++i) {
        const LocalIndex node = parent.nodes[side][parts[minus]->nodes[i]];
        face.nodes[side][i] = node_[node];
        std::copy_n(&mesh_.coordinates[node * mesh_.dim()], mesh_.dim(), corners.x[i].begin());
      }
    }
    const Vector area = area_vector(corners);
    face.area = norm(area);
    face.centre = face_centre(corners);
    face.frame = face_frame(area, mesh_.dim());
    result_->fracture_faces.push_back(face);
  }

  /// Number of the point at a node of a face of order 2: corner, edge midpoint, or interior.
  GlobalIndex point(const Mesh::FractureFace& face, int node) const {
    const int n = n_face_corners(shape_);
    if (node < n) return face.corners[node];
    if (dimension(shape_) == 2 || node == 2 * n) return mesh_.n_global_nodes + face.id;
    const auto f = &face - mesh_.fracture_faces.data();
    return mesh_.n_global_nodes + mesh_.n_global_fracture_faces + ridges_[f * n + node - n];
  }

  void fill_boundary_faces() {
    for (const auto& face : mesh_.boundary_faces)
      for (const Part& part : division_.of_face[face.local_face])
        if (const LocalIndex cell = child(face.cell, part.child); cell >= 0)
          result_->boundary_faces.push_back({face.boundary, cell, part.local_face, face.owned});
  }
};

/// Largest sum of squared edges of the inner children of a tetrahedron with the given corners, m^2.
Real worst_inside(const std::array<Vector, 4>& x) {
  const auto division = subdivision(Shape::tetrahedron);
  const auto middle = [&](int a, int b) { return 0.5 * (x[a] + x[b]); };
  const std::array<Vector, 10> nodes{x[0],         x[1],         x[2],         x[3],         middle(0, 1),
                                     middle(1, 2), middle(0, 2), middle(0, 3), middle(1, 3), middle(2, 3)};
  Real worst = 0;
  for (int child = n_corners(Shape::tetrahedron); child < division.n_children(); ++child) {
    Real sum = 0;
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < a; ++b) {
        const Vector edge = nodes[division.children[child][a]] - nodes[division.children[child][b]];
        sum += dot(edge, edge);
      }
    worst = std::max(worst, sum);
  }
  return worst;
}

/// Throws an Error if the refined mesh exceeds the range of the indices or the memory of a rank. Collective.
void check_size(const Mesh& mesh, int times) {
  const Real factor = std::pow(subdivision(mesh.shape).n_children(), times),
             nodes_per_cell = n_nodes(quadratic(mesh.shape)), here = factor * static_cast<Real>(mesh.n_cells()),
             all = factor * static_cast<Real>(mesh.n_global_cells),
             max_here = static_cast<Real>(std::numeric_limits<LocalIndex>::max()) / nodes_per_cell,
             maximum = static_cast<Real>(std::numeric_limits<GlobalIndex>::max()) / nodes_per_cell;
  base::collectively(*mesh.comm, [&] {
    SPREKK_CHECK(
        here <= max_here && all <= maximum,
        "refinements: {} make {:.3g} cells of {}; of these rank {} would hold {:.3g} with its ghosts, may hold "
        "{:.3g}; take fewer, or more ranks",
        times, all, mesh.n_global_cells, mesh.comm->getRank(), here, max_here);
    const Real minimum = here * sizeof(LocalIndex) * n_nodes(mesh.shape);
    SPREKK_CHECK(minimum <= base::memory_limit(),
                 "refinements: {} make {:.3g} cells of {}; of these rank {} would hold {:.3g} with its ghosts, which "
                 "alone take {:.3g} GB; there are {:.3g} GB: take fewer, or more machines",
                 times, all, mesh.n_global_cells, mesh.comm->getRank(), here, minimum / 1e9,
                 base::memory_limit() / 1e9);
  });
}

}  // namespace

void turn_for_refinement(GlobalMesh& mesh) {
  if (mesh.shape != Shape::tetrahedron) return;
  constexpr std::array<std::array<int, 4>, 3> turns{{{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}}};
  std::vector<char> turn(mesh.n_cells(), 0);
  for (GlobalIndex cell = 0; cell < mesh.n_cells(); ++cell) {
    std::array<GlobalIndex, 4> corners;
    std::copy_n(&mesh.cells[4 * cell], 4, corners.begin());
    Real best = std::numeric_limits<Real>::infinity();
    for (int t = 0; t < 3; ++t) {
      std::array<Vector, 4> x;
      for (int k = 0; k < 4; ++k) x[k] = point(mesh, corners[turns[t][k]]);
      const Real here = worst_inside(x);
      if (!(here < (1 - 1e-10) * best)) continue;  // among equal values up to rounding the first is used
      best = here;
      turn[cell] = static_cast<char>(t);
    }
    for (int k = 0; k < 4; ++k) mesh.cells[4 * cell + k] = corners[turns[turn[cell]][k]];
  }
  const auto turned = [&](GlobalIndex cell, int face) {  // face k is opposite to corner k
    const auto& order = turns[turn[cell]];
    return static_cast<int>(std::find(order.begin(), order.end(), face) - order.begin());
  };
  for (auto& face : mesh.fracture_faces)
    for (int side : {minus, plus}) face.local_face[side] = turned(face.cell[side], face.local_face[side]);
  for (auto& face : mesh.boundary_faces) face.local_face = turned(face.cell, face.local_face);
}

RCP<Mesh> refined(const Mesh& mesh, int times) {
  check_size(mesh, times);
  const auto once = [](const Mesh& coarse) { return Divider(*raise_order(coarse)).divide(); };
  auto result = once(mesh);
  for (int k = 1; k < times; ++k) result = once(*result);
  return result;
}

}  // namespace sprekk::mesh
