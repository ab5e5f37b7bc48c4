// Common requirements on every law of laws/joint_kinds.hpp, and the combination of laws.
#include "laws/bond/process_zone.hpp"
#include "laws/joint.hpp"
#include "series_block.hpp"

#include <set>
#include <vector>

namespace sprekk::laws::testing {
namespace {

/// Returns an allowed value of the entry, with a magnitude typical of its unit.
Real typical(const Entry& entry) {
  if (entry.name == "largest past compression") return 0;  // the tests begin with joints without a past
  if (entry.otherwise && std::isfinite(*entry.otherwise) && *entry.otherwise != 0) return *entry.otherwise;
  const std::pair<const char*, Real> usual[] = {
      {"Pa", 4e7}, {"degree", 25}, {"m", 2e-4}, {"Pa/m", 3e10}, {"J/m^2", 3e3}};
  for (const auto& [unit, value] : usual)
    if (entry.unit == unit && entry.bounds.contains(value)) return value;
  for (const Real value : {0.7, 8.0, 0.0, -0.5})
    if (entry.bounds.contains(value)) return value;
  ADD_FAILURE() << entry.name << ": add a value that it may have";
  return 0;
}

template <class K>
K typical() {
  K law;
  for (const auto& [number, entry] : K::parameters()) {
    const Real value = typical(entry);
    law.*number = entry.number_of ? entry.number_of(value) : value;
  }
  return law;
}

template <class Test, class... Ks>
void for_each_kind(const Kinds<Ks...>&, const Test& test) {
  const auto test_one = [&](const auto& law) {
    SCOPED_TRACE(law.name);
    test(law);
  };
  (test_one(typical<Ks>()), ...);
}

/// Tractions of solutions and of iterates; slips; values of history variables.
const Real tractions[] = {-1e12, -1e9, -4e7, -1e6, -2e4, -10, -1e-9, 0, 1e-9, 10, 1e6};
const Real slips[] = {0, 1e-12, 1e-5, 3e-3};
const Real histories[] = {0, 1e-4, 1};

template <class T>
Contact<T> contact_at(const T& lambda_n, const T& slip, const Real* history) {
  Contact<T> at;
  at.lambda_n = lambda_n;
  at.plastic_slip = at.slip_of_step = at.plastic_jump[0] = slip;
  at.shear = T(1e6);
  at.wear = T(1);
  at.history = {history, 0};  // stride 0: all numbers are equal
  return at;
}

/// Checks that f(contact) is finite. Compares its derivatives by Sacado with differences; at a kink with a one-sided
/// difference.
template <class F>
void expect_differentiable(const F& f) {
  using Fad = Sacado::Fad::SFad<Real, 2>;
  for (const Real history : histories)
    for (const Real lambda_n : tractions)
      for (const Real slip : slips) {
        SCOPED_TRACE(::testing::Message() << lambda_n << " Pa, " << slip << " m, history " << history);
        const Fad value = f(contact_at(Fad(2, 0, lambda_n), Fad(2, 1, slip), &history));
        const auto at = [&](Real traction, Real slipped) { return f(contact_at(traction, slipped, &history)); };
        ASSERT_EQ(value.val(), at(lambda_n, slip));
        ASSERT_TRUE(std::isfinite(value.val()));
        for (int i = 0; i < 2; ++i) {
          const Real h = std::max(i == 0 ? 1e-6 * std::abs(lambda_n) : 1e-4 * slip, i == 0 ? 1e-12 : 1e-15);
          const Real above = i == 0 ? at(lambda_n + h, slip) : at(lambda_n, slip + h),
                     below = i == 0 ? at(lambda_n - h, slip) : at(lambda_n, std::max(slip - h, Real(0)));
          const Real size = std::max(std::abs(above), std::abs(below));
          const Real tolerance = 1e-5 * std::abs(value.dx(i)) + 1e-14 * size / h;
          const Real nearest = std::min({std::abs(value.dx(i) - (above - below) / (2 * h)),
                                         std::abs(value.dx(i) - (above - value.val()) / h),
                                         std::abs(value.dx(i) - (value.val() - below) / h)});
          ASSERT_TRUE(std::isfinite(value.dx(i)));
          EXPECT_LE(nearest, tolerance) << "derivative " << i;
        }
      }
}

Contact<Real> unloaded() {
  static const Real zero = 0;
  return contact_at(Real(0), Real(0), &zero);
}

TEST(KindsOfJoints, FrictionHasItsDerivatives) {
  for_each_kind(FrictionKinds(), [](const auto& law) {
    expect_differentiable([&](const auto& at) { return law.bound(at); });
    EXPECT_GE(law.bound(unloaded()), 0);
  });
}

TEST(KindsOfJoints, DilationHasItsDerivatives) {
  for_each_kind(DilationKinds(), [](const auto& law) {
    expect_differentiable([&](const auto& at) { return law.opening(at); });
    EXPECT_EQ(law.opening(unloaded()), 0);
  });
}

TEST(KindsOfJoints, ClosureHasItsDerivatives) {
  using Fad = Sacado::Fad::SFad<Real, 1>;
  for_each_kind(ClosureKinds(), [](const auto& law) {
    expect_differentiable([&](const auto& at) { return law.opening(at); });
    EXPECT_EQ(law.opening(unloaded()), 0);
    const Real zero = 0;
    EXPECT_DOUBLE_EQ(law.opening(contact_at(Fad(1, 0, 0.0), Fad(0), &zero)).dx(0), law.initial_compliance());
  });
}

TEST(KindsOfJoints, ElasticityHasItsDerivatives) {
  for_each_kind(ShearKinds(), [](const auto& law) {
    expect_differentiable([&](const auto& at) { return law.compliance(at); });
    EXPECT_EQ(law.compliance(unloaded()), law.initial_compliance());
  });
}

/// Derivatives in the separation, which replaces the normal traction, from overlap to wide opening.
TEST(KindsOfJoints, BondsHaveTheirDerivatives) {
  for_each_kind(BondKinds(), [](const auto& law) {
    for (const Real separation : {1e-16, 1e-12, 1e-10})  // m per Pa of the tractions
      for (const auto part : {0, 1, 2})
        expect_differentiable([&](auto at) {
          at.separation = separation * at.lambda_n;
          const auto cohesion = law.cohesion(at);
          return part == 0 ? cohesion.shear : part == 1 ? cohesion.strength : cohesion.tension;
        });
    const auto rest = law.cohesion(unloaded());
    EXPECT_GE(rest.shear, 0);
    EXPECT_EQ(rest.strength, rest.tension);
  });
}

/// E' = 40 GPa, faces of 0.1 m; other bonds do not depend on faces.
TEST(SharpFront, HasAZoneOfThreeFaces) {
  const Bond bond = SharpFrontBond{{.energy = 100}}, sharp = on_face(bond, 40e9, 0.1);
  const Real strength = std::sqrt(0.73 * 40e9 * 100 / 0.3);
  EXPECT_TRUE(std::isinf(process_zone(bond, 40e9)));
  EXPECT_NEAR(process_zone(sharp, 40e9), 0.3 * 0.8 / 0.73, 1e-12);
  const Real zero[2] = {};
  EXPECT_NEAR(sharp.cohesion(Contact<Real>{.history = {zero}}).strength, strength, 1e-6);
  EXPECT_NEAR(sharp.cohesion(Contact<Real>{.history = {zero}}).shear, strength, 1e-6);  // G_II = G_I
  EXPECT_NEAR(on_face(SharpFrontBond{{.energy = 100, .shear_energy = 400}}, 40e9, 0.1)
                  .cohesion(Contact<Real>{.history = {zero}})
                  .shear,
              2 * strength, 1e-6);
  const Bond given = SofteningBond{1e6, 2e6, 100, 1000};
  EXPECT_EQ(on_face(given, 40e9, 0.1).cohesion(Contact<Real>{.history = {zero}}).strength, 2e6);
}

/// Derivatives for closed, narrow and wide joints; at a kink a one-sided derivative. The hydraulic aperture does not
/// exceed the mechanical one.
TEST(KindsOfJoints, HydraulicAperturesHaveTheirDerivatives) {
  for_each_kind(ApertureKinds(), [](auto law) {
    if constexpr (std::is_same_v<decltype(law), BartonAperture>) law.complete();
    for (const Real a : {-1e-3, -1e-9, 0.0, 1e-9, 1e-5, 1e-4, 1e-3, 0.1}) {
      const Real h = 1e-6 * std::abs(a) + 1e-12;
      if (a > 0) {
        EXPECT_LE(law.hydraulic(a), a);
      }
      EXPECT_NEAR(law.slope(a), (law.hydraulic(a + h) - law.hydraulic(a - h)) / (2 * h), 1e-5) << a;
    }
  });
}

/// With JRC 10, JRC^2.5 = 316.2277660168 um: 100 um conduct like 31.6 um, and 0.4 mm like a smooth joint.
TEST(KindsOfJoints, BartonsHydraulicApertureKnownByHand) {
  BartonAperture law{10};
  law.complete();
  EXPECT_NEAR(law.hydraulic(1e-4), 31.62277660168e-6, 1e-16);
  EXPECT_EQ(law.hydraulic(4e-4), 4e-4);
  EXPECT_EQ(law.hydraulic(-1e-4), 0);
}

TEST(KindsOfJoints, DamageHasItsDerivatives) {
  for_each_kind(DamageKinds(), [](const auto& law) {
    for (const bool friction : {false, true})
      expect_differentiable([&](const auto& at) { return friction ? law.left(at).friction : law.left(at).dilation; });
    EXPECT_EQ(law.left(unloaded()).friction, 1);
    EXPECT_EQ(law.left(unloaded()).dilation, 1);
  });
  for_each_kind(DriverKinds(), [](const auto& law) {
    expect_differentiable([&](const auto& at) { return law.wear(at); });
    EXPECT_GE(law.wear(unloaded()), 0);
  });
}

/// Checks that names are unique among the entries of a law and among the laws of a role. Entries with equal names in
/// several laws must have equal units.
template <class... Ks>
void expect_distinct(const Kinds<Ks...>&) {
  const std::set<std::string> names = {Ks::name...};
  EXPECT_EQ(names.size(), sizeof...(Ks));
  std::map<std::string, std::string> units;
  const auto expect_own = [&](const auto& parameters) {
    std::set<std::string> own;
    for (const auto& parameter : parameters) {
      const auto& entry = parameter.entry;
      EXPECT_TRUE(own.insert(entry.name).second) << entry.name;
      EXPECT_EQ(units.emplace(entry.name, entry.unit).first->second, entry.unit) << entry.name;
      EXPECT_FALSE(entry.meaning.empty());
    }
  };
  (expect_own(Ks::parameters()), ...);
}

TEST(KindsOfJoints, HaveNamesOfTheirOwn) {
  expect_distinct(ShearKinds());
  expect_distinct(FrictionKinds());
  expect_distinct(DilationKinds());
  expect_distinct(ClosureKinds());
  expect_distinct(BondKinds());
  expect_distinct(DamageKinds());
  expect_distinct(DriverKinds());
}

/// Joint that closes like a spring up to its largest past compression, and with half the compliance beyond.
struct Pressed {
  static constexpr int n_history = 1;
  Real compliance = 0;
  static constexpr const char *name = "pressed", *meaning = "";

