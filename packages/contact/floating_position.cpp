// Position of floating pieces nearest to a given state, without overlap with other pieces.
#include "contact/least_distance.hpp"
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

/// Returns the rows of all ranks, each of the given length, in the order of ranks. Collective.
std::vector<std::vector<Real>> gather_rows(const Comm& comm, const std::vector<std::vector<Real>>& here, int length) {
  std::vector<Real> mine;
  for (const auto& row : here) mine.insert(mine.end(), row.begin(), row.end());
  const auto all = base::gather_over_ranks(comm, mine);
  std::vector<std::vector<Real>> rows;
  for (auto row = all.begin(); row != all.end(); row += length) rows.emplace_back(row, row + length);
  return rows;
}

}  // namespace

Vector FloatingPieces::jump(LocalIndex f, const std::vector<RigidRow>& motion) const {
  const auto& face = mesh_->fracture_faces[f];
  const auto on = [&](int side) {
    const int piece = mesh_->cell_piece[face.cell[side]], number = floating_number_[piece];
    return number < 0 ? Vector{} : rigid_displacement(frames_[piece], motion[number], face.centre);
  };
  return on(mesh::plus) - on(mesh::minus);
}

bool FloatingPieces::is_beside(LocalIndex f) const {
  const auto& cell = mesh_->fracture_faces[f].cell;
  return pair_of_[f] >= 0 &&
         (floating_number_[mesh_->cell_piece[cell[0]]] >= 0 || floating_number_[mesh_->cell_piece[cell[1]]] >= 0);
}

/// Returns the free motions as [group][mode][floating piece].
std::vector<FloatingPieces::Motions> FloatingPieces::motions_of_groups() const {
  const auto modes = rigid_modes(dim());
  const int m = static_cast<int>(modes.size());
  std::vector<Motions> all;
  for (const auto& group : groups_) {
    all.emplace_back();
    for (const auto& mode : group.modes) {
      all.back().emplace_back(floating_.size(), RigidRow{});
      for (std::size_t c = 0; c < mode.size(); ++c) all.back().back()[group.first + c / m][modes[c % m]] = mode[c];
    }
  }
  return all;
}

/// Returns |u + v|^2 in the norm of the proximal term, [group], from N^T P N and N^T P u of each piece. Collective.
std::vector<FloatingPieces::Form> FloatingPieces::distance_form(const std::vector<Motions>& motions,
                                                                const fields::Vector& displacement) const {
  const auto u = displacement.getLocalViewHost(Tpetra::Access::ReadOnly);
  const auto p = proximal_->getLocalViewHost(Tpetra::Access::ReadOnly);
  std::vector<Real> sums(floating_.size() * 42, 0);
  for (std::size_t k = 0; k < piece_of_.size(); ++k) {
    const int number = floating_number_[piece_of_[k]];
    for (int i = 0; i < dim() && number >= 0; ++i) {
      const auto row = rigid_row(frames_[piece_of_[k]], node(static_cast<LocalIndex>(k)), i);
      const Real weight = p(k * dim() + i, 0);
      for (int a = 0; a < 6; ++a) {
        for (int b = 0; b < 6; ++b) sums[number * 42 + 6 * a + b] += weight * row[a] * row[b];
        sums[number * 42 + 36 + a] += weight * row[a] * u(k * dim() + i, 0);
      }
    }
  }
  sums = base::sum_over_ranks(*mesh_->comm, sums);
  std::vector<Form> forms;
  for (const auto& group : groups_) forms.emplace_back(group.modes.size());
  for (std::size_t l = 0; l < floating_.size(); ++l) {
    const int g = group_of(static_cast<int>(l));
    const Real* sum = &sums[l * 42];
    const std::size_t n = motions[g].size();
    for (std::size_t s = 0; s < n; ++s) {
      const auto& q = motions[g][s][l];
      RigidRow moved{};
      for (int a = 0; a < 6; ++a) moved[a] = std::inner_product(q.begin(), q.end(), sum + 6 * a, Real(0));
      forms[g].vector[s] += std::inner_product(q.begin(), q.end(), sum + 36, Real(0));
      for (std::size_t r = 0; r < n; ++r)
        forms[g].matrix[r * n + s] += std::inner_product(moved.begin(), moved.end(), motions[g][r][l].begin(), Real(0));
    }
  }
  return forms;
}

/// Returns sum_f |f| (along . [[v]] + done)^2, [group]. Collective.
std::vector<FloatingPieces::Form> FloatingPieces::slip_form(const std::vector<Motions>& motions,
                                                            const std::vector<Slide>& slides) const {
  std::vector<Form> forms;
  for (const auto& group : groups_) forms.emplace_back(group.modes.size());
  for (const auto& slide : slides) {
    if (!is_beside(slide.face)) continue;
    const auto& face = mesh_->fracture_faces[slide.face];
    const int group = group_of(
        std::max(floating_number_[mesh_->cell_piece[face.cell[0]]], floating_number_[mesh_->cell_piece[face.cell[1]]]));
    std::vector<Real> row;
    for (const auto& motion : motions[group]) row.push_back(mesh::dot(slide.along, jump(slide.face, motion)));
    const std::size_t n = row.size();
    for (std::size_t r = 0; r < n; ++r) {
      forms[group].vector[r] += face.area * row[r] * slide.done;
      for (std::size_t s = 0; s < n && row[r] != 0; ++s) forms[group].matrix[r * n + s] += face.area * row[r] * row[s];
    }
  }
  for (auto& form : forms) {
    form.matrix = base::sum_over_ranks(*mesh_->comm, form.matrix);
    form.vector = base::sum_over_ranks(*mesh_->comm, form.vector);
  }
  return forms;
}

