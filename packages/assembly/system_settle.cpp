// Where a body is that nothing holds: of all places that the equations allow, the nearest one.
#include "assembly/system.hpp"

#include <Teuchos_CommHelpers.hpp>

#include <algorithm>
#include <cmath>

namespace sprekk::assembly {

using fields::BlockVector;

namespace {

constexpr Real loaded = 1e-10;  ///< share of the scale that a traction has at least
constexpr Real margin = 1e-10;  ///< of the displacement scale, by which faces without load stay apart

/// What holds in a state of equilibrium whatever else changes: faces under load, but for frictionless sliding.
void keep_loaded(std::vector<Grip>& grips, Real least) {
  for (auto& grip : grips) {
    if (!(mesh::norm(grip.traction) > least)) {
      grip.held = {};
      continue;
    }
    const mesh::Vector& n = grip.away;
    const Real length = mesh::norm(n), pressure = std::abs(mesh::dot(n, grip.traction)) / length;
    const bool slides =
        length < 1 + 1e-12 && mesh::dot(grip.traction, grip.traction) - pressure * pressure < least * least;
    if (slides) continue;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) grip.held[i][j] = i == j;
  }
}

}  // namespace

/// The free motion to the nearest state without load on the faces that are free of it; each pass adds the faces that
/// would close in the last one, as they are seen from there.
std::optional<std::vector<RigidRow>> System::way_back(const BlockVector& x, Real margin) {
  constexpr int most_passes = 30;
  const auto move = [&](const std::vector<RigidRow>& q, fields::Vector& u) {
    loose_->add(std::vector<Real>(loose_->n_groups(), 1), {q, {}}, u);
  };
  auto there = fields::create_like(x);
  auto away = fields::Vector(*x[displacement_], Teuchos::Copy);
  away.update(-1, *committed_, 1);
  refresh_ghosts(x, false);
  std::vector<char> is_free;
  for (const auto& grip : grips()) is_free.push_back(!(mesh::norm(grip.traction) > loaded * scales_.stress));
  std::vector<LoosePieces::Obstacle> obstacles;
  for (int pass = 0; pass < most_passes; ++pass) {
    const auto motion = loose_->nearest(away, obstacles, scales_.length);
    if (!motion) return {};
    fields::copy(x, there);
    move(*motion, *there[displacement_]);
    refresh_ghosts(there, false);
    const auto grips = this->grips();
    int here = 0, anywhere = 0;
    for (LocalIndex f = 0; f < static_cast<LocalIndex>(grips.size()); ++f) {
      if (!is_free[f] || !loose_->is_beside(f) || grips[f].gap >= margin - 0.1 * std::abs(margin)) continue;
      const Real least = margin - grips[f].gap + mesh::dot(grips[f].away, loose_->jump(f, *motion));
      obstacles.push_back({f, grips[f].away, least});
      here = 1;
    }
    Teuchos::reduceAll(*comm(), Teuchos::REDUCE_MAX, 1, &here, &anywhere);
    if (!anywhere) return motion;
  }
  return {};
}

bool System::settle(BlockVector& x) {
  if (!watches_pieces()) return false;
  refresh_ghosts(x, false);
  auto released = grips();
  keep_loaded(released, loaded * scales_.stress);
  loose_->find(released);
  if (!loose_->any()) return false;
  auto motion = way_back(x, margin * scales_.length);
  if (!motion) motion = way_back(x, -1e-2 * margin * scales_.length);  // it fits in between without room to spare
  if (motion) loose_->add(std::vector<Real>(loose_->n_groups(), 1), {*motion, {}}, *x[displacement_]);
  return motion.has_value();
}

}  // namespace sprekk::assembly
