// Motions of floating pieces: share of a displacement, work, descriptions.
#include "contact/floating_pieces.hpp"

#include "base/check.hpp"
#include "base/over_ranks.hpp"

#include <Teuchos_LAPACK.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sprekk::contact {

using mesh::Vector;
using mesh::operator-;

namespace {

Real size(const RigidRow& q) { return std::sqrt(std::inner_product(q.begin(), q.end(), q.begin(), Real(0))); }

}  // namespace

/// Fits the free motions to the displacement by least squares over nodes, group by group.
FloatingPieces::Motion FloatingPieces::part_of(const fields::Vector& displacement) const {
  const auto modes = rigid_modes(dim());
  const int m = static_cast<int>(modes.size()), n = static_cast<int>(floating_.size());
  std::vector<Real> q(n * m, 0);
  const auto u = displacement.getLocalViewHost(Tpetra::Access::ReadOnly);
  for (std::size_t k = 0; k < piece_of_.size(); ++k) {
    const int number = floating_number_[piece_of_[k]];
    if (number < 0) continue;
    for (int i = 0; i < dim(); ++i) {
      const auto row = rigid_row(frames_[piece_of_[k]], node(static_cast<LocalIndex>(k)), i);
      for (int c = 0; c < m; ++c) q[number * m + c] += row[modes[c]] * u(k * dim() + i, 0);
    }
  }
  q = base::sum_over_ranks(*mesh_->comm, q);
  Motion motion;
  motion.q.assign(n, {});
  for (const auto& group : groups_) {
    const int n_modes = static_cast<int>(group.modes.size()), n_q = static_cast<int>(group.modes[0].size());
    std::vector<Real> product(n_modes * n_modes, 0), share(n_modes, 0);
    for (int s = 0; s < n_modes; ++s) {
      std::vector<Real> moved(n_q, 0);  // inertia times the motion
      for (int k = 0; k < n_q; ++k) {
        const auto& inertia = inertia_[floating_[group.first + k / m]];
        for (int d = 0; d < m; ++d) moved[k] += inertia[modes[k % m]][modes[d]] * group.modes[s][k / m * m + d];
        share[s] += group.modes[s][k] * q[group.first * m + k];
      }
      for (int r = 0; r < n_modes; ++r)
        product[r * n_modes + s] = std::inner_product(moved.begin(), moved.end(), group.modes[r].begin(), Real(0));
    }
    int info = 0;
    Teuchos::LAPACK<int, Real>().POSV('U', n_modes, 1, product.data(), n_modes, share.data(), n_modes, &info);
    SPREKK_CHECK(info == 0, "rigid motions: LAPACK's POSV failed with {}", info);
    for (int s = 0; s < n_modes; ++s)
      for (int k = 0; k < n_q; ++k) motion.q[group.first + k / m][modes[k % m]] += share[s] * group.modes[s][k];
    motion.largest.push_back(0);
    for (int k = 0; k < n_q / m; ++k)
      motion.largest.back() = std::max(motion.largest.back(), size(motion.q[group.first + k]));
  }
  return motion;
}

void FloatingPieces::remove_rigid(fields::Vector& ghosted) const {
  const auto modes = rigid_modes(dim());
  const int m = static_cast<int>(modes.size()), n_pieces = static_cast<int>(frames_.size());
  const auto u = ghosted.getLocalViewHost(Tpetra::Access::ReadWrite);
  std::vector<Real> shares(n_pieces * m, 0);
  for (std::size_t k = 0; k < piece_of_.size(); ++k)
    for (int i = 0; i < dim(); ++i) {
      const auto row = rigid_row(frames_[piece_of_[k]], node(static_cast<LocalIndex>(k)), i);
      for (int c = 0; c < m; ++c) shares[piece_of_[k] * m + c] += row[modes[c]] * u(k * dim() + i, 0);
    }
  shares = base::sum_over_ranks(*mesh_->comm, shares);
  std::vector<RigidRow> motion(n_pieces, RigidRow{});
  for (int p = 0; p < n_pieces; ++p) {
    if (tied_[p]) continue;
    std::vector<Real> inertia;
    for (int k : modes)
      for (int l : modes) inertia.push_back(inertia_[p][k][l]);
    int info = 0;
    Teuchos::LAPACK<int, Real>().POSV('U', m, 1, inertia.data(), m, &shares[p * m], m, &info);
    SPREKK_CHECK(info == 0, "rigid motions: LAPACK's POSV failed with {}", info);
    for (int c = 0; c < m; ++c) motion[p][modes[c]] = shares[p * m + c];
  }
  for (std::size_t k = 0; k < piece_of_ghosts_.size(); ++k) {
    const int piece = piece_of_ghosts_[k];
    const Vector v = rigid_displacement(frames_[piece], motion[piece], node(static_cast<LocalIndex>(k)));
    for (int i = 0; i < dim(); ++i) u(k * dim() + i, 0) -= v[i];
  }
}

