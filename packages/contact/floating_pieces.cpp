#include "contact/floating_pieces.hpp"

#include "base/check.hpp"
#include "base/over_ranks.hpp"
#include "mesh/union_find.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace sprekk::contact {

using mesh::Vector;
using mesh::operator+;
using mesh::operator-;
using mesh::operator*;

namespace {

/// Proximal term relative to the stiffness against deformation: without effect on results, large enough for round-off.
constexpr Real proximal_share = 1e-4;
/// Share of this term in pieces with a resistance that may be many orders of magnitude below that of the rock.
constexpr Real weak = 1e-8;

void add_block(RigidBlock& sum, const RigidBlock& block) {
  for (int k = 0; k < 6; ++k)
    for (int l = 0; l < 6; ++l) sum[k][l] += block[k][l];
}

/// Returns the rows and columns of `modes`.
std::vector<Real> dense(const RigidBlock& block, const std::vector<int>& modes) {
  std::vector<Real> matrix;
  for (int k : modes)
    for (int l : modes) matrix.push_back(block[k][l]);
  return matrix;
}

bool is_regular(const RigidBlock& block, const std::vector<int>& modes) {
  return null_space(dense(block, modes), static_cast<int>(modes.size())).empty();
}

}  // namespace

FloatingPieces::FloatingPieces(RCP<const mesh::Mesh> mesh, const fields::Layout& displacement,
                               const std::vector<Support>& supports, const std::vector<Real>& volumes)
    : mesh_(mesh) {
  if (mesh_->n_global_fracture_faces == 0) return;
  measure_pieces(displacement, volumes);
  find_ties(displacement);
  constrain(supports);
  for (int p = 0; p < mesh_->n_pieces; ++p)
    if (!is_regular(support_[p], rigid_modes(dim()))) candidates_.push_back(p);
  floating_number_.assign(mesh_->n_pieces, -1);
  pair_up();
}

Vector FloatingPieces::node(LocalIndex n) const {
  Vector x{};
  for (int i = 0; i < dim(); ++i) x[i] = mesh_->coordinates[n * dim() + i];
  return x;
}

/// Computes the frame, size and cell count of pieces, and the piece and volume of nodes. Collective.
void FloatingPieces::measure_pieces(const fields::Layout& displacement, const std::vector<Real>& volumes) {
  const int n = mesh_->nodes_per_cell(), n_pieces = mesh_->n_pieces;
  std::vector<Real> corner(6 * n_pieces, -std::numeric_limits<Real>::max());
  piece_of_.assign(displacement.n_owned_entities(), 0);
  volume_.assign(displacement.n_owned_entities(), 0);
  n_cells_.assign(n_pieces, 0);
  for (LocalIndex c = 0; c < mesh_->n_cells(); ++c) {
    const int piece = mesh_->cell_piece[c];
    if (c < mesh_->n_owned_cells) ++n_cells_[piece];
    for (int k = 0; k < n; ++k) {
      const LocalIndex here = mesh_->cells[c * n + k], owned = mesh_->free_node(here);
      const Vector x = node(here);
      for (int i = 0; i < 3; ++i) {
        corner[6 * piece + i] = std::max(corner[6 * piece + i], x[i]);
        corner[6 * piece + 3 + i] = std::max(corner[6 * piece + 3 + i], -x[i]);
      }
      if (owned >= displacement.n_owned_entities()) continue;
      if (owned == here) piece_of_[owned] = piece;
      volume_[owned] += volumes[c] / n;
    }
  }
  const auto corners = base::max_over_ranks(*mesh_->comm, corner);
  n_cells_ = base::sum_over_ranks(*mesh_->comm, n_cells_);
  for (int p = 0; p < n_pieces; ++p) {
    RigidFrame frame{{}, 0};
    for (int i = 0; i < 3; ++i) {
      frame.centre[i] = 0.5 * (corners[6 * p + i] - corners[6 * p + 3 + i]);
      frame.size = std::max(frame.size, corners[6 * p + i] + corners[6 * p + 3 + i]);
    }
    frames_.push_back(frame);
  }
  inertia_.assign(n_pieces, {});
  for (LocalIndex k = 0; k < displacement.n_owned_entities(); ++k)
    for (int i = 0; i < dim(); ++i) {
      const auto row = rigid_row(frames_[piece_of_[k]], node(k), i);
      add_product(inertia_[piece_of_[k]], row, row);
    }
  inertia_ = base::sum_over_ranks(*mesh_->comm, inertia_);
}

