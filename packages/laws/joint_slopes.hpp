// Derivatives of joint laws with respect to the contact state.
#pragma once

#include "laws/joint.hpp"

namespace sprekk::laws {

/// Slope -db/dlambda_n of the bound of a joint without slip.
Real bound_slope(const Joint& law, Real compression);

/// Slope -db/ds, Pa/m, of the bound with respect to further slip in the step; positive for slip weakening.
Real weakening(const Joint& law, const Contact<Real>& at);

/// Derivative of the tangential compliance by the normal traction, m/Pa^2.
Real compliance_slope(const Joint& law, const Contact<Real>& at);

/// Opening per plastic slip, m/m. `at` contains the history variables of the joint.
Real dilation_slope(const Joint& law, const Contact<Real>& at);

}  // namespace sprekk::laws
