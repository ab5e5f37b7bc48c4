// Bonded joint at one point: linear softening in tension and in shear, and the state after loss of the bond.
#include "point_scenes.hpp"

namespace sprekk::tests {
namespace {

using laws::ContactState;

constexpr Real K = 2e12, strength = 10e6, end = 1e-5;  // the traction vanishes at the opening 2 G/T

Real softening(Real w) { return strength * (end - w) / (end - strength / K); }

/// The path loads along the softening branch, unloads and reloads along the secant, compresses with elastic closure
/// only, and opens beyond 2 G/T.
TEST(Bond, SoftensInTensionAndUnloadsAlongTheSecant) {
  const auto states = drive("bond.xml", {"Time.steps=11"});
  const Real secant = softening(7e-6) / 7e-6;
  const Real expected[] = {3e-6 * K, softening(7e-6), secant * 3.5e-6, -1e-6 * K, softening(7e-6), softening(9e-6), 0,
                           0,        -1e-6 * K};
  for (int k = 0; k < 9; ++k) EXPECT_NEAR(states[k].traction[0], expected[k], 1e-9 * strength) << k;
  EXPECT_EQ(states[1].contact, ContactState::stick);
  EXPECT_EQ(states[6].contact, ContactState::open);
  EXPECT_EQ(states[7].contact, ContactState::open);
  EXPECT_NEAR(states[9].traction[1], 0.5 * 2e6, 1e-3);  // only friction remains
  EXPECT_NEAR(states[10].traction[1], 0.5 * 2e6, 1e-3);
}

/// The steps of the scene itself include the peak.
TEST(Bond, TheCurveHasItsPeak) {
  Real largest = 0;
  for (const auto& s : drive("bond.xml")) largest = std::max(largest, s.traction[0]);
  EXPECT_NEAR(largest, strength, 1e-9 * strength);
}

/// A traction above the strength ends the curve. Earlier states are kept, and the message contains the strength.
TEST(Bond, KeepsTheStatesBeforeItBreaks) {
  const auto curves = laboratory::drive_points(
      laboratory::read_point_scene(*Tpetra::getDefaultComm(), source_dir() + "/xml/point/bond.xml",
                                   {"Point.control={traction, jump}", "Point.path={3e6*t, 0}", "Time.steps=11"}));
  ASSERT_EQ(curves.size(), 1u);
  ASSERT_EQ(curves[0].states.size(), 3u);
  EXPECT_NEAR(curves[0].states.back().traction[0], 9e6, 1e-3);
  for (const char* word : {"xml/point/bond.xml: Sprekk > Point: step 4 of 11, t = 4:", "tension of 1.2e+07 Pa",
                           "tensile strength, 1e+07 Pa"})
    EXPECT_NE(curves[0].failure.find(word), std::string::npos) << curves[0].failure;
}

/// Tension above the strength, then compression: the faces separate. The path continues in compression from the
/// tangential jump at the end of tension, with friction only: tau = K_t (w - w(4)), w = 2e-6 t.
TEST(Bond, GoesOnPastItsLoss) {
  for (const std::string control : {"{traction, jump}", "{traction, jump, jump}"}) {
    const bool flat = control == "{traction, jump}";
    const auto curves = laboratory::drive_points(
        read("bond.xml", {"Point.control=" + control, "Time.end=8", "Time.steps=16",
                          std::string("Point.path={12e6*sin(pi*t/4), 2e-6*t") + (flat ? "}" : ", 0}")}));
    ASSERT_EQ(curves[0].failure, "");
    const auto& states = curves[0].states;
    ASSERT_EQ(states.size(), 10u);  // two before the loss at 10 MPa, then from t = 4.5
    EXPECT_EQ(states[2].t, 4.5);
    for (const char* word : {"step 3 of 16, t = 1.5", "exceeds the tensile strength", "apart until they are pressed"})
      EXPECT_NE(states[2].remark.find(word), std::string::npos) << states[2].remark;
    for (std::size_t k = 2; k + 1 < states.size(); ++k) {
      const auto& s = states[k];
      const Real N = -12e6 * std::sin(M_PI * s.t / 4), elastic = 1e12 * 2e-6 * (s.t - 4);
      EXPECT_NEAR(s.traction[0], -N, 1e-6 * N) << s.t;
      EXPECT_NEAR(s.strength, 0.5 * N, 1e-6 * N) << s.t;
      if (elastic <= 0.5 * N) EXPECT_NEAR(s.traction[1], elastic, 1) << s.t;
      EXPECT_LE(s.traction[1], 0.5 * N + 1) << s.t;
    }
  }
}

/// A rigid joint opens at its strength; its traction at the opening o is T (1 - o/o_f), with o_f = 2 G/T.
TEST(Bond, RigidJointSoftensByItsOpening) {
  const std::vector<std::string> rigid = {"Materials.cemented joint.tangential stiffness=infinite",
                                          "Materials.cemented joint.closure=Barton-Bandis",
                                          "Materials.cemented joint.maximum closure=0", "Time.end=2", "Time.steps=20"};
  for (const std::string path : {"{1e-5*t, 0}", "{1e-5*t, 1e-7*t}"}) {
    auto overrides = rigid;
    overrides.push_back("Point.path=" + path);
    for (const auto& s : drive("bond.xml", overrides)) {
      const Real slip = path == "{1e-5*t, 0}" ? 0 : 1e-7 * s.t, by_slip = slip / (2 * 200 / 20e6);
      const Real left = 1 - 1e-5 * s.t / (2 * 50 / strength) - by_slip;
      EXPECT_NEAR(s.traction[0], strength * std::max(left, Real(0)), 1e-9 * strength) << s.t;
    }
  }
  auto column = rigid;  // opens and is compressed again
  column.insert(column.end(), {"Point.control={column, jump}", "Point.path={1e-4*sin(6*t), 1e-5*t}",
                               "Point.column normal stiffness=1e11"});
  const auto states = drive("bond.xml", column);
  for (const auto& s : states)
    if (std::sin(6 * s.t) < 0) EXPECT_NEAR(s.traction[0], 1e7 * std::sin(6 * s.t), 1) << s.t;
}

/// The area under the curve is the fracture energy, also with unloading in between.
TEST(Bond, DissipatesTheFractureEnergy) {
  for (const std::string path : {"1.2e-5*t", "1.2e-5*min(1, 1.5*t) - 1.2e-5*max(0, min(t - 0.2, 0.4 - t))"}) {
    const auto states = drive("bond.xml", {"Point.path={" + path + ", 0}", "Time.end=1", "Time.steps=240"});
    Real work = 0, w = 0, traction = 0;
    for (const auto& s : states) {
      work += (s.traction[0] + traction) / 2 * (s.jump[0] - w);
      w = s.jump[0];
      traction = s.traction[0];
    }
    EXPECT_NEAR(work, 50, path == "1.2e-5*t" ? 1e-9 * 50 : 0.01 * 50);
    EXPECT_EQ(states.back().contact, ContactState::open);
  }
}

/// A bond that softens faster than the joint unloads has two states below its strength: intact and lost. The result is
/// intact for any step length.
TEST(Bond, HoldsUpToItsStrengthIfItIsBrittle) {
  for (const std::string steps : {"1", "2", "5"}) {
    const auto pulled = [&](const std::string& path) {
      return drive("bond.xml", {"Materials.cemented joint.fracture energy=10", "Point.path={" + path + ", 0}",
                                "Time.end=1", "Time.steps=" + steps})
          .back();
    };
    EXPECT_NEAR(pulled("4e-6*t").traction[0], 4e-6 * K, 1e-9 * strength) << steps;
    EXPECT_EQ(pulled("6e-6*t").contact, ContactState::open) << steps;
  }
  const auto sheared =
      drive("bond.xml", {"Materials.cemented joint.shear fracture energy=20", "Time.end=1",
                         "Point.control={traction, jump}", "Point.path={-4e6, 15e-6*t}", "Time.steps=1"});
  EXPECT_NEAR(sheared[0].traction[1], 15e6, 1e-9 * strength);  // strength: 2 + 20 MPa
}

/// Under compression the bound is c + mu N. Slip reduces c linearly over the length 2 G/c: tau = mu N + c (1 - u c/(2
/// G)) with the slip u = w - tau/K_t.
TEST(Bond, LosesItsCohesionBySlip) {
  const Real c = 20e6, friction = 0.5 * 4e6, length = 2 * 400 / c, K_t = 1e12, peak = friction + c;
  for (const auto& s : drive("bond.xml", {"Point.control={traction, jump}", "Point.path={-4e6, 1e-6*t}", "Time.end=50",
                                          "Time.steps=50", "Materials.cemented joint.shear fracture energy=400"})) {
    const Real w = s.jump[1], softened = (peak - c * w / length) / (1 - c / (length * K_t));
    const Real tau = K_t * w <= peak ? K_t * w : std::max(softened, friction);
    EXPECT_NEAR(s.traction[1], tau, 1e-9 * peak) << s.t;
  }
}

TEST(Bond, ConstantCohesionStays) {
  const auto states =
      drive("cyclic_shear.xml", {"Materials.joint.bond=constant cohesion", "Materials.joint.cohesion=0.05",
                                 "Point.control={traction, jump}", "Point.path={-0.3, shear(t)}"});
  const Real shear[] = {0.2, 0.23, 0.23, -0.17, -0.23, 0.23, 0.23, 0.23};
  for (int i = 0; i < 8; ++i) EXPECT_NEAR(states[i].traction[1], shear[i], 1e-14) << i;
  const auto pulled = drive("cyclic_shear.xml",
                            {"Materials.joint.bond=constant cohesion", "Materials.joint.cohesion=0.05",
                             "Point.control={jump, jump}", "Point.path={0.1*t, 0.1}", "Time.end=1", "Time.steps=1"});
  EXPECT_EQ(pulled[0].contact, ContactState::open);
  EXPECT_EQ(pulled[0].traction[0], 0);
}

/// An opening face has the shear strength c (1 - o/o_0), which recovers on closing.
TEST(Bond, LosesConstantCohesionByOpening) {
  const auto states =
      drive("cyclic_shear.xml", {"Materials.joint.bond=constant cohesion", "Materials.joint.cohesion=0.05",
                                 "Materials.joint.opening without cohesion=0.01", "Point.control={jump, jump}",
                                 "Point.path={0.02*min(t, 1.2 - t), 0.1*(t + 1)}", "Time.end=1.1", "Time.steps=11"});
  for (const auto& s : states) {
    const Real opening = 0.02 * std::min(s.t, 1.2 - s.t), shear = 0.05 * std::max(0.0, 1 - opening / 0.01);
    EXPECT_NEAR(s.traction[0], 0, 1e-14) << s.t;
    EXPECT_NEAR(s.traction[1], shear, 1e-13) << s.t;
  }
}

TEST(Bond, EnergiesAreRequiredWithStrengths) {
  for (const char* entry : {"fracture energy", "shear fracture energy"}) {
    try {
      auto scene = laboratory::read_point_scene(*Tpetra::getDefaultComm(), source_dir() + "/xml/point/bond.xml",
                                                {fmt::format("Materials.cemented joint.{}=0", entry)});
      ADD_FAILURE() << entry;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(entry), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace sprekk::tests
