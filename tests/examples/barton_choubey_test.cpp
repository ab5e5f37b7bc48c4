// The rough joint at a point: its bound, the bound's derivative, and a shear test.
#include "examples/barton_choubey.hpp"

#include <Sacado.hpp>
#include <gtest/gtest.h>

namespace sprekk::examples {
namespace {

const BartonChoubeyFriction rough{10, 50e6, 28, 70};

Real slope(const BartonChoubeyFriction& law, Real lambda_n) {
  using Fad = Sacado::Fad::SFad<Real, 1>;
  return law.bound(Fad(1, 0, lambda_n)).dx(0);
}

TEST(BartonChoubey, BoundAtAnglesKnownByHand) {
  const Real tan45 = 1, tan70 = std::tan(70 * std::acos(-1.0) / 180), tan28 = std::tan(28 * std::acos(-1.0) / 180);
  const BartonChoubeyFriction law{17, 50e6, 28, 70};
  EXPECT_NEAR(law.bound(-5e6), 5e6 * tan45, 1e-6);  // one decade below JCS: 28 + 17 degrees
  EXPECT_NEAR(law.bound(-80e6), 80e6 * tan28, 1e-6);
  EXPECT_NEAR(law.bound(-1.0), tan70, 1e-12);
  EXPECT_EQ(law.bound(0.0), 0);
  EXPECT_LT(law.bound(1.0), 0);
}

TEST(BartonChoubey, DerivativeIsThatOfTheBound) {
  for (Real lambda_n : {-1e8, -4e7, -1e6, -2e4, -10.0, 5.0}) {
    const Real h = 1e-4 * std::abs(lambda_n);
    const Real difference = (rough.bound(lambda_n + h) - rough.bound(lambda_n - h)) / (2 * h);
    EXPECT_NEAR(slope(rough, lambda_n), difference, 1e-7 * std::abs(difference)) << lambda_n;
  }
  EXPECT_TRUE(std::isfinite(slope(rough, 0)));
}

/// Shears a joint of tangential stiffness K_t to the jump s at the compression N and solves for the traction by
/// Newton's method on the law's residual, differentiated in lambda alone.
struct ShearTest {
  RoughJoint law;
  laws::ContactState state = laws::ContactState::open;

  std::array<Real, 2> traction(Real N, Real s) {
    using Fad = Sacado::Fad::SFad<Real, 2>;
    const auto c = laws::augmentation(law, 1e9);
    const Real p_old[1] = {0};
    const Fad w[2] = {law.gap.closure(-N), s};  // the faces just touch at this traction
    std::array<Real, 2> lambda = {-N, 0};
    for (int iteration = 0; iteration < 20; ++iteration) {
      const Fad x[2] = {Fad(2, 0, lambda[0]), Fad(2, 1, lambda[1])};
      Fad R[2];
      state = laws::contact_residual<2>(law, c, w, x, p_old, R);
      const Real det = R[0].dx(0) * R[1].dx(1) - R[0].dx(1) * R[1].dx(0);
      lambda[0] -= (R[1].dx(1) * R[0].val() - R[0].dx(1) * R[1].val()) / det;
      lambda[1] -= (R[0].dx(0) * R[1].val() - R[1].dx(0) * R[0].val()) / det;
    }
    return lambda;
  }
};

TEST(BartonChoubey, ShearTestSticksThenSlipsAtTheBound) {
  ShearTest test{{{1 / 1e10}, rough, {}}};
  test.law.gap.closure = {1e-3, 1e10};  // a normal stiffness, so that N follows from the opening
  const Real N = 3e6, b = rough.bound(-N);
  const auto elastic = test.traction(N, 0.5 * b / 1e10);
  EXPECT_EQ(test.state, laws::ContactState::stick);
  EXPECT_NEAR(elastic[0], -N, 1e-9 * N);
  EXPECT_NEAR(elastic[1], 0.5 * b, 1e-9 * b);
  const auto sliding = test.traction(N, 5 * b / 1e10);
  EXPECT_EQ(test.state, laws::ContactState::slip);
  EXPECT_NEAR(sliding[0], -N, 1e-9 * N);
  EXPECT_NEAR(sliding[1], b, 1e-9 * b);
}

}  // namespace
}  // namespace sprekk::examples