  template <class T>
  T opening(const Contact<T>& at) const {
    const Real known = at.history[0];
    if (-at.lambda_n <= known) return compliance * at.lambda_n;
    return compliance * (at.lambda_n - known) / 2;
  }
  Real initial_compliance() const { return compliance / 2; }
  void commit(const Contact<Real>& at, const Numbers<Real>& history) const {
    history[0] = std::max(history[0], -at.lambda_n);
  }
};

/// Coulomb's law whose coefficient decreases with the length of the slip path.
struct Worn {
  static constexpr int n_history = 2;
  Real coefficient = 0;
  static constexpr const char *name = "worn", *meaning = "";

  template <class T>
  T bound(const Contact<T>& at) const {
    return -coefficient / (1 + at.history[0]) * at.lambda_n;
  }
  void commit(const Contact<Real>& at, const Numbers<Real>& history) const {
    history[0] = at.history[0] + std::abs(at.plastic_jump[0] - at.last_plastic_jump[0]);
    history[1] += 1;
  }
};

TEST(Kinds, AreTheLawThatTheyAreGiven) {
  using One = Kinds<CoulombFriction, BartonChoubeyFriction, Worn>;
  const auto bound = [](const One& law, Real compression) {
    const Real zero = 0;
    return law.visit([&](const auto& one) { return one.bound(contact_at(-compression, Real(0), &zero)); });
  };
  const BartonChoubeyFriction rough{10, 100e6, 30, 70};
  EXPECT_EQ(bound(One(), 3), 0);
  EXPECT_EQ(bound(One(CoulombFriction{0.5}), 4), 2);
  EXPECT_NEAR(bound(One(rough), 1e6), 1.1917535926e6, 1e-3);
  One law = rough;
  EXPECT_EQ(law.n_history(), 0);
  law = Worn{0.25};
  EXPECT_EQ(law.n_history(), 2);
  EXPECT_EQ(bound(law, 4), 1);
}

/// Each law finds its own history variables among those of the face, for any stride.
TEST(JointLaw, LawsKeepNumbersOfAFace) {
  const JointLaw<LinearShear, Worn, NormalGap<ConstantDilation, Pressed>> law{{}, {0.5}, {0, {}, {0.1}}};
  ASSERT_EQ(law.n_history(), 3);
  for (const long stride : {1, 4}) {
    std::vector<Real> numbers(3 * stride, 0);
    const Real w[] = {-0.02, 0.7}, lambda[] = {-0.4, 0}, old[] = {0.2}, p[] = {0.5};
    const History history{numbers.data(), stride};
    const auto at = contact<2>(Real(-0.4), Real(0.5), p, old, history);
    EXPECT_DOUBLE_EQ(law.normal_gap(at), -0.02);
    EXPECT_DOUBLE_EQ(law.bound(at), 0.2);
    law.commit(at, {numbers.data(), stride});
    EXPECT_DOUBLE_EQ(numbers[0], 0.4);           // compression
    EXPECT_DOUBLE_EQ(numbers[stride], 0.3);      // path
    EXPECT_DOUBLE_EQ(numbers[2 * stride], 1.0);  // steps
    EXPECT_DOUBLE_EQ(law.normal_gap(at), -0.04);
    EXPECT_DOUBLE_EQ(law.bound(at), 0.2 / 1.3);
    Real R[2];
    EXPECT_EQ(contact_residual<2>(law, {1, 1}, w, lambda, old, R, history), ContactState::slip);
    EXPECT_NEAR(R[1], -0.5 / 1.3 * (0.4 - (-0.02 + 0.04)), 1e-15);
  }
}

/// Closed faces follow their elastic law for any shear traction; open faces transmit no shear.
TEST(JointLaw, NoSlipIsElasticAlone) {
  constexpr Real K = 2;
  const JointLaw<LinearShear, NoSlip> law{{1 / K}, {}};
  const Real zero[1] = {}, old[1] = {};
  for (const Real shear : {-300.0, -1e-3, 0.7, 1e4}) {
    const Real w[] = {0, shear / K}, lambda[] = {-0.3, shear};
    Real R[2];
    EXPECT_EQ(contact_residual<2>(law, {1, 1e-6}, w, lambda, old, R, {zero, 0}), ContactState::stick);
    EXPECT_NEAR(R[0], 0, 1e-12);
    EXPECT_NEAR(R[1], 0, 1e-12 * std::abs(shear));
  }
  const Real w[] = {0.1, 5}, none[] = {0, 0};
  Real R[2];
  EXPECT_EQ(contact_residual<2>(law, {1, 1e-6}, w, none, old, R, {zero, 0}), ContactState::open);
  EXPECT_NEAR(R[0], 0, 1e-12);
  EXPECT_NEAR(R[1], 0, 1e-12);
}

/// A slip-weakening bound, extended linearly to negative slip, increases there. Backward slip at this bound is not a
/// state. A face must also not stick at a bound that exists only with its slip.
TEST(JointLaw, NoStateSlidesBackwardsOrSticksForItsSlip) {
  const JointLaw<LinearShear, SlipWeakeningFriction> softens{{}, {0.6, 0.4, 0.2}};
  const JointLaw<LinearShear, MobilisedBartonChoubeyFriction> hardens{{}, {{0, 1, 30, 70}, 1}};
  const Real zero[1] = {}, old[1] = {};
  const auto residual = [&](const auto& law, Real slip, Real shear, Real(&R)[2]) {
    const Real w[] = {0, slip}, lambda[] = {-0.3, shear};
    return contact_residual<2>(law, {1, 1e-6}, w, lambda, old, R, {zero, 0});
  };
  Real R[2];
  residual(softens, -0.05, 0.3 * (0.4 + 0.2 * 1.25), R);  // on the line through peak and residual bound
  EXPECT_GT(std::abs(R[1]), 0.01);
  EXPECT_EQ(residual(softens, 0.05, 0.3 * (0.4 + 0.2 * 0.75), R), ContactState::slip);
  EXPECT_NEAR(R[1], 0, 1e-15);
  EXPECT_EQ(residual(hardens, 0.5, 0.1, R), ContactState::slip);  // the bound is 0.3 tan(30 degrees) while the face
                                                                  // slips
  EXPECT_NEAR(R[1], 0.1 - 0.3 * std::tan(M_PI / 6), 1e-15);
}

}  // namespace
}  // namespace sprekk::laws::testing
