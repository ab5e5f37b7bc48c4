// Where loose pieces come to lie nearest to a given place, next to others that they must not enter.
#include "assembly/least_distance.hpp"
#include "assembly/loose_pieces.hpp"

#include "base/check.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <Teuchos_LAPACK.hpp>

#include <algorithm>
#include <cmath>

namespace sprekk::assembly {

using mesh::Vector;
using mesh::operator-;

namespace {

/// All ranks' rows of a length, those of the first rank first.
std::vector<std::vector<Real>> gather_rows(const Comm& comm, const std::vector<std::vector<Real>>& here, int length) {
  const int n = static_cast<int>(here.size()), stride = length + 1;
  int most = 0;
  Teuchos::reduceAll(comm, Teuchos::REDUCE_MAX, 1, &n, &most);
  std::vector<Real> mine(most * stride, 0), all(static_cast<std::size_t>(most) * stride * comm.getSize());
  for (int k = 0; k < n; ++k) {
    mine[k * stride] = 1;  // there is a row
    std::copy(here[k].begin(), here[k].end(), &mine[k * stride + 1]);
  }
  if (most > 0) Teuchos::gatherAll(comm, most * stride, mine.data(), static_cast<int>(all.size()), all.data());
  std::vector<std::vector<Real>> rows;
  for (std::size_t k = 0; k < all.size(); k += stride)
    if (all[k] > 0) rows.emplace_back(all.begin() + k + 1, all.begin() + k + stride);
  return rows;
}

}  // namespace

Vector LoosePieces::jump(LocalIndex f, const std::vector<RigidRow>& motion) const {
  const auto& face = mesh_->fracture_faces[f];
  const auto on = [&](int side) {
    const int piece = mesh_->cell_piece[face.cell[side]], number = loose_number_[piece];
    return number < 0 ? Vector{} : rigid_displacement(frames_[piece], motion[number], face.centre);
  };
  return on(mesh::plus) - on(mesh::minus);
}

bool LoosePieces::is_beside(LocalIndex f) const {
  const auto& cell = mesh_->fracture_faces[f].cell;
  return pair_of_[f] >= 0 &&
         (loose_number_[mesh_->cell_piece[cell[0]]] >= 0 || loose_number_[mesh_->cell_piece[cell[1]]] >= 0);
}

/// With z the amplitudes of the free motions Q, u the displacement and P the proximal term, |u + Q z|_P is least:
/// H = Q^T P Q = U^T U, and y = U z + U^-T Q^T P u is to be least in the Euclidean norm.
std::optional<std::vector<RigidRow>> LoosePieces::nearest(const fields::Vector& displacement,
                                                          const std::vector<Obstacle>& obstacles, Real unit) const {
  const auto modes = rigid_modes(dim());
  const int m = static_cast<int>(modes.size());
  std::vector<std::vector<RigidRow>> motions;  // [z][loose piece]
  for (const auto& group : groups_)
    for (const auto& mode : group.modes) {
      motions.emplace_back(loose_.size(), RigidRow{});
      for (std::size_t c = 0; c < mode.size(); ++c) motions.back()[group.first + c / m][modes[c % m]] = mode[c];
    }
  const int n = static_cast<int>(motions.size()), n_loose = static_cast<int>(loose_.size());
  std::vector<Real> sums(n_loose * 42, 0);  // [loose piece] N^T P N, N^T P u
  const auto u = displacement.getLocalViewHost(Tpetra::Access::ReadOnly);
  const auto p = proximal_->getLocalViewHost(Tpetra::Access::ReadOnly);
  for (std::size_t k = 0; k < piece_of_.size(); ++k) {
    const int number = loose_number_[piece_of_[k]];
    for (int i = 0; i < dim() && number >= 0; ++i) {
      const auto row = rigid_row(frames_[piece_of_[k]], node(static_cast<LocalIndex>(k)), i);
      const Real weight = p(k * dim() + i, 0);
      for (int a = 0; a < 6; ++a) {
        for (int b = 0; b < 6; ++b) sums[number * 42 + 6 * a + b] += weight * row[a] * row[b];
        sums[number * 42 + 36 + a] += weight * row[a] * u(k * dim() + i, 0);
      }
    }
  }
  std::vector<Real> all(sums.size());
  Teuchos::reduceAll(*mesh_->comm, Teuchos::REDUCE_SUM, static_cast<int>(sums.size()), sums.data(), all.data());
  std::vector<Real> H(static_cast<std::size_t>(n) * n, 0), z(n, 0);
  for (int r = 0; r < n; ++r)
    for (int l = 0; l < n_loose; ++l)
      for (int a = 0; a < 6; ++a) {
        const Real q = motions[r][l][a];
        if (q == 0) continue;
        z[r] += q * all[l * 42 + 36 + a];
        for (int s = 0; s < n; ++s)
          for (int b = 0; b < 6; ++b) H[r * n + s] += q * all[l * 42 + 6 * a + b] * motions[s][l][b];
      }
  Real size = 0;
  for (int r = 0; r < n; ++r) size = std::max(size, H[r * n + r]);
  const Real scale = std::sqrt(size) * unit;  // of y
  Teuchos::LAPACK<int, Real> lapack;
  int info = 0;
  lapack.POTRF('U', n, H.data(), n, &info);
  SPREKK_CHECK(info == 0, "rigid motions: LAPACK's POTRF failed with {}", info);
  const auto solve = [&](char transpose, std::vector<Real>& x) {
    lapack.TRTRS('U', transpose, 'N', n, 1, H.data(), n, x.data(), n, &info);
    SPREKK_CHECK(info == 0, "rigid motions: LAPACK's TRTRS failed with {}", info);
  };
  solve('T', z);  // U^-T Q^T P u, at z = 0
  std::vector<std::vector<Real>> here, G;
  for (const auto& obstacle : obstacles) {
    here.emplace_back();
    for (const auto& motion : motions) here.back().push_back(mesh::dot(obstacle.normal, jump(obstacle.face, motion)));
    here.back().push_back(obstacle.least);
  }
  std::vector<Real> h;
  for (auto& row : gather_rows(*mesh_->comm, here, n + 1)) {
    Real least = row.back();
    row.pop_back();
    solve('T', row);  // of y / scale
    for (int k = 0; k < n; ++k) least += row[k] * z[k];
    for (Real& value : row) value *= scale;
    G.push_back(row);
    h.push_back(least);
  }
  auto y = least_distance(std::move(G), std::move(h), n);
  if (!y) return {};
  for (int k = 0; k < n; ++k) z[k] = scale * (*y)[k] - z[k];
  solve('N', z);
  std::vector<RigidRow> motion(n_loose, RigidRow{});
  for (int r = 0; r < n; ++r)
    for (int l = 0; l < n_loose; ++l)
      for (int c = 0; c < 6; ++c) motion[l][c] += z[r] * motions[r][l][c];
  return motion;
}

}  // namespace sprekk::assembly
