// Residual of joints with prescribed slip, compared with hand calculations.
#include "laws/prescribed_jump.hpp"

#include <gtest/gtest.h>

namespace sprekk::laws::testing {
namespace {

constexpr Real K = 2, c = 2;
const JointLaw<LinearShear, CoulombFriction, NormalGap<ConstantDilation, LinearClosure>> joint{
    {1 / K}, {0.6}, {0.1, {0.5}, {}}};

/// The shear traction may exceed the friction bound. Slip 3 opens the joint by 0.1 + 0.5 * 3.
TEST(PrescribedJump, FixesTheSlipOfClosedFaces) {
  const auto constants = augmentation(joint, c);
  const Real given[2] = {not_prescribed, -3}, p_old[1] = {1}, traction[2] = {-10, 8};
  const Real solution[2] = {1.6, -3 + 8 / K};
  Real R[2];
  EXPECT_EQ(prescribed_residual<2>(joint, constants, solution, traction, p_old, given, R), ContactState::stick);
  EXPECT_NEAR(R[0], 0, 1e-14);
  EXPECT_NEAR(R[1], 0, 1e-14);
  const Real other[2] = {1.5, 2};
  prescribed_residual<2>(joint, constants, other, traction, p_old, given, R);
  EXPECT_NEAR(R[0], 0.1 * constants.normal, 1e-14);
  EXPECT_NEAR(R[1], -1 * constants.tangential, 1e-14);
}

/// The normal traction of an open face vanishes; its slip 7 - 8/K differs by zero from the prescribed one.
TEST(PrescribedJump, FixesTheSlipOfOpenFaces) {
  const Real given[2] = {not_prescribed, 3}, p_old[1] = {0}, traction[2] = {-1, 8}, jump[2] = {50, 7};
  Real R[2];
  EXPECT_EQ(prescribed_residual<2>(joint, augmentation(joint, c), jump, traction, p_old, given, R), ContactState::open);
  EXPECT_EQ(R[0], -1);
  EXPECT_NEAR(R[1], 0, 1e-14);
}

/// A prescribed normal jump holds under tension.
TEST(PrescribedJump, FixesTheNormalJump) {
  const Real given[3] = {0.25, 1, -2}, p_old[2] = {0, 0}, traction[3] = {6, 2, 4}, jump[3] = {0.25, 2, 0};
  Real R[3];
  EXPECT_EQ(prescribed_residual<3>(joint, augmentation(joint, c), jump, traction, p_old, given, R),
            ContactState::stick);
  for (const Real r : R) EXPECT_NEAR(r, 0, 1e-14);
}

}  // namespace
}  // namespace sprekk::laws::testing
