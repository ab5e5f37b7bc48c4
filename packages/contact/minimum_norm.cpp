// Minimum-norm position of floating bodies among all admissible states.
#include "contact/contact.hpp"

#include "base/over_ranks.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace sprekk::contact {

using fields::Evaluation;
using mesh::Vector;
using mesh::operator+;
using mesh::operator-;
using mesh::operator*;

namespace {

constexpr Real min_load = 1e-10;           ///< smallest traction of a loaded face, relative to the traction scale
constexpr Real margin = 1e-10;             ///< gap of faces without load, relative to the displacement scale
constexpr Real at_limit = 1e-8;            ///< tolerance of the friction limit, relative
constexpr Real negligible_motion = 1e-10;  ///< smallest motion, relative to the displacement scale

/// Returns the rows of a b^T.
std::array<Vector, 3> product(const Vector& a, const Vector& b) { return {a[0] * b, a[1] * b, a[2] * b}; }

std::array<Vector, 3> identity() { return {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}; }

/// Sets the constraints of equilibrium states with unchanged tractions. A loaded face keeps its gap and sticks. At the
/// friction limit it may slide, along its shear traction if there is one. Appends these faces to `slides`.
void release(const mesh::Mesh& mesh, Real minimum, std::vector<Constraint>& constraints,
             std::vector<FloatingPieces::Slide>& slides) {
  for (std::size_t f = 0; f < constraints.size(); ++f) {
    auto& constraint = constraints[f];
    constraint.constrained = {};
    if (!(mesh::norm(constraint.traction) > minimum)) continue;
    const auto& frame = mesh.fracture_faces[f].frame;
    const Vector shear = constraint.traction - mesh::dot(constraint.traction, frame[0]) * frame[0];
    const Real size = mesh::norm(shear);
    if (size < (1 - at_limit) * constraint.limit - minimum) {
      constraint.constrained = identity();
      continue;
    }
    constraint.constrained = product(frame[0], constraint.away);
    const auto add = [&](const Vector& along, bool one_way) {
      slides.push_back({static_cast<LocalIndex>(f), along, mesh::dot(along, constraint.slip), one_way});
    };
    if (!(size > minimum)) {
      for (int k = 1; k < mesh.dim(); ++k) add(frame[k], false);
      continue;
    }
    const Vector along = (1 / size) * shear;
    add(along, true);
    const Vector across = mesh::cross(frame[0], along);
    const auto constrained = product(across, across);
    for (int i = 0; i < 3 && mesh.dim() == 3; ++i)
      constraint.constrained[i] = constraint.constrained[i] + constrained[i];
  }
}

/// Returns the largest difference. Collective.
Real distance(const RCP<fields::Vector>& a, const RCP<fields::Vector>& b) {
  fields::Vector difference(*a, Teuchos::Copy);
  difference.update(-1, *b, 1);
  return difference.normInf();
}

}  // namespace

/// Returns x after a free motion of the pieces. Collective.
Evaluation Contact::after(const Evaluation& x, const std::vector<RigidRow>& motion) const {
  auto there = x.x();
  auto& u = there[blocks_.motion];
  u = rcp(new fields::Vector(*u, Teuchos::Copy));
  pieces_->add(std::vector<Real>(pieces_->n_groups(), 1), {motion, {}}, *u);
  return distance(x.x()[blocks_.motion], u) > 0 ? Evaluation(there) : x;
}

/// Returns the nearest admissible state. Each pass adds two kinds of obstacles: faces with a gap below `minimum`
/// [face], linearised at the last motion, and faces that would slide against their traction. Empty: not found.
/// `unobstructed`: result of the first pass; empty before the first call. Collective.
Evaluation Contact::way_back(const Evaluation& x, const std::vector<FloatingPieces::Slide>& slides,
                             const std::vector<Real>& minimum, Evaluation& unobstructed) {
  constexpr int max_passes = 30;
  const Real length = equations_.sizes().motion, slack = 0.1 * margin * length;
  auto away = fields::Vector(*x.x()[blocks_.motion], Teuchos::Copy);
  away.update(-1, *committed_, 1);
  const auto places = pieces_->places(away, slides);
  std::vector<FloatingPieces::Obstacle> obstacles;
  for (int pass = 0; pass < max_passes; ++pass) {
    const auto motion = pieces_->nearest(places, obstacles, length);
    if (!motion) return {};
    const auto there = pass == 0 && !unobstructed.empty() ? unobstructed : after(x, *motion);
    if (pass == 0) unobstructed = there;
    const auto constraints = equations_.contact_constraints(there);
    const auto n_before = obstacles.size();
    for (LocalIndex f = 0; f < static_cast<LocalIndex>(constraints.size()); ++f) {
      const auto& constraint = constraints[f];
      if (pieces_->is_beside(f) && constraint.gap < minimum[f] - slack)
        obstacles.push_back(
            {f, constraint.away, minimum[f] - constraint.gap + mesh::dot(constraint.away, pieces_->jump(f, *motion))});
    }
    for (const auto& slide : slides) {
      const Real back = -std::max(slide.done, Real(0));
      if (slide.one_way && pieces_->is_beside(slide.face) &&
          mesh::dot(slide.along, pieces_->jump(slide.face, *motion)) < back - slack)
        obstacles.push_back({slide.face, slide.along, back});
    }
    if (!base::on_any_rank(*mesh_->comm, obstacles.size() > n_before)) return there;
  }
  return {};
}

bool Contact::place_at_minimum_norm(Evaluation& x) {
  if (!pieces_) return false;
  nearest_known_ = true;
  const auto sizes = equations_.sizes();
  const Real length = sizes.motion, minimum = min_load * sizes.multiplier;
  auto released = equations_.contact_constraints(x);
  std::vector<Real> apart, touching;
  for (const auto& constraint : released) {
    const bool is_free = !(mesh::norm(constraint.traction) > minimum);
    apart.push_back(is_free ? margin * length : -std::numeric_limits<Real>::infinity());
    touching.push_back(std::min({apart.back(), constraint.gap, Real(0)}));
  }
  std::vector<FloatingPieces::Slide> slides;
  release(*mesh_, minimum, released, slides);
  pieces_->find(released);
  if (!pieces_->any()) return false;
  Evaluation unobstructed;
  auto found = way_back(x, slides, apart, unobstructed);
  if (found.empty()) found = way_back(x, slides, touching, unobstructed);  // the piece fits without clearance
  nearest_known_ = !found.empty();
  if (found.empty()) return false;
  const auto before = std::exchange(x, found);
  return distance(before.x()[blocks_.motion], x.x()[blocks_.motion]) > negligible_motion * length;
}

}  // namespace sprekk::contact
