#include "assembly/free_motion.hpp"

#include "base/check.hpp"
#include "base/text.hpp"
#include "mesh/bodies.hpp"
#include "mesh/union_find.hpp"

#include <Teuchos_LAPACK.hpp>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace sprekk::assembly {

using mesh::GlobalMesh;
using mesh::Vector;
using mesh::operator+;
using mesh::operator-;
using mesh::operator*;

namespace {

using Row = std::array<Real, 6>;  // of the modes of one body: translations, then rotations times the body's size

/// The part of a motion that is below this, relative to its largest, is round-off. Eigenvalues are squares of it.
constexpr Real negligible = 1e-6;

struct Frame {
  Vector centre{};
  Real size = 0;  ///< largest extent
};

std::vector<Frame> frames(const GlobalMesh& mesh, const mesh::Bodies& bodies) {
  constexpr Real far = std::numeric_limits<Real>::max();
  std::vector<std::array<Vector, 2>> box(bodies.n(), {Vector{far, far, far}, Vector{-far, -far, -far}});
  const int n = mesh::n_nodes(mesh.shape);
  for (std::size_t k = 0; k < mesh.cells.size(); ++k) {
    auto& [lower, upper] = box[bodies.of_cell[k / n]];
    const Vector x = mesh::point(mesh, mesh.cells[k]);
    for (int i = 0; i < 3; ++i) {
      lower[i] = std::min(lower[i], x[i]);
      upper[i] = std::max(upper[i], x[i]);
    }
  }
  std::vector<Frame> result;
  for (const auto& [lower, upper] : box) {
    const Vector extent = upper - lower;
    result.push_back({0.5 * (lower + upper), *std::max_element(extent.begin(), extent.end())});
  }
  return result;
}

/// Sums of products of the rows of all constraints, by pairs of bodies that a constraint joins.
class Gram {
 public:
  using Block = std::array<Row, 6>;

  Gram(const GlobalMesh& mesh, const mesh::Bodies& bodies, const std::vector<DirichletCondition>& conditions)
      : mesh_(mesh), bodies_(bodies), frames_(frames(mesh, bodies)) {
    add_held(conditions);
    add_shared();
  }

  const std::vector<Frame>& body_frames() const { return frames_; }
  const std::map<std::pair<int, int>, Block>& blocks() const { return blocks_; }

 private:
  /// Component i of the displacement at a node under each mode of a body.
  Row row(int body, GlobalIndex node, int i) const {
    const auto& frame = frames_[body];
    const Vector arm = (1 / frame.size) * (mesh::point(mesh_, node) - frame.centre);
    Row result{};
    result[i] = 1;
    result[3 + (i + 1) % 3] = arm[(i + 2) % 3];  // (e_k x arm)_i
    result[3 + (i + 2) % 3] = -arm[(i + 1) % 3];
    return result;
  }

  void add(int body_a, const Row& a, int body_b, const Row& b, Real sign) {
    auto& block = blocks_[{body_a, body_b}];
    for (int k = 0; k < 6; ++k)
      for (int l = 0; l < 6; ++l) block[k][l] += sign * a[k] * b[l];
  }

  void add_held(const std::vector<DirichletCondition>& conditions) {
    for (const auto& condition : conditions) {
      if (condition.field != "displacement") continue;
      for (const auto& face : mesh_.boundary_faces) {
        if (face.boundary != condition.boundary ||
            (condition.region >= 0 && mesh_.cell_region[face.cell] != condition.region))
          continue;
        const int body = bodies_.of_cell[face.cell];
        const auto nodes = mesh::nodes_of_face(mesh_, face.cell, face.local_face);
        for (int k = 0; k < mesh::n_face_nodes(mesh_.shape); ++k)
          for (int i = 0; i < mesh_.dim(); ++i) {
            if (!condition.values[i]) continue;
            const Row held = row(body, nodes[k], i);
            add(body, held, body, held, 1);
          }
      }
    }
  }

