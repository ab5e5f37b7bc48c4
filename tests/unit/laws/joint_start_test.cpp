// Joints in situ: the unloaded joint from the aperture under load. Reference values come from an independent Python
// program, which solves the regressions of Bandis with Brent's method.
#include "laws/conduit.hpp"
#include "laws/joint_start.hpp"
#include "unit/base/message.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace sprekk::laws::testing {
namespace {

using base::message_of;
using Traction = std::array<Real, 3>;

constexpr Real digits = 1e-9;  // relative; the reference values have ten digits

JointParameters in_situ(const Closure& closure, Real aperture, Real slip = 0, const Dilation& dilation = {}) {
  JointParameters joint;
  joint.law.friction = CoulombFriction{0.6};
  joint.law.gap = {0, dilation, closure};
  joint.initial_aperture = aperture;
  joint.plastic_jump = {slip, 0};
  joint.in_situ = true;
  return joint;
}

BartonBandisClosure hyperbola() {
  BartonBandisClosure law;
  law.stiffness = 20e9;
  law.maximum = 0.2e-3;
  return law;
}

BandisClosure bandis(Real JRC, Real JCS, Real cycle) {
  BandisClosure law;
  law.roughness = JRC;
  law.wall_strength = JCS;
  law.cycle = cycle;
  law.complete();
  return law;
}

/// Aperture of an unloaded() joint under a compression.
Real aperture_under(const JointParameters& joint, Real N, int dim = 2) {
  return joint.initial_aperture + start_of(joint, {-N, 0, 0}, dim).jump[0];
}

struct Row {
  const char* name;
  JointParameters joint;
  Real N, unloaded, at_twice;  ///< Pa; apertures without load, and under 2 N, m
};

std::vector<Row> rows() {
  BartonBandisCycles memory;
  memory.stiffness = 20e9;
  memory.maximum = 0.2e-3;
  memory.retained = 0.4;
  memory.past = 20e6;
  const Real tangent = tangent_of_degrees(5);
  const ConstantDilation constant{tangent};
  const DecayingDilation decaying{tangent, 0, 0.5e-3};
  return {{"linear", in_situ(LinearClosure{1 / 50e9}, 0.12e-3), 8e6, 2.8e-4, -4e-5},
          {"hyperbola", in_situ(hyperbola(), 0.12e-3), 8e6, 2.533333333333e-4, 9.333333333e-5},
          {"higher load", in_situ(hyperbola(), 0.12e-3), 25e6, 2.924137931034e-4, 1.072286079e-4},
          {"narrow", in_situ(hyperbola(), 0.05e-3), 8e6, 1.833333333333e-4, 2.333333333e-5},
          {"power 0.5", in_situ(PowerClosure{50e9, 1e6, 0.5}, 0.12e-3), 8e6, 2e-4, 7.507577498e-5},
          {"power 1", in_situ(PowerClosure{50e9, 1e6, 1}, 0.12e-3), 8e6, 1.6394449155e-4, 1.072802247e-4},
          {"power 2", in_situ(PowerClosure{50e9, 10e6, 2}, 0.12e-3), 8e6, 2.088888889e-4, 8.581196581e-5},
          {"memory", in_situ(memory, 0.12e-3), 8e6, 2.666666667e-4, 1.04e-4},
          {"slip", in_situ(hyperbola(), 0.12e-3, 1e-3, constant), 8e6, 1.658446698e-4, 9.333333333e-5},
          {"decaying", in_situ(hyperbola(), 0.12e-3, 1e-3, decaying), 8e6, 2.155091531e-4, 9.333333333e-5}};
}

TEST(JointInSitu, HasTheUnloadedApertureOfEachLaw) {
  for (const auto& [name, measured, N, a0, at_twice] : rows())
    for (const int dim : {2, 3}) {
      SCOPED_TRACE(name);
      const auto joint = unloaded(measured, {-N, 0, 0}, dim);
      EXPECT_NEAR(joint.initial_aperture, a0, digits * a0);
      EXPECT_NEAR(aperture_under(joint, N, dim), measured.initial_aperture, 1e-18);
      EXPECT_NEAR(aperture_under(joint, 2 * N, dim), at_twice, digits * std::abs(a0));
    }
}

TEST(JointInSitu, StartsFromThePlasticJumpAndTheElasticJump) {
  auto measured = in_situ(hyperbola(), 0.12e-3, 1e-3, ConstantDilation{tangent_of_degrees(5)});
  measured.law.elastic = LinearShear{1 / 10e9};
  measured.plastic_jump = {0.6e-3, -0.8e-3};
  const Traction traction = {-8e6, 1e6, 2e6};
  const auto joint = unloaded(measured, traction, 3);
  const auto start = start_of(joint, traction, 3);
  EXPECT_NEAR(joint.initial_aperture, 1.658446698e-4, digits * 1e-4);
  EXPECT_NEAR(start.jump[0], 8.748866353e-5 - 1.333333333e-4, 1e-13);
  EXPECT_NEAR(start.jump[1], 0.6e-3 + 1e-4, 1e-15);
  EXPECT_NEAR(start.jump[2], -0.8e-3 + 2e-4, 1e-15);
  EXPECT_EQ(start.traction, traction);
}

/// The regressions depend on the unloaded aperture.
TEST(BandisInSitu, SolvesForTheUnloadedAperture) {
  const auto unloaded_aperture = [](Real JRC, Real JCS, Real cycle, Real N, Real a) {
    const auto joint = unloaded(in_situ(bandis(JRC, JCS, cycle), a), {-N, 0, 0}, 2);
    EXPECT_NEAR(aperture_under(joint, N), a, 1e-18);
    joint.law.gap.closure.visit([&](const auto& law) {
      if constexpr (requires { law.smaller_aperture(N); }) {
        EXPECT_NEAR(law.aperture, joint.initial_aperture, 1e-18);  // law and fracture have the same aperture
      }
      return 0;
    });
    return joint.initial_aperture;
  };
  EXPECT_NEAR(unloaded_aperture(8, 100e6, 3, 8e6, 0.12e-3), 1.805838008943e-4, 1e-16);
  EXPECT_NEAR(unloaded_aperture(8, 100e6, 1, 8e6, 0.12e-3), 2.537248821553e-4, 1e-16);
}

/// Of two unloaded apertures, the larger one counts; with it the aperture under load grows.
TEST(BandisInSitu, TakesTheLargerOfTwoApertures) {
  const Real N = 8e6, a = 0.042e-3;
  const auto joint = unloaded(in_situ(bandis(8, 100e6, 1), a), {-N, 0, 0}, 2);
  EXPECT_NEAR(joint.initial_aperture, 0.0992e-3, 0.5e-7);
  EXPECT_NEAR(smaller_aperture(joint, start_of(joint, {-N, 0, 0}, 2)), 0.0519e-3, 0.5e-7);
  EXPECT_GT(unloaded(in_situ(bandis(8, 100e6, 1), 1.001 * a), {-N, 0, 0}, 2).initial_aperture, joint.initial_aperture);
  const auto wide = unloaded(in_situ(bandis(8, 100e6, 1), 0.12e-3), {-N, 0, 0}, 2);
  EXPECT_EQ(smaller_aperture(wide, start_of(wide, {-N, 0, 0}, 2)), 0);
}

/// Just above the least aperture both solutions lie between two samples of the scan.
TEST(BandisInSitu, FindsAnApertureCloseToTheLeastOne) {
  const Real N = 8e6, least = 0.038036267297888e-3;
  for (const Real part : {1 + 1e-8, 1 + 1e-6, 1.01}) {
    const auto joint = unloaded(in_situ(bandis(8, 100e6, 1), part * least), {-N, 0, 0}, 2);
    EXPECT_NEAR(aperture_under(joint, N), part * least, 1e-18);
    EXPECT_GT(joint.initial_aperture, 0.0718564e-3);
  }
  const auto message = message_of([&] { unloaded(in_situ(bandis(8, 100e6, 1), (1 - 1e-8) * least), {-N, 0, 0}, 2); });
  EXPECT_CONTAINS(message, "must be at least 3.80363e-05 m");
}

TEST(BandisInSitu, RefusesAnApertureOutsideOfTheRegressions) {
  const auto message = [](Real JRC, Real JCS, Real cycle, Real N, Real a) {
    return message_of([&] { unloaded(in_situ(bandis(JRC, JCS, cycle), a), {-N, 0, 0}, 2); });
  };
  EXPECT_CONTAINS(message(10, 150e6, 3, 20e6, 0.05e-3), "must be at least 9.179");
  EXPECT_CONTAINS(message(2, 100e6, 3, 1e6, 5e-3), "must be at most");  // K_n would be negative
}

/// With a given "joint aperture" the law is known, and only the aperture of the fracture is computed.
TEST(BandisInSitu, UsesAGivenJointAperture) {
  auto law = bandis(8, 100e6, 3);
  law.aperture = 0.2e-3;
  law.complete();
  const auto joint = unloaded(in_situ(law, 0.12e-3), {-8e6, 0, 0}, 2);
  EXPECT_NEAR(joint.initial_aperture, 0.12e-3 + 8e6 / (law.stiffness + 8e6 / law.maximum), 1e-18);
}

/// The initial shear traction of open sides is released: only the plastic jump remains.
TEST(JointStart, HasNoElasticJumpIfTheSidesAreApart) {
  JointParameters joint;
  joint.law.elastic = LinearShear{1 / 1e9};
  joint.law.friction = CoulombFriction{0.6};
  joint.plastic_jump = {1e-4, -2e-4};
  const Traction shear = {0, 2e6, -3e6};
  for (const int dim : {2, 3})
    for (const Real normal : {-8e6, 0.0, 1e6}) {
      const auto start = start_of(joint, {normal, shear[1], dim == 3 ? shear[2] : 0}, dim);
      for (int k = 1; k < dim; ++k) {
        const Real borne = normal < 0 ? shear[k] : 0;
        EXPECT_EQ(start.traction[k], borne) << normal;
        EXPECT_NEAR(start.jump[k], joint.plastic_jump[k - 1] + borne / 1e9, 1e-18) << normal;
      }
    }
}

TEST(JointInSitu, RefusesStatesThatItCannotHave) {
  const auto refused = [](const JointParameters& measured, const Traction& traction) {
    return message_of([&] {
      const auto joint = unloaded(measured, traction, 2);
      check_start(joint, start_of(joint, traction, 2), traction);
    });
  };
  auto joint = in_situ(hyperbola(), 0.12e-3);
  EXPECT_CONTAINS(refused(joint, {1e5, 0, 0}), "tension of 100000 Pa; it must be compressive or 0");
  EXPECT_CONTAINS(refused(joint, {-8e6, 4.9e6, 0}),
                  "is 4.9e+06 Pa under the normal traction -8e+06 Pa; it must be at "
                  "most the strength of the joint, 4.8e+06 Pa");
  joint.law.bond = SofteningBond{1e6, 2e6, 100, 1000};
  EXPECT_CONTAINS(refused(joint, {2.1e6, 0, 0}), "at most the tensile strength of the bond, 2e+06 Pa");
  EXPECT_CONTAINS(refused(joint, {-8e6, 5.9e6, 0}), "it must be at most the strength of the joint, 5.8e+06 Pa");
  const auto slipped = in_situ(hyperbola(), 0.12e-3, 1e-2, ConstantDilation{tangent_of_degrees(5)});
  EXPECT_CONTAINS(refused(slipped, {-8e6, 0, 0}), "the aperture must be at least 0.000741553 m");
  BartonBandisCycles memory;
  memory.stiffness = 20e9;
  memory.past = 7e6;
  EXPECT_CONTAINS(refused(in_situ(memory, 0.12e-3), {-8e6, 0, 0}), "must be at least the initial compression 8e+06 Pa");
  joint = in_situ(hyperbola(), 0.12e-3, 1e-3);
  joint.slip_path = 0.9e-3;
  EXPECT_CONTAINS(refused(joint, {-8e6, 0, 0}), "it must be at least the size of the plastic jump, 0.001 m");
}

/// A bond bears tension: the state is closed, and closure continues with the normal stiffness.
TEST(JointInSitu, MayBeUnderTensionWithABond) {
  auto measured = in_situ(hyperbola(), 0.12e-3);
  measured.law.bond = SofteningBond{1e6, 2e6, 100, 1000};
  const Traction traction = {1e6, 0, 0};
  const auto joint = unloaded(measured, traction, 2);
  EXPECT_NEAR(joint.initial_aperture, 0.12e-3 - 1e6 / 20e9, 1e-18);
  EXPECT_EQ(start_of(joint, traction, 2).traction, traction);
}

/// History variables result from one straight slip under the initial compression.
TEST(JointInSitu, HasTheHistoryOfItsSlip) {
  auto joint = in_situ(hyperbola(), 0.12e-3, 2e-3);
  joint.law.friction = SlipWeakeningFriction{0.6, 0.4, 10e-3};
  EXPECT_NEAR(start_of(joint, {-8e6, 0, 0}, 2).bound, 8e6 * (0.6 - 0.2 * 0.2), 1e-6);
  joint.slip_path = 5e-3;
  EXPECT_NEAR(start_of(joint, {-8e6, 0, 0}, 2).bound, 8e6 * (0.6 - 0.2 * 0.5), 1e-6);
  joint.in_situ = false;
  EXPECT_NEAR(start_of(joint, {-8e6, 0, 0}, 2).bound, 8e6 * 0.6, 1e-6);
}

TEST(JointInSitu, OverlapsUnderTheCompressionKnownByHand) {
  const auto overlap = [](const Closure& closure, Real a) {
    const auto joint = unloaded(in_situ(closure, a), {-8e6, 0, 0}, 2);
    return overlap_compression(joint, start_of(joint, {-8e6, 0, 0}, 2));
  };
  EXPECT_NEAR(overlap(LinearClosure{1 / 50e9}, 0.12e-3), 14e6, 1);
  EXPECT_NEAR(overlap(hyperbola(), 0.05e-3), 44e6, 1);
  EXPECT_NEAR(overlap(PowerClosure{50e9, 1e6, 0.5}, 0.12e-3), 35e6, 1);
  EXPECT_TRUE(std::isinf(overlap(hyperbola(), 0.12e-3)));
}

TEST(HydraulicAperture, HasTheMechanicalApertureOfAMeasuredOne) {
  const auto mechanical = [](Real JRC, Real e) {
    BartonAperture law{JRC};
    law.complete();
    EXPECT_NEAR(law.hydraulic(law.mechanical(e)), e, 1e-14 * e);
    return HydraulicAperture(law).mechanical(e);
  };
  EXPECT_NEAR(mechanical(8, 1e-5), 4.254636718e-5, digits * 4e-5);
  EXPECT_NEAR(mechanical(8, 5e-5), 9.513656920e-5, digits * 9e-5);
  EXPECT_NEAR(mechanical(8, 2e-4), 2e-4, 1e-18);
  EXPECT_NEAR(mechanical(12, 1e-5), 7.062794295e-5, digits * 7e-5);
  EXPECT_EQ(HydraulicAperture(MechanicalAperture()).mechanical(1e-4), 1e-4);
}

}  // namespace
}  // namespace sprekk::laws::testing