void FloatingPieces::find_ties(const fields::Layout& displacement) {
  fields::Vector owned(displacement.owned()), ghosted(displacement.ghosted());  // piece numbers of nodes
  for (LocalIndex i = 0; i < displacement.n_owned(); ++i) owned.replaceLocalValue(i, piece_of_[i / dim()]);
  ghosted.doImport(owned, *displacement.import(), Tpetra::REPLACE);
  const auto piece_of = ghosted.getLocalViewHost(Tpetra::Access::ReadOnly);
  for (std::size_t k = 0; k < piece_of.extent(0); k += dim()) piece_of_ghosts_.push_back(std::lround(piece_of(k, 0)));
  const int n = mesh_->nodes_per_cell();
  for (LocalIndex k = 0; k < n * mesh_->n_owned_cells; ++k) {
    const LocalIndex here = mesh_->cells[k], free = mesh_->free_node(here);
    const int a = mesh_->cell_piece[k / n], b = static_cast<int>(piece_of(free * dim(), 0));
    if (here == free && a == b) continue;
    ties_.push_back(a <= b ? Tie{a, b, -1, node(here), node(free)} : Tie{b, a, -1, node(free), node(here)});
  }
  std::vector<int> tied(mesh_->n_pieces, 0);
  for (const auto& tie : ties_) tied[tie.a] = tied[tie.b] = 1;
  tied_ = base::max_over_ranks(*mesh_->comm, tied);
}

void FloatingPieces::constrain(const std::vector<Support>& supports) {
  support_.assign(mesh_->n_pieces, {});
  for (const auto& [unknown, component, direction] : supports) {
    const int piece = piece_of_[unknown / dim()];
    auto row = rigid_row(frames_[piece], node(unknown / dim()), component);
    if (direction) row = {};
    for (int i = 0; i < dim() && direction; ++i) {
      const auto along = rigid_row(frames_[piece], node(unknown / dim()), i);
      for (std::size_t k = 0; k < row.size(); ++k) row[k] += (*direction)[i] * along[k];
    }
    add_product(support_[piece], row, row);
  }
  for (const auto& tie : ties_)
    for (int i = 0; i < dim() && tie.a == tie.b; ++i) {
      auto row = rigid_row(frames_[tie.a], tie.at_a, i);
      const auto other = rigid_row(frames_[tie.a], tie.at_b, i);
      for (int k = 0; k < 6; ++k) row[k] -= other[k];
      add_product(support_[tie.a], row, row);
    }
  support_ = base::sum_over_ranks(*mesh_->comm, support_);
}

/// Finds the pairs of pieces at faces and ties of all ranks, in the same order on all ranks. Collective.
void FloatingPieces::pair_up() {
  std::set<std::pair<int, int>> here;
  std::vector<std::pair<int, int>> of_face;
  for (LocalIndex f = 0; f < mesh_->n_owned_fracture_faces; ++f) {
    const auto& cell = mesh_->fracture_faces[f].cell;
    of_face.push_back(std::minmax(mesh_->cell_piece[cell[0]], mesh_->cell_piece[cell[1]]));
    if (of_face.back().first != of_face.back().second) here.insert(of_face.back());
  }
  for (const auto& tie : ties_)
    if (tie.a != tie.b) here.insert({tie.a, tie.b});
  std::vector<int> mine;
  for (const auto& [a, b] : here) mine.insert(mine.end(), {a, b});
  const auto all = base::gather_over_ranks(*mesh_->comm, mine);
  std::map<std::pair<int, int>, int> number;
  for (std::size_t k = 0; k < all.size(); k += 2)
    if (all[k] >= 0) number[{all[k], all[k + 1]}] = 0;
  neighbours_.assign(mesh_->n_pieces, {});
  for (auto& [pair, index] : number) {
    index = static_cast<int>(pairs_.size());
    pairs_.push_back({pair.first, pair.second});
    neighbours_[pair.first].push_back({index, pair.second, true});
    neighbours_[pair.second].push_back({index, pair.first, false});
  }
  for (const auto& pair : of_face) pair_of_.push_back(pair.first == pair.second ? -1 : number.at(pair));
  for (auto& tie : ties_)
    if (tie.a != tie.b) tie.pair = number.at({tie.a, tie.b});
}