  /// Ties, and bodies that touch in an edge or corner: wherever unknowns belong to two places or bodies.
  void add_shared() {
    const int n = mesh::n_nodes(mesh_.shape);
    std::vector<std::pair<int, GlobalIndex>> first(mesh_.n_free_nodes(), {-1, -1});
    for (std::size_t k = 0; k < mesh_.cells.size(); ++k) {
      const std::pair<int, GlobalIndex> here{bodies_.of_cell[k / n], mesh_.cells[k]};
      auto& other = first[mesh_.free_node(here.second)];
      if (other.first < 0) other = here;
      if (other == here) continue;
      for (int i = 0; i < mesh_.dim(); ++i) {
        const Row a = row(here.first, here.second, i), b = row(other.first, other.second, i);
        add(here.first, a, here.first, a, 1);
        add(here.first, a, other.first, b, -1);
        add(other.first, b, here.first, a, -1);
        add(other.first, b, other.first, b, 1);
      }
    }
  }

  const GlobalMesh& mesh_;
  const mesh::Bodies& bodies_;
  std::vector<Frame> frames_;
  std::map<std::pair<int, int>, Block> blocks_;
};

/// Vectors that span the null space of a symmetric, positive semi-definite n x n matrix.
std::vector<std::vector<Real>> null_space(std::vector<Real> matrix, int n) {
  std::vector<Real> eigenvalues(n), work(8 * n);
  int info = 0;
  Teuchos::LAPACK<int, Real>().SYEV('V', 'U', n, matrix.data(), n, eigenvalues.data(), work.data(), 8 * n, &info);
  SPREKK_CHECK(info == 0, "rigid motions: LAPACK's SYEV failed with {}", info);
  std::vector<std::vector<Real>> vectors;
  for (int k = 0; k < n && eigenvalues[k] <= negligible * negligible * eigenvalues[n - 1]; ++k)
    vectors.emplace_back(matrix.begin() + k * n, matrix.begin() + (k + 1) * n);
  return vectors;
}

/// Gauss-Jordan elimination with the largest pivots, first in columns for which `first` holds: so that motions come out
/// along coordinates where that is possible, and translations apart from rotations.
template <class First>
void reduce(std::vector<std::vector<Real>>& rows, const First& first) {
  std::size_t done = 0;
  for (bool wanted : {true, false})
    for (; done < rows.size(); ++done) {
      std::size_t pivot_row = done, pivot = 0;
      Real largest = 0;
      for (std::size_t r = done; r < rows.size(); ++r)
        for (std::size_t c = 0; c < rows[r].size(); ++c)
          if (first(c) == wanted && std::abs(rows[r][c]) > (1 + negligible) * largest) {
            largest = std::abs(rows[r][c]);
            pivot_row = r;
            pivot = c;
          }
      if (largest <= negligible) break;
      std::swap(rows[done], rows[pivot_row]);
      for (Real& value : rows[done]) value /= largest;
      if (rows[done][pivot] < 0)
        for (Real& value : rows[done]) value = -value;
      for (std::size_t r = 0; r < rows.size(); ++r) {
        const Real factor = rows[r][pivot];
        if (r == done) continue;
        for (std::size_t c = 0; c < rows[r].size(); ++c) rows[r][c] -= factor * rows[done][c];
      }
    }
}

/// A point or vector in words; components that are round-off next to `scale` are zero.
std::string text(const Vector& x, int dim, Real scale) {
  std::vector<std::string> components;
  for (int i = 0; i < dim; ++i)
    components.push_back(fmt::format("{:.6g}", std::abs(x[i]) > negligible * scale ? x[i] : 0));
  return fmt::format("({})", fmt::join(components, ", "));
}

}  // namespace

