// Peak strength of a rough joint: angles by hand, published and independently computed values, a shear test.
#include "laws/joint.hpp"

#include <Sacado.hpp>
#include <gtest/gtest.h>

namespace sprekk::laws::testing {
namespace {

Real bound(const BartonChoubeyFriction& law, Real compression) {
  Contact<Real> at;
  at.lambda_n = -compression;
  return law.bound(at);
}

Real tangent_of(Real angle) { return tangent_of_degrees(angle); }

TEST(BartonChoubey, BoundAtAnglesKnownByHand) {
  const BartonChoubeyFriction law{17, 50e6, 28, 70};
  EXPECT_NEAR(bound(law, 5e6), 5e6, 1e-6);  // one decade below JCS: 28 + 17 degrees
  EXPECT_NEAR(bound(law, 80e6), 80e6 * tangent_of(28), 1e-6);
  EXPECT_NEAR(bound(law, 1), tangent_of(70), 1e-12);
  EXPECT_EQ(bound(law, 0), 0);
  EXPECT_LT(bound(law, -1), 0);
}

/// Barton and Choubey (1977): a joint that slides at 59 degrees under 1 kPa has JRC = (59 - 29)/log10(100/0.001) = 6.
/// The mean of 136 joints is JRC 8.9, JCS 92 MPa, phi_r 27.5 degrees.
TEST(BartonChoubey, PublishedJoints) {
  EXPECT_NEAR(bound({6, 100e6, 29, 70}, 1e3), 1e3 * tangent_of(59), 1e-9);
  EXPECT_NEAR(bound({8.9, 92e6, 27.5, 70}, 1e6), 1e6 * tangent_of(44.9777), 5);  // angle rounded to four decimals
}

/// Independently computed values, with ten digits. The last values are for larger blocks with smaller JRC and JCS.
TEST(BartonChoubey, StrengthUnderOneMegapascal) {
  EXPECT_NEAR(bound({10, 100e6, 30, 70}, 1e6), 1.1917535926e6, 1e-3);
  EXPECT_NEAR(bound({6.309573445, 50.118723363e6, 30, 70}, 1e6), .860933867e6, 1e-2);
  EXPECT_NEAR(bound({4.638742421, 13.757942342e6, 30, 70}, 1e6), .707553680e6, 1e-2);
  EXPECT_NEAR(bound({3.705672246, 31.901823284e6, 30, 70}, 1e6), .715207846e6, 1e-2);
}

/// Shear test of a joint with tangential stiffness K_t at the jump s and the compression N. Newton's method solves the
/// residual of the law for the traction; Sacado differentiates it in lambda only.
struct ShearTest {
  Joint law;
  ContactState state = ContactState::open;

  std::array<Real, 2> traction(Real N, Real s) {
    using Fad = Sacado::Fad::SFad<Real, 2>;
    const auto c = augmentation(law, 1e9);
    const Real p_old[1] = {0};
    Contact<Real> at;
    at.lambda_n = -N;
    const Fad w[2] = {law.normal_gap(at), s};  // the sides just touch at this traction
    std::array<Real, 2> lambda = {-N, 0};
    for (int iteration = 0; iteration < 20; ++iteration) {
      const Fad x[2] = {Fad(2, 0, lambda[0]), Fad(2, 1, lambda[1])};
      Fad R[2];
      state = contact_residual<2>(law, c, w, x, p_old, R);
      const Real det = R[0].dx(0) * R[1].dx(1) - R[0].dx(1) * R[1].dx(0);
      lambda[0] -= (R[1].dx(1) * R[0].val() - R[0].dx(1) * R[1].val()) / det;
      lambda[1] -= (R[0].dx(0) * R[1].val() - R[1].dx(0) * R[0].val()) / det;
    }
    return lambda;
  }
};

TEST(BartonChoubey, ShearTestSticksThenSlipsAtTheBound) {
  const BartonChoubeyFriction rough{10, 50e6, 28, 70};
  for (const Closure closure : {Closure(BartonBandisClosure{1e-3, 1e10}), Closure(LinearClosure{1e-10})}) {
    ShearTest test{{LinearShear{1 / 1e10}, rough, {0, {}, closure}}};
    const Real N = 3e6, b = bound(rough, N);
    const auto elastic = test.traction(N, 0.5 * b / 1e10);
    EXPECT_EQ(test.state, ContactState::stick);
    EXPECT_NEAR(elastic[0], -N, 1e-9 * N);
    EXPECT_NEAR(elastic[1], 0.5 * b, 1e-9 * b);
    const auto sliding = test.traction(N, 5 * b / 1e10);
    EXPECT_EQ(test.state, ContactState::slip);
    EXPECT_NEAR(sliding[0], -N, 1e-9 * N);
    EXPECT_NEAR(sliding[1], b, 1e-9 * b);
  }
}

}  // namespace
}  // namespace sprekk::laws::testing