/// Scales the term to the softest piece, since soft pieces may support a stiff one. The diagonal measures the
/// stiffness.
void FloatingPieces::set_stiffness(const fields::Vector& diagonal) {
  stiffness_ = rcp(new fields::Vector(diagonal, Teuchos::Copy));
  proximal_ = rcp(new fields::Vector(diagonal.getMap()));
  const auto view = stiffness_->getLocalViewHost(Tpetra::Access::ReadWrite);
  std::vector<Real> modulus(mesh_->n_pieces, 0), n_nodes(mesh_->n_pieces, 0);
  for (std::size_t k = 0; k < piece_of_.size(); ++k) {
    const Real size = std::pow(volume_[k], 1.0 / dim()), ratio = size / frames_[piece_of_[k]].size;
    ++n_nodes[piece_of_[k]];
    for (int i = 0; i < dim(); ++i) {
      modulus[piece_of_[k]] += view(k * dim() + i, 0) * std::pow(size, 2 - dim());
      view(k * dim() + i, 0) *= proximal_share * ratio * ratio;
    }
  }
  modulus = base::sum_over_ranks(*mesh_->comm, modulus);
  n_nodes = base::sum_over_ranks(*mesh_->comm, n_nodes);
  for (int p = 0; p < mesh_->n_pieces; ++p) modulus[p] /= n_nodes[p];
  const auto [softest, stiffest] = std::minmax_element(modulus.begin(), modulus.end());
  contrast_ = *stiffest / *softest;
  for (std::size_t k = 0; k < piece_of_.size(); ++k)
    for (int i = 0; i < dim(); ++i) view(k * dim() + i, 0) *= *softest / modulus[piece_of_[k]];
}

void FloatingPieces::sum_pairs(const std::vector<Constraint>& constraints, bool with_resistance) {
  pairs_sum_.assign(3 * pairs_.size(), {});
  const auto add = [&](int pair, const RigidRow& a, const RigidRow& b) {
    add_product(pairs_sum_[3 * pair], a, a);
    add_product(pairs_sum_[3 * pair + 1], a, b, -1);
    add_product(pairs_sum_[3 * pair + 2], b, b);
  };
  for (const auto& tie : ties_)
    for (int i = 0; i < dim() && tie.pair >= 0; ++i)
      add(tie.pair, rigid_row(frames_[tie.a], tie.at_a, i), rigid_row(frames_[tie.b], tie.at_b, i));
  for (std::size_t f = 0; f < pair_of_.size(); ++f) {
    if (pair_of_[f] < 0) continue;
    const auto [a, b] = pairs_[pair_of_[f]];
    const Vector& x = mesh_->fracture_faces[f].centre;
    const auto constrain = [&, a = a, b = b](const Vector& direction) {
      RigidRow row_a{}, row_b{};
      for (int j = 0; j < dim(); ++j) {
        const auto at_a = rigid_row(frames_[a], x, j), at_b = rigid_row(frames_[b], x, j);
        for (int k = 0; k < 6; ++k) {
          row_a[k] += direction[j] * at_a[k];
          row_b[k] += direction[j] * at_b[k];
        }
      }
      add(pair_of_[f], row_a, row_b);
    };
    for (int i = 0; i < dim(); ++i) constrain(constraints[f].constrained[i]);
    if (with_resistance) constrain(constraints[f].resisted);
  }
  pairs_sum_ = base::sum_over_ranks(*mesh_->comm, pairs_sum_);
}

/// Returns the candidates without support by supported pieces. A piece is supported once its supports and its supported
/// neighbours leave no free motion.
std::vector<int> FloatingPieces::unconstrained() const {
  const auto modes = rigid_modes(dim());
  std::vector<char> constrained(mesh_->n_pieces, 1);
  for (int p : candidates_) constrained[p] = 0;
  auto sum = support_;
  for (int p : candidates_)
    for (const auto& n : neighbours_[p])
      if (constrained[n.piece]) add_block(sum[p], block(n.pair, n.first ? 0 : 2));
  std::vector<int> open = candidates_;
  while (!open.empty()) {
    const int p = open.back();
    open.pop_back();
    if (constrained[p] || !is_regular(sum[p], modes)) continue;
    constrained[p] = 1;
    for (const auto& n : neighbours_[p])
      if (!constrained[n.piece]) {
        add_block(sum[n.piece], block(n.pair, n.first ? 2 : 0));
        open.push_back(n.piece);
      }
  }
  std::vector<int> result;
  for (int p : candidates_)
    if (!constrained[p]) result.push_back(p);
  return result;
}

