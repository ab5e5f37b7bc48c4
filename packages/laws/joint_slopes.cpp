#include "laws/joint_slopes.hpp"

#include <Sacado.hpp>

namespace sprekk::laws {

namespace {

using Fad1 = Sacado::Fad::SFad<Real, 1>;

/// Copy of the contact state with derivatives set by `seed`.
template <class Seed>
Contact<Fad1> differentiated(const Contact<Real>& at, const Seed& seed) {
  Contact<Fad1> with;
  with.dim = at.dim;
  with.lambda_n = at.lambda_n;
  with.shear = at.shear;
  with.plastic_slip = at.plastic_slip;
  with.slip_of_step = at.slip_of_step;
  with.separation = at.separation;
  for (int i = 0; i < 2; ++i) {
    with.plastic_jump[i] = at.plastic_jump[i];
    with.slip_direction[i] = at.slip_direction[i];
    with.last_plastic_jump[i] = at.last_plastic_jump[i];
  }
  with.history = at.history;
  with.duration = at.duration;
  seed(with);
  return with;
}

/// Seeds further slip in its direction; without slip along the plastic jump, or along the first tangent.
void along_slip(Contact<Fad1>& at) {
  const Real jumps[2] = {at.plastic_jump[0].val(), at.plastic_jump[1].val()}, size = norm(jumps);
  Real direction[2] = {at.slip_direction[0].val(), at.slip_direction[1].val()};
  if (direction[0] == 0 && direction[1] == 0) {
    direction[0] = size > 0 ? jumps[0] / size : 1;
    direction[1] = size > 0 ? jumps[1] / size : 0;
  }
  Real along = 0;
  for (int i = 0; i < 2; ++i) {
    const Real jump = jumps[i];
    along += jump * direction[i];
    at.slip_direction[i] = direction[i];
    at.plastic_jump[i] = Fad1(1, jump);
    at.plastic_jump[i].fastAccessDx(0) = direction[i];
  }
  at.slip_of_step = Fad1(1, 0, at.slip_of_step.val());
  at.plastic_slip = Fad1(1, 0, at.plastic_slip.val());
  if (size > 0) at.plastic_slip.fastAccessDx(0) = along / size;
}

}  // namespace

Real bound_slope(const Joint& law, Real compression) {
  Contact<Fad1> at;
  at.lambda_n = Fad1(1, 0, -compression);
  const Real zero = 0;
  at.history = {&zero, 0};
  return -law.bound(at).dx(0);
}

Real weakening(const Joint& law, const Contact<Real>& at) { return -law.bound(differentiated(at, along_slip)).dx(0); }

Real compliance_slope(const Joint& law, const Contact<Real>& at) {
  return law.compliance(differentiated(at, [](auto& with) { with.lambda_n = Fad1(1, 0, with.lambda_n.val()); })).dx(0);
}

Real dilation_slope(const Joint& law, const Contact<Real>& at) {
  return law.normal_gap(differentiated(at, along_slip)).dx(0);
}

}  // namespace sprekk::laws