std::vector<FreeMotion> free_motions(const GlobalMesh& mesh, const std::vector<DirichletCondition>& conditions) {
  const auto bodies = mesh::find_bodies(mesh);
  const Gram gram(mesh, bodies, conditions);
  mesh::UnionFind joined(bodies.n());
  for (const auto& [pair, block] : gram.blocks()) joined.join(pair.first, pair.second);
  std::map<GlobalIndex, std::vector<int>> groups;
  for (int body = 0; body < bodies.n(); ++body) groups[joined.find(body)].push_back(body);
  const std::vector<int> modes = mesh.dim() == 2 ? std::vector<int>{0, 1, 5} : std::vector<int>{0, 1, 2, 3, 4, 5};
  const int m = static_cast<int>(modes.size());
  std::vector<FreeMotion> result;
  for (const auto& [first, members] : groups) {
    const int n = m * static_cast<int>(members.size());
    std::vector<Real> matrix(static_cast<std::size_t>(n) * n, 0);
    for (int k = 0; k < n; ++k)
      for (int l = 0; l < n; ++l)
        if (const auto found = gram.blocks().find({members[k / m], members[l / m]}); found != gram.blocks().end())
          matrix[k * n + l] = found->second[modes[k % m]][modes[l % m]];
    auto vectors = null_space(std::move(matrix), n);
    reduce(vectors, [&](std::size_t c) { return modes[c % m] >= 3; });
    for (std::size_t k = 0; k < members.size(); ++k)
      for (const auto& vector : vectors) {
        const auto& frame = gram.body_frames()[members[k]];
        FreeMotion motion{members[k], {}, {}, frame.centre};
        Real largest = 0;
        for (int c = 0; c < m; ++c) {
          const Real value = std::abs(vector[k * m + c]) > negligible ? vector[k * m + c] : 0;
          largest = std::max(largest, std::abs(value));
          (modes[c] < 3 ? motion.translation[modes[c]] : motion.rotation[modes[c] - 3]) =
              modes[c] < 3 ? value : value / frame.size;
        }
        if (largest > 0) result.push_back(motion);
      }
  }
  return result;
}

std::string to_text(const FreeMotion& motion, int dim) {
  const Vector &t = motion.translation, &w = motion.rotation;
  const Real speed = mesh::norm(t), turning = mesh::norm(w);
  if (turning == 0) return "can move along " + text((1 / speed) * t, dim, 1);
  const Vector axis = (1 / turning) * w, to_axis = (1 / turning) * mesh::cross(axis, t);
  const auto through = text(motion.centre + to_axis, dim, mesh::norm(motion.centre) + mesh::norm(to_axis));
  if (dim == 2) return "can rotate about " + through;
  const bool screws = std::abs(mesh::dot(axis, t)) > negligible * speed;
  return fmt::format("can rotate about the axis {} through {}{}", text(axis, dim, 1), through,
                     screws ? " while it moves along it" : "");
}

std::string unheld(const GlobalMesh& mesh, const std::vector<DirichletCondition>& conditions) {
  const auto motions = free_motions(mesh, conditions);
  if (motions.empty()) return "";
  const auto bodies = mesh::find_bodies(mesh);
  const int body = motions.front().body;
  const auto cell = std::find(bodies.of_cell.begin(), bodies.of_cell.end(), body) - bodies.of_cell.begin();
  std::vector<std::string> ways, regions;
  std::vector<char> has(mesh.region_names.size(), 0), moves(bodies.n(), 0);
  for (const auto& motion : motions) {
    moves[motion.body] = 1;
    if (motion.body == body) ways.push_back(to_text(motion, mesh.dim()));
  }
  for (GlobalIndex c = 0; c < mesh.n_cells(); ++c)
    if (bodies.of_cell[c] == body) has[mesh.cell_region[c]] = 1;
  for (std::size_t r = 0; r < has.size(); ++r)
    if (has[r]) regions.push_back(mesh.region_names[r]);
  Vector centre{};
  const int n_corners = mesh::n_corners(mesh.shape);
  for (int k = 0; k < n_corners; ++k)
    centre = centre + (1.0 / n_corners) * mesh::point(mesh, mesh.cells[cell * mesh::n_nodes(mesh.shape) + k]);
  const auto others = std::count(moves.begin(), moves.end(), 1) - 1;
  return fmt::format(
      "boundary conditions: nothing holds the rock of {} around {} ({} cells of {}){}: it {}. Contact holds a block "
      "only against others that are held; prescribe the displacements that are missing, in at least one direction on "
      "a boundary of it, or tie its sides by \"periodic\"",
      base::quoted_list(regions), text(centre, mesh.dim(), mesh::norm(centre)), bodies.n_cells[body], mesh.n_cells(),
      others > 0 ? fmt::format(" and {} more bodies", others) : "", fmt::join(ways, "; it "));
}

}  // namespace sprekk::assembly
