#include "assembly/free_motion.hpp"

#include "base/check.hpp"
#include "base/text.hpp"
#include "mesh/bodies.hpp"
#include "mesh/union_find.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace sprekk::assembly {

using contact::add_product;
using contact::negligible;
using contact::null_space;
using contact::reduce;
using contact::rigid_modes;
using contact::rigid_row;
using contact::RigidBlock;
using contact::RigidFrame;
using contact::RigidRow;
using contact::to_text;

using mesh::GlobalMesh;
using mesh::Vector;
using mesh::operator+;
using mesh::operator-;
using mesh::operator*;

namespace {

std::vector<RigidFrame> frames(const GlobalMesh& mesh, const mesh::Bodies& bodies) {
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
  std::vector<RigidFrame> result;
  for (const auto& [lower, upper] : box) {
    const Vector extent = upper - lower;
    result.push_back({0.5 * (lower + upper), *std::max_element(extent.begin(), extent.end())});
  }
  return result;
}

/// Sums of products of constraint rows, for each pair of bodies with a common constraint.
class Gram {
 public:
  Gram(const GlobalMesh& mesh, const mesh::Bodies& bodies, const std::vector<DirichletCondition>& conditions)
      : mesh_(mesh), bodies_(bodies), frames_(frames(mesh, bodies)) {
    add_constrained(conditions);
    add_shared();
  }

  const std::vector<RigidFrame>& body_frames() const { return frames_; }
  const std::map<std::pair<int, int>, RigidBlock>& blocks() const { return blocks_; }

 private:
  RigidRow row(int body, GlobalIndex node, int i) const {
    return rigid_row(frames_[body], mesh::point(mesh_, node), i);
  }

  void add(int body_a, const RigidRow& a, int body_b, const RigidRow& b, Real sign) {
    add_product(blocks_[{body_a, body_b}], a, b, sign);
  }

  void add_constrained(const std::vector<DirichletCondition>& conditions) {
    for (const auto& condition : conditions) {
      for (const auto& face : mesh_.boundary_faces) {
        if (face.boundary != condition.boundary ||
            (condition.region >= 0 && mesh_.cell_region[face.cell] != condition.region))
          continue;
        const int body = bodies_.of_cell[face.cell];
        const auto nodes = mesh::nodes_of_face(mesh_, face.cell, face.local_face);
        for (int k = 0; k < mesh::n_face_nodes(mesh_.shape); ++k)
          for (int i = 0; i < mesh_.dim(); ++i) {
            if (!condition.values[i] || !condition.applies_at(mesh::point(mesh_, nodes[k]))) continue;
            const RigidRow constrained = row(body, nodes[k], i);
            add(body, constrained, body, constrained, 1);
          }
      }
    }
  }

  /// Adds constraints between bodies or places with common unknowns: ties, and bodies that touch at an edge or corner.
  void add_shared() {
    const int n = mesh::n_nodes(mesh_.shape);
    std::vector<std::pair<int, GlobalIndex>> first(mesh_.n_free_nodes(), {-1, -1});
    for (std::size_t k = 0; k < mesh_.cells.size(); ++k) {
      const std::pair<int, GlobalIndex> here{bodies_.of_cell[k / n], mesh_.cells[k]};
      auto& other = first[mesh_.free_node(here.second)];
      if (other.first < 0) other = here;
      if (other == here) continue;
      for (int i = 0; i < mesh_.dim(); ++i) {
        const RigidRow a = row(here.first, here.second, i), b = row(other.first, other.second, i);
        add(here.first, a, here.first, a, 1);
        add(here.first, a, other.first, b, -1);
        add(other.first, b, here.first, a, -1);
        add(other.first, b, other.first, b, 1);
      }
    }
  }

  const GlobalMesh& mesh_;
  const mesh::Bodies& bodies_;
  std::vector<RigidFrame> frames_;
  std::map<std::pair<int, int>, RigidBlock> blocks_;
};

}  // namespace

std::vector<FreeMotion> free_motions(const GlobalMesh& mesh, const std::vector<DirichletCondition>& conditions) {
  const auto bodies = mesh::find_bodies(mesh);
  const Gram gram(mesh, bodies, conditions);
  mesh::UnionFind joined(bodies.n());
  for (const auto& [pair, block] : gram.blocks()) joined.join(pair.first, pair.second);
  std::map<GlobalIndex, std::vector<int>> groups;
  for (int body = 0; body < bodies.n(); ++body) groups[joined.find(body)].push_back(body);
  const auto modes = rigid_modes(mesh.dim());
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
        RigidRow q{};
        for (int c = 0; c < m; ++c)
          if (std::abs(vector[k * m + c]) > negligible) q[modes[c]] = vector[k * m + c];
        if (q != RigidRow{}) result.push_back(free_motion(members[k], gram.body_frames()[members[k]], q));
      }
  }
  return result;
}

std::string unconstrained(const GlobalMesh& mesh, const std::vector<DirichletCondition>& conditions) {
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
      "boundary conditions: nothing constrains the rock of {} around {} ({} cells of {}){}: it {}. Contact constrains "
      "a block only against constrained blocks; prescribe the missing components, in at least one direction on a "
      "boundary of the block, or connect its sides by \"periodic\"",
      base::quoted_list(regions), to_text(centre, mesh.dim(), mesh::norm(centre)), bodies.n_cells[body], mesh.n_cells(),
      others > 0 ? fmt::format(" and {} more bodies", others) : "", fmt::join(ways, "; it "));
}

}  // namespace sprekk::assembly
