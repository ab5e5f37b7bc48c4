// Closure and tilt of rough joints, and stiffnesses that increase with compression: values by hand or computed
// independently.
#include "laws/joint.hpp"

#include <gtest/gtest.h>

namespace sprekk::laws::testing {
namespace {

template <class Law>
Real closed(const Law& law, Real N) {
  Contact<Real> at;
  at.lambda_n = -N;
  return -law.opening(at);
}

BandisClosure bandis(Real JRC, Real JCS, Real aperture, Real cycle = 1) {
  BandisClosure law;
  law.roughness = JRC;
  law.wall_strength = JCS;
  law.aperture = aperture;
  law.cycle = cycle;
  law.complete();
  return law;
}

TEST(BandisClosure, ByRoughnessStrengthAndAperture) {
  const auto first = bandis(10, 100e6, 0.2e-3), third = bandis(10, 100e6, 0.2e-3, 3);
  EXPECT_NEAR(first.stiffness, 20.35e9, 1);
  EXPECT_NEAR(first.maximum, .136870921e-3, 1e-12);
  EXPECT_NEAR(third.maximum, .061336252e-3, 1e-12);
  EXPECT_NEAR(closed(first, 1e6), .036158318e-3, 1e-12);
  EXPECT_NEAR(closed(first, 5e6), .087903172e-3, 1e-12);
  EXPECT_NEAR(closed(first, 20e6), .120139547e-3, 1e-12);
  EXPECT_NEAR(bandis(8, 150e6, 0.16e-3).stiffness, 25.6e9, 1);
  EXPECT_NEAR(bandis(8, 150e6, 0.16e-3).maximum, .078291540e-3, 1e-12);
  EXPECT_NEAR(bandis(12, 60e6, 0.24e-3).stiffness, 18.85e9, 1);
  EXPECT_NEAR(bandis(12, 60e6, 0.24e-3).maximum, .216157395e-3, 1e-12);
  EXPECT_EQ(first.defect(), "");
  EXPECT_NE(bandis(20, 100e6, 0.01e-3).defect(), "");  // the regression would give a negative closure
  EXPECT_NE(bandis(10, 100e6, 0.2e-3, 2).defect(), "");
}

TEST(PowerClosure, IsTheOthersForWholeExponents) {
  for (const Real N : {1e-3, 1e3, 1e6, 3e7, 1e9}) {
    EXPECT_DOUBLE_EQ(closed(PowerClosure{20e9, 3e6, 0}, N), closed(LinearClosure{1 / 20e9}, N));
    EXPECT_NEAR(closed(PowerClosure{20e9, 3e6, 2}, N) / closed(BartonBandisClosure{0.15e-3, 20e9}, N), 1, 1e-14);
    const Real logarithm = 3e6 / 20e9 * std::log1p(N / 3e6);
    EXPECT_NEAR(closed(PowerClosure{20e9, 3e6, 1}, N) / logarithm, 1, 1e-14);
    EXPECT_NEAR(closed(PowerClosure{20e9, 3e6, 1 + 1e-7}, N) / logarithm, 1, 1e-6);
  }
}

TEST(PowerShear, StiffensWithCompression) {
  Contact<Real> at;
  const PowerShear law{10e9, 2e6, 0.5};
  at.lambda_n = -6e6;
  EXPECT_NEAR(law.compliance(at) * 20e9, 1, 1e-15);
  at.lambda_n = 1e6;
  EXPECT_EQ(law.compliance(at), law.initial_compliance());
}

/// Angle at which a slab of 50 mm, 2700 kg/m^3 slides on a tilted joint: tau = b(N) with N = gamma h cos(a), tau =
/// gamma h sin(a) per joint area.
TEST(BartonChoubey, TiltOfASlab) {
  const auto slides_at = [](const BartonChoubeyFriction& law) {
    const Real weight = 2700 * 9.81 * 0.05;
    Real low = 0, high = 90;
    for (int k = 0; k < 200; ++k) {
      const Real angle = (low + high) / 2, a = angle * 3.14159265358979323846 / 180;
      Contact<Real> at;
      at.lambda_n = -weight * std::cos(a);
      (weight * std::sin(a) < law.bound(at) ? low : high) = angle;
    }
    return low;
  };
  EXPECT_NEAR(slides_at({6, 100e6, 29, 70}), 60.080516063, 1e-8);
  EXPECT_NEAR(slides_at({4, 50e6, 26, 70}), 44.907117311, 1e-8);
  EXPECT_NEAR(slides_at({10, 100e6, 30, 70}), 70, 1e-9);  // without the bound on the angle it would never slide
}

}  // namespace
}  // namespace sprekk::laws::testing
