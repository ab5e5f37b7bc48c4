// All laws of joints that a scene can name, by role; the first of each list is the one of joints that name none.
#pragma once

#include "laws/aperture_kinds.hpp"
#include "laws/bond/constant.hpp"
#include "laws/bond/linear_softening.hpp"
#include "laws/bond/none.hpp"
#include "laws/closure/bandis.hpp"
#include "laws/closure/barton_bandis.hpp"
#include "laws/closure/barton_bandis_cycles.hpp"
#include "laws/closure/linear.hpp"
#include "laws/closure/power.hpp"
#include "laws/damage/drivers.hpp"
#include "laws/damage/exponential.hpp"
#include "laws/damage/none.hpp"
#include "laws/dilation/constant_angle.hpp"
#include "laws/dilation/decaying_angle.hpp"
#include "laws/dilation/limited.hpp"
#include "laws/dilation/mobilised.hpp"
#include "laws/friction/barton_choubey.hpp"
#include "laws/friction/composed.hpp"
#include "laws/friction/coulomb.hpp"
#include "laws/friction/mobilised_barton_choubey.hpp"
#include "laws/friction/no_slip.hpp"
#include "laws/friction/slip_weakening.hpp"
#include "laws/shear/linear.hpp"
#include "laws/shear/power.hpp"

namespace sprekk::laws {

// a line for each law
// clang-format off

/// The elastic part of the tangential jump: T compliance(Contact<T>), u_t^e per lambda_t, m/Pa; Real
/// initial_compliance().
using ShearKinds = Kinds<
    LinearShear,
    PowerShear>;

/// The bound on the shear traction: T bound(Contact<T>), Pa.
using FrictionKinds = Kinds<
    CoulombFriction,
    BartonChoubeyFriction,
    MobilisedBartonChoubeyFriction,
    ComposedFriction,
    SlipWeakeningFriction,
    NoSlip>;

/// How slip opens the joint: T opening(Contact<T>), m.
using DilationKinds = Kinds<
    ConstantDilation,
    MobilisedDilation,
    DecayingDilation,
    LimitedDilation>;

/// How compression closes the joint: T opening(Contact<T>), m, negative; Real initial_compliance(), m/Pa.
using ClosureKinds = Kinds<
    BartonBandisClosure,
    BartonBandisCycles,
    BandisClosure,
    PowerClosure,
    LinearClosure>;

/// What holds the faces together beside friction: Cohesion<T> cohesion(Contact<T>).
using BondKinds = Kinds<
    NoBond,
    ConstantBond,
    SofteningBond>;

/// How slip wears friction and dilation: Left<T> left(Contact<T>).
using DamageKinds = Kinds<
    NoDamage,
    IsotropicDamage,
    AnisotropicDamage>;

/// How much a unit of slip wears: T wear(Contact<T>).
using DriverKinds = Kinds<
    SlipDriver,
    CompressionDriver,
    WorkDriver>;

// clang-format on

}  // namespace sprekk::laws
