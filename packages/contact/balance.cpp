// Line search along rigid motions of floating blocks.
#include "contact/contact.hpp"
#include "contact/zero_search.hpp"

#include <algorithm>
#include <cmath>

namespace sprekk::contact {

using fields::BlockVector;
using fields::Evaluation;

RCP<const fields::Vector> Contact::proximal(int block) const {
  return block == blocks_.motion && pieces_ && pieces_->any_weakly_held() ? Teuchos::rcpFromRef(pieces_->proximal())
                                                                          : Teuchos::null;
}

std::string Contact::floating() const {
  if (!pieces_ || !pieces_->any()) return "";
  return pieces_->describe(driven_.q.empty() ? pieces_->first() : driven_) +
         (nearest_known_ ? "" : " (the place nearest to the last one was not found)");
}

void Contact::find_floating(std::vector<Constraint> constraints) {
  if (!pieces_) return;
  if (regularisation_.proximal > 0)
    for (auto& constraint : constraints) constraint.constrained = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  pieces_->find(constraints);
  driven_ = {};
}

namespace {

constexpr int n_sweeps = 2;
/// Smallest unbalanced force along a mode, relative to the force scale. Smaller forces count as round-off. The limit is
/// below the tolerance of Newton's method: forces between the two would otherwise prevent convergence.
constexpr Real min_force = 1e-12;

}  // namespace

/// Returns the work of unbalanced forces at x on a motion, [group]. It is negative if the motion follows the force.
/// Collective.
std::vector<Real> Contact::work(const FloatingPieces::Motion& motion, const Evaluation& x) {
  auto r = fields::create_like(x.x());
  equations_.residual(x, r);
  return pieces_->work(motion, *r[blocks_.motion], equations_.contact_constraints(x));
}

/// Replaces the share of free motions in a step. Without resistance, the proximal term alone limits the motion: the
/// step is about 1e4 times too long. The free motion is removed from dx. The multiple of it that balances the forces
/// along it is added: until the piece touches or sticks. Remaining forces along the free motions are balanced one
/// motion after another.
std::string Contact::balance(const Evaluation& x, BlockVector& dx, Evaluation& end) {
  if (!pieces_ || !pieces_->any() || damped_everywhere_ > 0) return "";
  const auto motion = pieces_->part_of(*dx[blocks_.motion]);
  pieces_->add(std::vector<Real>(pieces_->n_groups(), -1), motion, *dx[blocks_.motion]);
  end = {};
  const auto unresisted = balance_along(motion, x.x(), dx, end, false);
  for (int sweep = 0; sweep < n_sweeps && unresisted.empty(); ++sweep)
    for (int k = 0; k < pieces_->max_modes(); ++k) balance_along(pieces_->mode(k), x.x(), dx, end, true);
  return unresisted;
}

/// Evaluates residuals, which are inexpensive compared with the Newton steps saved. All groups share the evaluations.
std::string Contact::balance_along(const FloatingPieces::Motion& motion, const BlockVector& x, BlockVector& dx,
                                   Evaluation& end, bool mode) {
  const int n = pieces_->n_groups();
  const auto after = [&](const std::vector<Real>& s) {
    auto y = fields::create_like(x);
    fields::copy(dx, y);
    pieces_->add(s, motion, *y[blocks_.motion]);
    for (std::size_t b = 0; b < x.size(); ++b) y[b]->update(1, *x[b], 1);
    return Evaluation(y);
  };
  std::vector<Real> s(n, 0), sign(n, 1);
  if (end.empty()) end = after(s);
  auto last = end;
  const auto start = work(motion, last);
  std::vector<ZeroSearch> searches;
  const auto sizes = equations_.sizes();
  const Real length = sizes.motion, force = sizes.force, reach = 4 * sizes.extent + 1e3 * length;
  for (int g = 0; g < n; ++g) {
    const Real largest = motion.largest[g];
    if (mode && start[g] > 0) sign[g] = -1;
    const bool round_off = mode ? !(std::abs(start[g]) > min_force * force * largest) : !(largest > 1e-8 * length);
    searches.emplace_back(round_off ? 0 : sign[g] * start[g], 0.1 * length / largest, reach / largest);
  }
  const auto all_done = [&] { return std::all_of(searches.begin(), searches.end(), [](auto& a) { return a.done(); }); };
  if (!mode) driven_ = pieces_->selected(motion, [&](int g) { return !searches[g].done(); });
  while (!all_done()) {
    for (int g = 0; g < n; ++g) s[g] = sign[g] * searches[g].s;
    const auto value = work(motion, last = after(s));
    for (int g = 0; g < n; ++g) searches[g].next(sign[g] * value[g]);
  }
  for (int g = 0; g < n; ++g)
    s[g] = !searches[g].lost() ? sign[g] * searches[g].s : mode ? 0 : length / motion.largest[g];
  const auto lost = pieces_->selected(motion, [&](int g) { return searches[g].lost(); });
  if (s != std::vector<Real>(n, 0)) {
    pieces_->add(s, motion, *dx[blocks_.motion]);
    end = lost.q.empty() ? last : Evaluation();
  }
  return lost.q.empty() ? "" : pieces_->describe(lost);
}

}  // namespace sprekk::contact