void FloatingPieces::set_rigid(int mode, fields::Vector& ghosted) const {
  const auto u = ghosted.getLocalViewHost(Tpetra::Access::OverwriteAll);
  for (std::size_t k = 0; k < piece_of_ghosts_.size(); ++k)
    for (int i = 0; i < dim(); ++i) {
      const int piece = piece_of_ghosts_[k];
      u(k * dim() + i, 0) = tied_[piece] ? 0 : rigid_row(frames_[piece], node(static_cast<LocalIndex>(k)), i)[mode];
    }
}

int FloatingPieces::group_of(int number) const {
  const auto after = std::upper_bound(groups_.begin(), groups_.end(), number,
                                      [](int value, const Group& group) { return value < group.first; });
  return static_cast<int>(after - groups_.begin()) - 1;
}

void FloatingPieces::add(const std::vector<Real>& s, const Motion& motion, fields::Vector& displacement) const {
  const auto u = displacement.getLocalViewHost(Tpetra::Access::ReadWrite);
  for (std::size_t k = 0; k < piece_of_.size(); ++k) {
    const int piece = piece_of_[k], number = floating_number_[piece];
    if (number < 0) continue;
    const Vector v = rigid_displacement(frames_[piece], motion.q[number], node(static_cast<LocalIndex>(k)));
    for (int i = 0; i < dim(); ++i) u(k * dim() + i, 0) += s[group_of(number)] * v[i];
  }
}

std::vector<Real> FloatingPieces::work(const Motion& motion, const fields::Vector& residual,
                                       const std::vector<Constraint>& constraints) const {
  const auto r = residual.getLocalViewHost(Tpetra::Access::ReadOnly);
  std::vector<Real> work(groups_.size(), 0);
  const auto add = [&](int piece, const Vector& x, const Vector& force) {
    const int number = floating_number_[piece];
    if (number < 0) return;
    work[group_of(number)] += mesh::dot(rigid_displacement(frames_[piece], motion.q[number], x), force);
  };
  for (std::size_t k = 0; k < piece_of_.size(); ++k) {
    Vector force{};
    for (int i = 0; i < dim(); ++i) force[i] = r(k * dim() + i, 0);
    add(piece_of_[k], node(static_cast<LocalIndex>(k)), force);
  }
  for (std::size_t f = 0; f < pair_of_.size(); ++f) {
    if (pair_of_[f] < 0) continue;
    const auto& face = mesh_->fracture_faces[f];
    Vector force{}, opposite{};
    for (int i = 0; i < 3; ++i) {
      force[i] = -face.area * constraints[f].excess[i];
      opposite[i] = -force[i];
    }
    add(mesh_->cell_piece[face.cell[mesh::plus]], face.centre, force);
    add(mesh_->cell_piece[face.cell[mesh::minus]], face.centre, opposite);
  }
  return base::sum_over_ranks(*mesh_->comm, work);
}

FloatingPieces::Motion FloatingPieces::selected(const Motion& motion, const std::function<bool(int)>& group_is) const {
  Motion part = motion;
  bool any = false;
  for (std::size_t k = 0; k < floating_.size(); ++k) {
    const bool is = group_is(group_of(static_cast<int>(k)));
    if (!is) part.q[k] = {};
    any = any || is;
  }
  return any ? part : Motion{};
}

int FloatingPieces::max_modes() const {
  std::size_t maximum = 0;
  for (const auto& group : groups_) maximum = std::max(maximum, group.modes.size());
  return static_cast<int>(maximum);
}

FloatingPieces::Motion FloatingPieces::mode(int k) const {
  const auto modes = rigid_modes(dim());
  Motion motion;
  motion.q.assign(floating_.size(), {});
  for (const auto& group : groups_) {
    motion.largest.push_back(0);
    if (k >= static_cast<int>(group.modes.size())) continue;
    const auto& mode = group.modes[k];
    for (std::size_t c = 0; c < mode.size(); ++c) {
      auto& q = motion.q[group.first + c / modes.size()];
      q[modes[c % modes.size()]] = mode[c];
      motion.largest.back() = std::max(motion.largest.back(), size(q));
    }
  }
  return motion;
}

FloatingPieces::Motion FloatingPieces::first() const {
  const auto modes = rigid_modes(dim());
  Motion motion;
  motion.q.assign(floating_.size(), {});
  motion.largest.assign(groups_.size(), 0);
  const auto& mode = groups_.front().modes.back();  // reduce() orders rotations first
  for (std::size_t c = 0; c < mode.size(); ++c)
    motion.q[groups_.front().first + c / modes.size()][modes[c % modes.size()]] = mode[c];
  return motion;
}

std::string FloatingPieces::describe(const Motion& motion) const {
  const auto largest = std::max_element(motion.q.begin(), motion.q.end(),
                                        [](const RigidRow& a, const RigidRow& b) { return size(a) < size(b); });
  const int piece = floating_[largest - motion.q.begin()];
  const auto& frame = frames_[piece];
  return fmt::format("a piece of rock around {} ({} cells){} {}",
                     to_text(frame.centre, dim(), mesh::norm(frame.centre) + frame.size), n_cells_[piece],
                     floating_.size() > 1 ? fmt::format(" and {} more", floating_.size() - 1) : "",
                     to_text(free_motion(piece, frame, *largest), dim()));
}

}  // namespace sprekk::contact
