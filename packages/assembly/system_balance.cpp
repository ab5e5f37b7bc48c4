// Rock that nothing holds: what it is, and how far a step may move it.
#include "assembly/system.hpp"
#include "assembly/zero_search.hpp"

#include <algorithm>
#include <cmath>

namespace sprekk::assembly {

using fields::BlockVector;

/// At the x of the last refresh_ghosts.
std::vector<Grip> System::grips() {
  std::vector<Grip> grips(mesh_->n_owned_fracture_faces);
  for (std::size_t m = 0; m < modules_.size(); ++m) modules_[m]->grip(state(static_cast<int>(m)), grips);
  return grips;
}

RCP<const fields::Vector> System::proximal(int block) const {
  return block == displacement_ && watches_pieces() && loose_->any() ? Teuchos::rcpFromRef(loose_->proximal())
                                                                     : Teuchos::null;
}

std::string System::loose() const {
  if (!watches_pieces() || !loose_->any()) return "";
  return loose_->describe(driven_.q.empty() ? loose_->first() : driven_) +
         (nearest_known_ ? "" : " (the place nearest to the last one was not found)");
}

void System::find_loose() {
  if (!watches_pieces()) return;
  auto found = grips();
  if (tether_ > 0)
    for (auto& grip : found) grip.held = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  loose_->find(found);
  driven_ = {};
}

namespace {

constexpr int n_sweeps = 2;

}  // namespace

/// [group] Of a motion, on what is out of balance at x; below zero where the motion is along the force.
std::vector<Real> System::work(const LoosePieces::Motion& motion, const BlockVector& x) {
  auto r = fields::create_like(x);
  residual(x, r);
  return loose_->work(motion, *r[displacement_], grips());
}

/// A piece that nothing holds goes as far as the full step says, 1e4 times too far. So its motion is taken out of the
/// step, and as much of it put back as brings the forces along it into balance: until the piece touches, or sticks.
/// After that the forces that are left along the free motions are balanced, one motion after the other.
std::string System::balance(const BlockVector& x, BlockVector& dx) {
  if (!watches_pieces() || !loose_->any() || damped_everywhere_ > 0) return "";
  const auto motion = loose_->part_of(*dx[displacement_]);
  loose_->add(std::vector<Real>(loose_->n_groups(), -1), motion, *dx[displacement_]);
  const auto unresisted = balance_along(motion, x, dx, false);
  for (int sweep = 0; sweep < n_sweeps && unresisted.empty(); ++sweep)
    for (int k = 0; k < loose_->most_modes(); ++k) balance_along(loose_->mode(k), x, dx, true);
  return unresisted;
}

/// Evaluations of residuals are cheap next to the Newton steps that they save; all groups share them.
std::string System::balance_along(const LoosePieces::Motion& motion, const BlockVector& x, BlockVector& dx, bool mode) {
  auto& du = *dx[displacement_];
  const int n = loose_->n_groups();
  auto y = fields::create_like(x);
  const auto at = [&](const std::vector<Real>& s) {
    for (std::size_t b = 0; b < x.size(); ++b) y[b]->update(1, *x[b], 1, *dx[b], 0);
    loose_->add(s, motion, *y[displacement_]);
    return work(motion, y);
  };
  std::vector<Real> s(n, 0), sign(n, 1);
  const auto start = at(s);
  std::vector<ZeroSearch> searches;
  const Real length = blocks_[displacement_].kinematic_scale, force = blocks_[displacement_].residual_scale;
  const Real reach = 4 * extent_ + 1e3 * length;
  for (int g = 0; g < n; ++g) {
    const Real largest = motion.largest[g];
    if (mode && start[g] > 0) sign[g] = -1;
    const bool round_off = mode ? !(std::abs(start[g]) > 1e-10 * force * largest) : !(largest > 1e-8 * length);
    searches.emplace_back(round_off ? 0 : sign[g] * start[g], 0.1 * length / largest, reach / largest);
  }
  const auto all_done = [&] { return std::all_of(searches.begin(), searches.end(), [](auto& a) { return a.done(); }); };
  if (!mode) driven_ = loose_->selected(motion, [&](int g) { return !searches[g].done(); });
  while (!all_done()) {
    for (int g = 0; g < n; ++g) s[g] = sign[g] * searches[g].s;
    const auto value = at(s);
    for (int g = 0; g < n; ++g) searches[g].next(sign[g] * value[g]);
  }
  for (int g = 0; g < n; ++g)
    s[g] = !searches[g].lost() ? sign[g] * searches[g].s : mode ? 0 : length / motion.largest[g];
  loose_->add(s, motion, du);
  const auto lost = loose_->selected(motion, [&](int g) { return searches[g].lost(); });
  return lost.q.empty() ? "" : loose_->describe(lost);
}

}  // namespace sprekk::assembly
