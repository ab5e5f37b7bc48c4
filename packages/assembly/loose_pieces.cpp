#include "assembly/loose_pieces.hpp"

#include "assembly/geometry.hpp"
#include "base/check.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <Teuchos_LAPACK.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace sprekk::assembly {

using mesh::Vector;
using mesh::operator+;
using mesh::operator-;
using mesh::operator*;

namespace {

/// Of the stiffness against deformation; small enough not to be felt, large enough for the arithmetic.
constexpr Real proximal_share = 1e-4;

template <class T>
void sum_over_ranks(const Comm& comm, std::vector<T>& values) {
  std::vector<T> all(values.size());
  Teuchos::reduceAll(comm, Teuchos::REDUCE_SUM, static_cast<int>(values.size()), values.data(), all.data());
  values = std::move(all);
}

void sum_over_ranks(const Comm& comm, std::vector<RigidBlock>& blocks) {
  std::vector<RigidBlock> all(blocks.size());
  if (blocks.empty()) return;
  Teuchos::reduceAll(comm, Teuchos::REDUCE_SUM, static_cast<int>(36 * blocks.size()), blocks[0][0].data(),
                     all[0][0].data());
  blocks = std::move(all);
}

void add_block(RigidBlock& sum, const RigidBlock& block) {
  for (int k = 0; k < 6; ++k)
    for (int l = 0; l < 6; ++l) sum[k][l] += block[k][l];
}

/// The rows and columns of `modes`.
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

LoosePieces::LoosePieces(RCP<const mesh::Mesh> mesh, const fields::Layout& displacement, const Constraints& constraints)
    : mesh_(mesh) {
  if (mesh_->n_global_fracture_faces == 0) return;
  measure_pieces(displacement);
  hold(constraints);
  for (int p = 0; p < mesh_->n_pieces; ++p)
    if (!is_regular(support_[p], rigid_modes(dim()))) candidates_.push_back(p);
  loose_number_.assign(mesh_->n_pieces, -1);
  pair_up();
}

Vector LoosePieces::node(LocalIndex n) const {
  Vector x{};
  for (int i = 0; i < dim(); ++i) x[i] = mesh_->coordinates[n * dim() + i];
  return x;
}

/// Frames and sizes of pieces; which piece a node is in, and the volume around it.
void LoosePieces::measure_pieces(const fields::Layout& displacement) {
  const int n = mesh_->nodes_per_cell(), n_pieces = mesh_->n_pieces;
  std::vector<Real> corner(6 * n_pieces, -std::numeric_limits<Real>::max()), corners(corner.size());
  piece_of_.assign(displacement.n_owned_entities(), 0);
  volume_.assign(displacement.n_owned_entities(), 0);
  n_cells_.assign(n_pieces, 0);
  for (LocalIndex c = 0; c < mesh_->n_cells(); ++c) {
    const int piece = mesh_->cell_piece[c];
    if (c < mesh_->n_owned_cells) ++n_cells_[piece];
    Real volume = 0;
    mesh::for_shape(mesh_->shape, [&](auto shape) {
      for_each_cell_point<shape()>(*mesh_, c, [&](const auto&, Real share, const auto&) { volume += share; });
    });
    for (int k = 0; k < n; ++k) {
      const LocalIndex here = mesh_->cells[c * n + k], owned = mesh_->free_node(here);
      const Vector x = node(here);
      for (int i = 0; i < 3; ++i) {
        corner[6 * piece + i] = std::max(corner[6 * piece + i], x[i]);
        corner[6 * piece + 3 + i] = std::max(corner[6 * piece + 3 + i], -x[i]);
      }
      if (owned >= displacement.n_owned_entities()) continue;
      piece_of_[owned] = piece;
      volume_[owned] += volume / n;
    }
  }
  Teuchos::reduceAll(*mesh_->comm, Teuchos::REDUCE_MAX, static_cast<int>(corner.size()), corner.data(), corners.data());
  sum_over_ranks(*mesh_->comm, n_cells_);
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
  sum_over_ranks(*mesh_->comm, inertia_);
}

void LoosePieces::hold(const Constraints& constraints) {
  support_.assign(mesh_->n_pieces, {});
  for (const auto& entry : constraints.entries()) {
    const int piece = piece_of_[entry.unknown / dim()];
    const auto row = rigid_row(frames_[piece], node(entry.unknown / dim()), entry.component);
    add_product(support_[piece], row, row);
  }
  sum_over_ranks(*mesh_->comm, support_);
}

/// The pairs of pieces on the two sides of any rank's faces, in the same order everywhere.
void LoosePieces::pair_up() {
  std::set<std::pair<int, int>> here;
  std::vector<std::pair<int, int>> of_face;
  for (LocalIndex f = 0; f < mesh_->n_owned_fracture_faces; ++f) {
    const auto& cell = mesh_->fracture_faces[f].cell;
    of_face.push_back(std::minmax(mesh_->cell_piece[cell[0]], mesh_->cell_piece[cell[1]]));
    if (of_face.back().first != of_face.back().second) here.insert(of_face.back());
  }
  std::vector<int> mine;
  for (const auto& [a, b] : here) mine.insert(mine.end(), {a, b});
  const Comm& comm = *mesh_->comm;
  const int n = static_cast<int>(mine.size());
  int most = 0;
  Teuchos::reduceAll(comm, Teuchos::REDUCE_MAX, 1, &n, &most);
  mine.resize(most, -1);
  std::vector<int> all(most * comm.getSize());
  if (most > 0) Teuchos::gatherAll(comm, most, mine.data(), static_cast<int>(all.size()), all.data());
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
}

void LoosePieces::set_stiffness(const fields::Vector& diagonal) {
  stiffness_ = rcp(new fields::Vector(diagonal, Teuchos::Copy));
  proximal_ = rcp(new fields::Vector(diagonal.getMap()));
  const auto view = stiffness_->getLocalViewHost(Tpetra::Access::ReadWrite);
  for (std::size_t k = 0; k < piece_of_.size(); ++k) {
    const Real ratio = std::pow(volume_[k], 1.0 / dim()) / frames_[piece_of_[k]].size;
    for (int i = 0; i < dim(); ++i) view(k * dim() + i, 0) *= proximal_share * ratio * ratio;
  }
}

void LoosePieces::sum_pairs(const std::vector<Grip>& grips) {
  pairs_sum_.assign(3 * pairs_.size(), {});
  for (std::size_t f = 0; f < pair_of_.size(); ++f) {
    if (pair_of_[f] < 0) continue;
    const auto [a, b] = pairs_[pair_of_[f]];
    const Vector& x = mesh_->fracture_faces[f].centre;
    for (int i = 0; i < dim(); ++i) {
      RigidRow row_a{}, row_b{};  // of component i of what is held
      for (int j = 0; j < dim(); ++j) {
        const auto at_a = rigid_row(frames_[a], x, j), at_b = rigid_row(frames_[b], x, j);
        for (int k = 0; k < 6; ++k) {
          row_a[k] += grips[f].held[i][j] * at_a[k];
          row_b[k] += grips[f].held[i][j] * at_b[k];
        }
      }
      add_product(pairs_sum_[3 * pair_of_[f]], row_a, row_a);
      add_product(pairs_sum_[3 * pair_of_[f] + 1], row_a, row_b, -1);
      add_product(pairs_sum_[3 * pair_of_[f] + 2], row_b, row_b);
    }
  }
  sum_over_ranks(*mesh_->comm, pairs_sum_);
}

/// Candidates that are not held by pieces that are: a piece counts as held once its support and its neighbours that
/// are held leave it no motion.
std::vector<int> LoosePieces::unheld() const {
  const auto modes = rigid_modes(dim());
  std::vector<char> held(mesh_->n_pieces, 1);
  for (int p : candidates_) held[p] = 0;
  auto sum = support_;
  for (int p : candidates_)
    for (const auto& n : neighbours_[p])
      if (held[n.piece]) add_block(sum[p], block(n.pair, n.first ? 0 : 2));
  std::vector<int> open = candidates_;
  while (!open.empty()) {
    const int p = open.back();
    open.pop_back();
    if (held[p] || !is_regular(sum[p], modes)) continue;
    held[p] = 1;
    for (const auto& n : neighbours_[p])
      if (!held[n.piece]) {
        add_block(sum[n.piece], block(n.pair, n.first ? 2 : 0));
        open.push_back(n.piece);
      }
  }
  std::vector<int> result;
  for (int p : candidates_)
    if (!held[p]) result.push_back(p);
  return result;
}

void LoosePieces::find(const std::vector<Grip>& grips) {
  sum_pairs(grips);
  loose_ = unheld();
  find_modes();
  proximal_->putScalar(0);
  if (!any()) return;
  const auto to = proximal_->getLocalViewHost(Tpetra::Access::ReadWrite);
  const auto from = stiffness_->getLocalViewHost(Tpetra::Access::ReadOnly);
  for (std::size_t k = 0; k < piece_of_.size(); ++k)
    if (loose_number_[piece_of_[k]] >= 0)
      for (int i = 0; i < dim(); ++i) to(k * dim() + i, 0) = from(k * dim() + i, 0);
}

/// Motions that no pair of the pieces left over resists; those that move are loose.
void LoosePieces::find_modes() {
  std::fill(loose_number_.begin(), loose_number_.end(), -1);
  modes_.clear();
  if (loose_.empty()) return;
  for (std::size_t k = 0; k < loose_.size(); ++k) loose_number_[loose_[k]] = static_cast<int>(k);
  const auto modes = rigid_modes(dim());
  const int m = static_cast<int>(modes.size()), n = m * static_cast<int>(loose_.size());
  std::vector<Real> matrix(static_cast<std::size_t>(n) * n, 0);
  const auto add_to = [&](int row, int column, const RigidBlock& sum, bool transposed) {
    for (int k = 0; k < m; ++k)
      for (int l = 0; l < m; ++l)
        matrix[static_cast<std::size_t>(row * m + k) * n + column * m + l] +=
            transposed ? sum[modes[l]][modes[k]] : sum[modes[k]][modes[l]];
  };
  for (std::size_t k = 0; k < loose_.size(); ++k) {
    const int row = static_cast<int>(k);
    add_to(row, row, support_[loose_[k]], false);
    for (const auto& neighbour : neighbours_[loose_[k]]) {
      add_to(row, row, block(neighbour.pair, neighbour.first ? 0 : 2), false);
      if (loose_number_[neighbour.piece] >= 0)
        add_to(row, loose_number_[neighbour.piece], block(neighbour.pair, 1), !neighbour.first);
    }
  }
  modes_ = null_space(std::move(matrix), n);
  if (!modes_.empty()) return;
  std::fill(loose_number_.begin(), loose_number_.end(), -1);
  loose_.clear();
}

LoosePieces::Motion LoosePieces::part_of(const fields::Vector& displacement) const {
  const auto modes = rigid_modes(dim());
  const int m = static_cast<int>(modes.size()), n = static_cast<int>(loose_.size());
  std::vector<Real> q(n * m, 0);
  const auto u = displacement.getLocalViewHost(Tpetra::Access::ReadOnly);
  for (std::size_t k = 0; k < piece_of_.size(); ++k) {
    const int number = loose_number_[piece_of_[k]];
    if (number < 0) continue;
    for (int i = 0; i < dim(); ++i) {
      const auto row = rigid_row(frames_[piece_of_[k]], node(static_cast<LocalIndex>(k)), i);
      for (int c = 0; c < m; ++c) q[number * m + c] += row[modes[c]] * u(k * dim() + i, 0);
    }
  }
  sum_over_ranks(*mesh_->comm, q);
  for (int k = 0; k < n; ++k) {
    auto matrix = dense(inertia_[loose_[k]], modes);
    int info = 0;
    Teuchos::LAPACK<int, Real>().POSV('U', m, 1, matrix.data(), m, &q[k * m], m, &info);
    SPREKK_CHECK(info == 0, "rigid motions: LAPACK's POSV failed with {}", info);
  }
  Motion motion;
  motion.q.assign(n, {});
  for (const auto& mode : modes_) {
    Real part = 0;
    for (int c = 0; c < n * m; ++c) part += mode[c] * q[c];
    for (int c = 0; c < n * m; ++c) motion.q[c / m][modes[c % m]] += part * mode[c];
  }
  for (const auto& piece : motion.q) {
    Real square = 0;
    for (Real value : piece) square += value * value;
    motion.largest = std::max(motion.largest, std::sqrt(square));
  }
  return motion;
}

void LoosePieces::add(Real s, const Motion& motion, fields::Vector& displacement) const {
  const auto u = displacement.getLocalViewHost(Tpetra::Access::ReadWrite);
  for (std::size_t k = 0; k < piece_of_.size(); ++k) {
    const int piece = piece_of_[k], number = loose_number_[piece];
    if (number < 0) continue;
    const Vector v = rigid_displacement(frames_[piece], motion.q[number], node(static_cast<LocalIndex>(k)));
    for (int i = 0; i < dim(); ++i) u(k * dim() + i, 0) += s * v[i];
  }
}

Real LoosePieces::work(const Motion& motion, const fields::Vector& residual, const std::vector<Grip>& grips) const {
  const auto r = residual.getLocalViewHost(Tpetra::Access::ReadOnly);
  std::vector<Real> work{0};
  const auto velocity = [&](int piece, const Vector& x) {
    const int number = loose_number_[piece];
    return number < 0 ? Vector{} : rigid_displacement(frames_[piece], motion.q[number], x);
  };
  for (std::size_t k = 0; k < piece_of_.size(); ++k) {
    const Vector v = velocity(piece_of_[k], node(static_cast<LocalIndex>(k)));
    for (int i = 0; i < dim(); ++i) work[0] += v[i] * r(k * dim() + i, 0);
  }
  for (std::size_t f = 0; f < pair_of_.size(); ++f) {
    if (pair_of_[f] < 0) continue;
    const auto& face = mesh_->fracture_faces[f];
    const Vector jump = velocity(mesh_->cell_piece[face.cell[mesh::plus]], face.centre) -
                        velocity(mesh_->cell_piece[face.cell[mesh::minus]], face.centre);
    work[0] -= face.area * mesh::dot(grips[f].excess, jump);
  }
  sum_over_ranks(*mesh_->comm, work);
  return work[0];
}

std::string LoosePieces::describe() const {
  const auto modes = rigid_modes(dim());
  const auto& mode = modes_.front();
  const auto largest =
      std::max_element(mode.begin(), mode.end(), [](Real a, Real b) { return std::abs(a) < std::abs(b); });
  const std::size_t number = (largest - mode.begin()) / modes.size();
  const int piece = loose_[number];
  RigidRow q{};
  for (std::size_t c = 0; c < modes.size(); ++c) q[modes[c]] = mode[number * modes.size() + c];
  const auto& frame = frames_[piece];
  return fmt::format("a piece of rock around {} ({} cells){} {}",
                     to_text(frame.centre, dim(), mesh::norm(frame.centre) + frame.size), n_cells_[piece],
                     loose_.size() > 1 ? fmt::format(" and {} more", loose_.size() - 1) : "",
                     to_text(free_motion(piece, frame, q), dim()));
}

}  // namespace sprekk::assembly
