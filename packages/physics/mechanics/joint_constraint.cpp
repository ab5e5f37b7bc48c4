#include "physics/mechanics/joint_constraint.hpp"

#include "laws/joint.hpp"
#include "laws/joint_slopes.hpp"

#include <algorithm>

namespace sprekk::physics {

using laws::ContactState;

template <int dim>
void add_constraint(const laws::Joint& law, const std::array<mesh::Vector, 3>& frame,
                    const laws::JointPoint<dim>& point, const laws::History& history, bool given,
                    contact::Constraint& to) {
  Real p[dim - 1] = {}, shear[dim - 1], widening[dim] = {1};  // widening: derivative of w_n - g in w
  const auto contact = [&](Real normal, Real size) {
    return laws::contact<dim>(normal, size, p, point.p_old, history);
  };
  const Real compliance = law.compliance(contact(point.traction[0], 0));
  for (int k = 1; k < dim; ++k) {
    shear[k - 1] = point.traction[k];
    p[k - 1] = point.w[k] - compliance * shear[k - 1];
  }
  const Real slipped = laws::norm(p), sheared = laws::norm(shear);
  const bool moved = laws::augmentation(law, point.constant).tangential * slipped > 1e-13 * sheared;
  const Real dilates = laws::dilation_slope(law, contact(point.traction[0], slipped));
  for (int k = 1; k < dim; ++k) {
    const Real along = moved ? p[k - 1] / slipped : sheared > 0 ? shear[k - 1] / sheared : 0;
    widening[k] = -dilates * along;
  }
  to.augmentation += point.constant;
  to.weakens = law.n_history() > 0;
  to.gap += point.w[0] - law.normal_gap(contact(0, slipped));
  to.limit += std::max(law.bound(contact(point.traction[0], slipped)), Real(0));
  for (int k = 0; k < dim; ++k)
    for (int i = 0; i < dim; ++i) {
      to.traction[i] += point.traction[k] * frame[k][i];
      to.jump[i] += point.w[k] * frame[k][i];
      to.away[i] += widening[k] * frame[k][i];
      if (k > 0) to.slip[i] += (p[k - 1] - point.p_old[k - 1]) * frame[k][i];
    }
  Real bound[dim - 1];  // traction of the law; along the slip if there is any
  for (int k = 1; k < dim; ++k) bound[k - 1] = point.traction[k] - point.R[k];
  const Real size = laws::norm(bound);
  for (int k = 0; k < dim; ++k)
    for (int i = 0; i < dim; ++i) to.excess[i] += point.R[k] * frame[k][i];
  const bool open = point.state == ContactState::open;
  if (open && !given) return;
  Real constrained[dim][dim] = {};
  for (int k = 0; k < dim && !open; ++k)
    constrained[0][k] = point.state == ContactState::slip || k == 0 ? widening[k] : 0;
  for (int k = 1; k < dim; ++k)
    for (int l = 1; l < dim; ++l)
      if (point.state == ContactState::stick || given)
        constrained[k][l] = k == l;
      else if (size > 0)
        constrained[k][l] = (k == l) - bound[k - 1] * bound[l - 1] / (size * size);
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j)
      for (int k = 0; k < dim; ++k)
        for (int l = 0; l < dim; ++l) to.constrained[i][j] += constrained[k][l] * frame[k][i] * frame[l][j];
}

template void add_constraint<2>(const laws::Joint&, const std::array<mesh::Vector, 3>&, const laws::JointPoint<2>&,
                                const laws::History&, bool, contact::Constraint&);
template void add_constraint<3>(const laws::Joint&, const std::array<mesh::Vector, 3>&, const laws::JointPoint<3>&,
                                const laws::History&, bool, contact::Constraint&);

}  // namespace sprekk::physics
