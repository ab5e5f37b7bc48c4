// Rough joint of Barton and Choubey at one point, with linear closure: under constant compression, and in rock that
// resists its opening.
#include "point_scenes.hpp"

namespace sprekk::tests {
namespace {

using laws::ContactState;

Real tangent(Real degrees) { return std::tan(degrees * M_PI / 180); }
Real bound(Real N) { return N * tangent(30 + 10 * std::log10(100e6 / N)); }

/// The column of 2 GPa/m is in series with the joint of 2 GPa/m. The independent value of tau(1 MPa) has ten digits.
TEST(RoughJoint, SlidesAtItsStrength) {
  for (const auto& s : drive("rough_joint.xml")) {
    SCOPED_TRACE(s.t);
    const Real tau = 1.1917535926e6, trial = 1e9 * 1e-3 * s.t;
    EXPECT_EQ(s.contact, trial < tau ? ContactState::stick : ContactState::slip);
    EXPECT_NEAR(s.traction[1], std::min(trial, tau), 1e-3);
    const Real slip = std::max(1e-3 * s.t - tau / 1e9, Real(0));
    EXPECT_NEAR(s.plastic[1], slip, 1e-12);
    EXPECT_NEAR(s.jump[0], -1e6 / 20e9 + tangent(5) * slip, 1e-12);
    EXPECT_NEAR(s.elastic[0], -1e6 / 20e9, 1e-15);
  }
}

/// Angles of sliding slabs, for sigma_n = gamma h cos(t): independent roots of tan(t) = b(sigma_n)/sigma_n, ten
/// digits. With JRC 10, the slab slides at the bound on the friction angle, and without this bound it does not slide.
TEST(RoughJoint, SlabsSlideAtTheirAngle) {
  const std::map<std::string, Real> angles = {
      {"rough", 60.080516063}, {"smooth", 44.907117311}, {"very rough", 70}, {"very rough, no cap", 90}};
  for (const auto& curve : laboratory::drive_points(read("tilt.xml"))) {
    SCOPED_TRACE(curve.specimen + ": " + curve.failure);
    const Real angle = angles.at(curve.specimen);
    EXPECT_NEAR(static_cast<Real>(curve.states.size()), std::min(angle, Real(89)), 1);  // one per degree
    EXPECT_EQ(curve.failure.empty(), angle == 90);
    const std::string reported = "the last state is that at t = ";
    const auto at = curve.failure.find(reported);
    if (angle == 90) continue;
    ASSERT_NE(at, std::string::npos);
    EXPECT_NEAR(std::stod(curve.failure.substr(at + reported.size())), angle, 1e-7);
  }
}

/// Fixed rock of 5 GPa/m resists dilation: N (1/5 GPa/m + 1/20 GPa/m) = d + tan(theta) u_p. The displacement d causes
/// the initial 1 MPa.
TEST(RoughJoint, GainsStrengthWhereItCannotOpen) {
  const Real compliance = 1 / 5e9 + 1 / 20e9, d = 1e6 * compliance;
  for (const auto& s : drive("rough_joint.xml", {"Point.control={column, column}", "Point.column normal stiffness=5e9",
                                                 fmt::format("Point.path={{-{:.17g}, 1e-3*t}}", d)})) {
    SCOPED_TRACE(s.t);
    Real low = 1e6, high = 1e8;
    for (int k = 0; k < 200; ++k) {
      const Real N = (low + high) / 2, slip = std::max(1e-3 * s.t - bound(N) / 1e9, Real(0));
      (N * compliance < d + tangent(5) * slip ? low : high) = N;
    }
    EXPECT_NEAR(s.traction[0], -low, 1e-9 * low);
    EXPECT_NEAR(s.traction[1], std::min(1e6 * s.t, bound(low)), 1e-9 * low);
  }
}

}  // namespace
}  // namespace sprekk::tests
