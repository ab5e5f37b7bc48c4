// Lists of the joint laws that a scene can name, one list for each role. The first law of each list is the default.
#pragma once

#include "laws/aperture_kinds.hpp"
#include "laws/bond/constant.hpp"
#include "laws/bond/linear_softening.hpp"
#include "laws/bond/none.hpp"
#include "laws/bond/sharp_front.hpp"
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
#include "laws/dilation/rate_dilatancy.hpp"
#include "laws/friction/barton_choubey.hpp"
#include "laws/friction/composed.hpp"
#include "laws/friction/coulomb.hpp"
#include "laws/friction/mobilised_barton_choubey.hpp"
#include "laws/friction/no_slip.hpp"
#include "laws/friction/rate_state.hpp"
#include "laws/friction/slip_weakening.hpp"
#include "laws/shear/linear.hpp"
#include "laws/shear/power.hpp"

namespace sprekk::laws {

// One line for each law.
// clang-format off

/// Elastic part of the tangential jump: T compliance(Contact<T>), u_t^e per lambda_t, m/Pa; Real initial_compliance(),
/// at zero traction.
using ShearKinds = Kinds<
    LinearShear,
    PowerShear>;

/// Bound on the shear traction: T bound(Contact<T>), Pa. Laws that may depend on the slip rate also have
/// bool depends_on_rate(); Real hardening(Contact<Real>), Pa/m; Real softening(Contact<Real>), 1/m, see rated_slip.hpp.
using FrictionKinds = Kinds<
    CoulombFriction,
    BartonChoubeyFriction,
    MobilisedBartonChoubeyFriction,
    ComposedFriction,
    SlipWeakeningFriction,
    NoSlip,
    AgeingFriction,
    SlipLawFriction>;

/// Opening of the joint by slip: T opening(Contact<T>), m. It may depend on the length of the step only with friction
/// that depends on the slip rate.
using DilationKinds = Kinds<
    ConstantDilation,
    MobilisedDilation,
    DecayingDilation,
    LimitedDilation,
    RateDilatancy>;

/// Closure of the joint by compression: T opening(Contact<T>), m, negative; Real initial_compliance(), m/Pa.
using ClosureKinds = Kinds<
    BartonBandisClosure,
    BartonBandisCycles,
    BandisClosure,
    PowerClosure,
    LinearClosure>;

/// Strength in addition to friction: Cohesion<T> cohesion(Contact<T>).
using BondKinds = Kinds<
    NoBond,
    ConstantBond,
    SofteningBond,
    SharpFrontBond>;

/// Damage of friction and dilation by slip: Left<T> left(Contact<T>), the remaining fractions.
using DamageKinds = Kinds<
    NoDamage,
    IsotropicDamage,
    AnisotropicDamage>;

/// Damage per unit of slip: T wear(Contact<T>).
using DriverKinds = Kinds<
    SlipDriver,
    CompressionDriver,
    WorkDriver>;

// clang-format on

}  // namespace sprekk::laws