void FloatingPieces::find(const std::vector<Constraint>& constraints) {
  const bool resisted = base::on_any_rank(
      *mesh_->comm, std::any_of(constraints.begin(), constraints.end(),
                                [](const Constraint& constraint) { return constraint.resisted != Vector{}; }));
  find_pieces(constraints, false);
  const auto without_resistance = floating_number_;
  weakly_held_ = resisted && any();
  if (weakly_held_) find_pieces(constraints, true);
  proximal_->putScalar(0);
  if (!any_weakly_held()) return;
  const auto to = proximal_->getLocalViewHost(Tpetra::Access::ReadWrite);
  const auto from = stiffness_->getLocalViewHost(Tpetra::Access::ReadOnly);
  for (std::size_t k = 0; k < piece_of_.size(); ++k) {
    const int piece = piece_of_[k];
    const Real share = floating_number_[piece] >= 0 ? 1 : without_resistance[piece] >= 0 ? weak : 0;
    for (int i = 0; i < dim(); ++i) to(k * dim() + i, 0) = share * from(k * dim() + i, 0);
  }
}

void FloatingPieces::find_pieces(const std::vector<Constraint>& constraints, bool with_resistance) {
  sum_pairs(constraints, with_resistance);
  floating_.clear();
  groups_.clear();
  std::fill(floating_number_.begin(), floating_number_.end(), -1);
  for (const auto& pieces : coupled(unconstrained())) find_motions(pieces);
  for (std::size_t k = 0; k < floating_.size(); ++k) floating_number_[floating_[k]] = static_cast<int>(k);
}

/// Returns the sets of pieces that constrain each other in some direction.
std::vector<std::vector<int>> FloatingPieces::coupled(const std::vector<int>& pieces) const {
  mesh::UnionFind sets(mesh_->n_pieces);
  std::vector<char> is_left(mesh_->n_pieces, 0);
  for (int p : pieces) is_left[p] = 1;
  for (int p : pieces)
    for (const auto& n : neighbours_[p])
      if (is_left[n.piece] && block(n.pair, 1) != RigidBlock{}) sets.join(p, n.piece);
  std::map<GlobalIndex, std::vector<int>> by_first;
  for (int p : pieces) by_first[sets.find(p)].push_back(p);
  std::vector<std::vector<int>> result;
  for (auto& [first, set] : by_first) result.push_back(std::move(set));
  return result;
}

/// Returns the matrix of supports and pair sums for the motions of these pieces, [piece * m + mode] in both dimensions.
std::vector<Real> FloatingPieces::resistance(const std::vector<int>& pieces) const {
  const auto modes = rigid_modes(dim());
  const int m = static_cast<int>(modes.size()), n = m * static_cast<int>(pieces.size());
  std::map<int, int> number;
  for (std::size_t k = 0; k < pieces.size(); ++k) number[pieces[k]] = static_cast<int>(k);
  std::vector<Real> matrix(static_cast<std::size_t>(n) * n, 0);
  const auto add_to = [&](int row, int column, const RigidBlock& sum, bool transposed) {
    for (int k = 0; k < m; ++k)
      for (int l = 0; l < m; ++l)
        matrix[static_cast<std::size_t>(row * m + k) * n + column * m + l] +=
            transposed ? sum[modes[l]][modes[k]] : sum[modes[k]][modes[l]];
  };
  for (const auto& [piece, row] : number) {
    add_to(row, row, support_[piece], false);
    for (const auto& neighbour : neighbours_[piece]) {
      add_to(row, row, block(neighbour.pair, neighbour.first ? 0 : 2), false);
      if (const auto other = number.find(neighbour.piece); other != number.end())
        add_to(row, other->second, block(neighbour.pair, 1), !neighbour.first);
    }
  }
  return matrix;
}

/// Finds the free motions of these pieces, and adds the moving pieces as a new group.
void FloatingPieces::find_motions(const std::vector<int>& pieces) {
  const auto modes = rigid_modes(dim());
  const std::size_t m = modes.size();
  auto motions = null_space(resistance(pieces), static_cast<int>(m * pieces.size()));
  if (motions.empty()) return;
  reduce(motions, [&](std::size_t c) { return modes[c % m] >= 3; });
  Group group{static_cast<int>(floating_.size()), {}};
  group.modes.resize(motions.size());
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const auto moves = [&](const std::vector<Real>& motion) {
      return std::any_of(&motion[k * m], &motion[k * m] + m, [](Real q) { return std::abs(q) > negligible; });
    };
    if (std::none_of(motions.begin(), motions.end(), moves)) continue;
    floating_.push_back(pieces[k]);
    for (std::size_t s = 0; s < motions.size(); ++s)
      group.modes[s].insert(group.modes[s].end(), &motions[s][k * m], &motions[s][k * m] + m);
  }
  groups_.push_back(std::move(group));
}

}  // namespace sprekk::contact
