// How the laws of a joint change with the state that they are evaluated at.
#pragma once

#include "laws/joint.hpp"

namespace sprekk::physics {

/// -db/dlambda_n of the bound of a joint that has not slipped.
Real bound_slope(const laws::Joint& law, Real compression);

/// -db/ds, Pa/m, of the bound with further slip of the step at a contact; above 0 where slip weakens the joint.
Real weakening(const laws::Joint& law, const laws::Contact<Real>& at);

/// Derivative of the tangential compliance in the normal traction, m/Pa^2.
Real compliance_slope(const laws::Joint& law, const laws::Contact<Real>& at);

/// How much the joint opens per plastic slip, m/m; `at` has the numbers that the joint keeps.
Real dilation_slope(const laws::Joint& law, const laws::Contact<Real>& at);

}  // namespace sprekk::physics