/// Computes generalised eigenvectors of slip form and distance form, group by group. In their coordinates both forms
/// are diagonal. The weight of vectors with slip is their share of the slip form. The weight of others is very small,
/// so that they yield if an obstacle involves both kinds. Slip below 1e-6 of the motion is round-off of the free
/// motions and does not count; otherwise the least slip would require an unbounded motion.
FloatingPieces::Places FloatingPieces::places(const fields::Vector& displacement,
                                              const std::vector<Slide>& slides) const {
  constexpr Real little = 1e-8;
  const auto motions = motions_of_groups();
  auto distance = distance_form(motions, displacement), slip = slip_form(motions, slides);
  std::vector<std::vector<Real>> share;  // [group][eigenvector] share of the slip form
  Real largest = 0, size = 0, area = 0;
  for (const auto& slide : slides) area += is_beside(slide.face) ? mesh_->fracture_faces[slide.face].area : 0;
  area = base::sum_over_ranks(*mesh_->comm, area);
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const int n = static_cast<int>(motions[g].size()), n_work = 64 * n;
    for (int r = 0; r < n; ++r) size = std::max(size, distance[g].matrix[r * n + r]);
    std::vector<Real> values(n), work(n_work);
    int info = 0;
    Teuchos::LAPACK<int, Real>().SYGV(1, 'V', 'U', n, slip[g].matrix.data(), n, distance[g].matrix.data(), n,
                                      values.data(), work.data(), n_work, &info);
    SPREKK_CHECK(info == 0, "rigid motions: LAPACK's SYGV failed with {}", info);
    largest = std::max(largest, values[n - 1]);
    share.push_back(values);
  }
  if (largest * size <= negligible * negligible * area) largest = 0;
  Places places{std::vector<RigidRow>(floating_.size(), RigidRow{}), {}, std::sqrt((largest > 0 ? largest : 1) * size)};
  for (std::size_t g = 0; g < groups_.size(); ++g)
    for (std::size_t k = 0; k < motions[g].size(); ++k) {
      const bool slips = largest > 0 && share[g][k] > negligible * negligible * largest;
      const auto& vector = slips ? slip[g].vector : distance[g].vector;
      const Real* x = &slip[g].matrix[k * vector.size()];
      const Real there = -std::inner_product(vector.begin(), vector.end(), x, Real(0)) / (slips ? share[g][k] : 1);
      const Real weight = slips ? share[g][k] : largest > 0 ? little * largest : 1;
      places.axes.emplace_back(floating_.size(), RigidRow{});
      for (std::size_t r = 0; r < vector.size(); ++r)
        for (std::size_t l = groups_[g].first;
             l < floating_.size() && group_of(static_cast<int>(l)) == static_cast<int>(g); ++l)
          for (int c = 0; c < 6; ++c) {
            places.axes.back()[l][c] += x[r] / std::sqrt(weight) * motions[g][r][l][c];
            places.nearest[l][c] += x[r] * there * motions[g][r][l][c];
          }
    }
  return places;
}

std::optional<std::vector<RigidRow>> FloatingPieces::nearest(const Places& places,
                                                             const std::vector<Obstacle>& obstacles, Real unit) const {
  const int n = static_cast<int>(places.axes.size());
  const Real scale = places.unit * unit;
  std::vector<std::vector<Real>> here, G;
  for (const auto& obstacle : obstacles) {
    here.emplace_back();
    for (const auto& axis : places.axes)
      here.back().push_back(scale * mesh::dot(obstacle.normal, jump(obstacle.face, axis)));
    here.back().push_back(obstacle.minimum - mesh::dot(obstacle.normal, jump(obstacle.face, places.nearest)));
  }
  std::vector<Real> h;
  for (auto& row : gather_rows(*mesh_->comm, here, n + 1)) {
    const Real minimum = row.back();
    row.pop_back();
    if (std::inner_product(row.begin(), row.end(), row.begin(), Real(0)) <= negligible * negligible * unit * unit)
      continue;
    G.push_back(row);
    h.push_back(minimum);
  }
  const auto x = least_distance(std::move(G), std::move(h), n);
  if (!x) return {};
  auto motion = places.nearest;
  for (int k = 0; k < n; ++k)
    for (std::size_t l = 0; l < motion.size(); ++l)
      for (int c = 0; c < 6; ++c) motion[l][c] += scale * (*x)[k] * places.axes[k][l][c];
  return motion;
}

}  // namespace sprekk::contact
