// All laws of joints that a scene can name, by role; the first of each list is the one of joints that name none.
#pragma once

#include "laws/closure/barton_bandis.hpp"
#include "laws/closure/linear.hpp"
#include "laws/dilation/constant_angle.hpp"
#include "laws/friction/barton_choubey.hpp"
#include "laws/friction/coulomb.hpp"
#include "laws/shear/linear.hpp"

namespace sprekk::laws {

// a line for each law
// clang-format off

/// The elastic part of the tangential jump: T compliance(Contact<T>), u_t^e per lambda_t, m/Pa; Real
/// initial_compliance().
using ShearKinds = Kinds<
    LinearShear>;

/// The bound on the shear traction: T bound(Contact<T>), Pa.
using FrictionKinds = Kinds<
    CoulombFriction,
    BartonChoubeyFriction>;

/// How slip opens the joint: T opening(Contact<T>), m.
using DilationKinds = Kinds<
    ConstantDilation>;

/// How compression closes the joint: T opening(Contact<T>), m, negative; Real initial_compliance(), m/Pa.
using ClosureKinds = Kinds<
    BartonBandisClosure,
    LinearClosure>;

// clang-format on

}  // namespace sprekk::laws
