// Initial state of a joint under a traction, and the unloaded joint from an aperture measured under it.
#pragma once

#include "laws/elasticity.hpp"
#include "laws/joint_parameters.hpp"

#include <array>
#include <vector>

namespace sprekk::laws {

/// State of a joint at the start of a run, in its frame (n, t1[, t2]).
struct JointStart {
  std::array<Real, 3> traction{};  ///< effective traction, Pa; zero if the sides are apart
  std::array<Real, 3> jump{};      ///< w_0, m
  Real closure = 0;                ///< B, m; negative under compression
  std::vector<Real> history;       ///< history variables of the law
  Real bound = 0;                  ///< b, Pa
  Real strength = 0;               ///< largest normal traction of the closed joint, Pa
};

/// Returns the initial state under a traction (Pa, tension positive) with the initial plastic jump p_0:
///   w_0 = (g0 + D(p_0) + B(lambda_n), p_0 + u_t^e(lambda))
/// The sides are together in compression, and in tension up to the strength of a bond. History variables are 0. Those
/// of a joint in situ result from loading to lambda_n and then one straight slip of length `slip_path` to p_0, at the
/// friction bound.
JointStart start_of(const JointParameters& joint, const std::array<Real, 3>& traction, int dim);

/// Derivative of the closure in the normal traction, m/Pa, in the initial state; of open joints that at first contact.
Real normal_compliance(const Joint& law, const JointStart& start);

/// Least normal jump under any compression without slip, m. Dilation laws with history variables have no bound, because
/// reversed slip may close the joint further than slip has opened it: lowest number.
Real least_opening(const Joint& law);

/// Length of the cohesive zone of a rupture, m, 9 pi/32 G*/(N w) (Day et al. 2005), with the decrease w of the friction
/// coefficient per slip, the effective compression N, Pa, and G* = G in 3D, G/(1 - nu) in 2D. Infinite for friction
/// that does not depend on the slip rate, also for slip weakening without radiation damping.
Real cohesive_zone(const Joint& law, const Elasticity& rock, Real compression, int dim);

/// Throws an Error if a joint in situ cannot have this state: tension above the strength, shear above the bound (except
/// friction that depends on the slip rate), or a path of slip below |p_0|.
void check_start(const JointParameters& joint, const JointStart& start, const std::array<Real, 3>& traction);

/// Returns the joint in situ with its unloaded aperture a0 = a - w_0,n, where a is `measured.initial_aperture`. The
/// closure law follows from the same aperture if it depends on it. Throws an Error if there is no such joint.
JointParameters unloaded(const JointParameters& measured, const std::array<Real, 3>& traction, int dim);

/// Smallest compression above the initial one under which the sides of an unloaded() joint overlap, a0 + w_n = 0, Pa;
/// infinite if there is none.
Real overlap_compression(const JointParameters& joint, const JointStart& start);

/// Second unloaded aperture, below that of the joint, with the same aperture under its initial traction, m; 0: none.
Real smaller_aperture(const JointParameters& joint, const JointStart& start);

}  // namespace sprekk::laws
