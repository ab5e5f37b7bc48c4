// Wear by slip on faces that are open at the end of a step.
#include "laws/joint.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace sprekk::laws::testing {
namespace {

constexpr Real tangent = 0.1, before = 1e-3;  // tangent of the dilation angle; slip before the step, m

/// Step of a face without traction, on a joint with previous slip `before`.
template <int dim>
class OpenFace {
 public:
  explicit OpenFace(const Joint& law) : law_(law), saved_(law.n_history(), 0) {
    commit(ContactState::slip, 0, before, 0);
  }
  /// Returns the gap after the slip, if a fraction `share` of the slip wears the joint.
  Real gap(Real slip, Real share) const {
    auto at = contact_after(slip);
    at.rubs = share;
    return law_.normal_gap(at);
  }
  ContactState state(Real normal, Real slip, Real old) const {
    Real w[dim], p_old[dim - 1], R[dim];
    const Real lambda[dim] = {};
    set(normal, slip, w), set(old, p_old);
    return contact_residual<dim>(law_, augmentation(law_, 1e9), w, lambda, p_old, R, {saved_.data()});
  }
  void commit(ContactState state, Real normal, Real slip, Real old) {
    Real w[dim], p[dim - 1], p_old[dim - 1];
    const Real lambda[dim] = {};
    set(normal, slip, w), set(slip, p), set(old, p_old);
    law_.commit(converged<dim>(law_, state, w, lambda, p, p_old, {saved_.data()}), {saved_.data()});
  }
  /// Returns w_n - g at the beginning of the next step.
  Real apart(Real normal, Real slip) const {
    Real p[dim - 1];
    set(slip, p);
    return normal - law_.normal_gap(contact<dim>(Real(0), slip, p, p, {saved_.data()}));
  }
  const std::vector<Real>& history() const { return saved_; }

 private:
  static void set(Real slip, Real (&p)[dim - 1]) {
    p[0] = dim == 2 ? slip : 0.6 * slip;
    if constexpr (dim == 3) p[1] = 0.8 * slip;
  }
  static void set(Real normal, Real slip, Real (&w)[dim]) {
    Real p[dim - 1];
    set(slip, p);
    w[0] = normal;
    for (int i = 1; i < dim; ++i) w[i] = p[i - 1];
  }
  Contact<Real> contact_after(Real slip) const {
    Real p[dim - 1], p_old[dim - 1];
    set(slip, p), set(before, p_old);
    auto at = contact<dim>(Real(0), slip, p, p_old, {saved_.data()});
    at.slip_of_step = slip - before;
    for (int i = 0; i < dim - 1; ++i) at.slip_direction[i] = p[i] / slip;
    return at;
  }

  Joint law_;
  std::vector<Real> saved_;
};

/// Checks open faces between the gaps of the unworn and the fully worn joint. Faces above the unworn gap do not wear.
/// Other faces wear until the sides just touch, and the next step finds them open.
template <int dim>
void expect_worn_until_they_fit(const Joint& law) {
  constexpr Real slip = 4e-3;
  const OpenFace<dim> start(law);
  const Real fresh = start.gap(slip, 0), worn = start.gap(slip, 1);
  ASSERT_GT(fresh, 1.01 * worn);
  for (const Real share : {0.01, 0.3, 0.9, 0.999}) {
    auto face = start;
    const Real normal = face.gap(slip, share);
    ASSERT_EQ(face.state(normal, slip, before), ContactState::open);
    face.commit(ContactState::open, normal, slip, before);
    EXPECT_GE(face.apart(normal, slip), 0) << share;
    EXPECT_NEAR(face.apart(normal, slip), 0, 1e-9 * normal) << share;
    EXPECT_EQ(face.state(normal, slip, slip), ContactState::open) << share;
  }
  auto apart = start;
  apart.commit(ContactState::open, 1.001 * fresh, slip, before);
  EXPECT_NEAR(apart.apart(1.001 * fresh, slip), 0.001 * fresh, 1e-9 * fresh);
}

Joint worn_by(const Damage& damage) {
  Joint law;
  law.gap.dilation = ConstantDilation{tangent};
  law.damage = damage;
  return law;
}
Joint mobilised() {
  Joint law;
  MobilisedDilation dilation;
  dilation.roughness = 10;
  dilation.wall_strength = 100e6;
  dilation.peak_slip = 5e-4;  // slip wears its roughness from the beginning
  law.gap.dilation = dilation;
  return law;
}

TEST(OpenJoint, WearsUntilItFits) {
  const ExponentialDecay wears{0.8, 0.3, 5e-3, 5e-3};
  for (const Damage& damage : {Damage(IsotropicDamage{wears}), Damage(AnisotropicDamage{wears})}) {
    expect_worn_until_they_fit<2>(worn_by(damage));
    expect_worn_until_they_fit<3>(worn_by(damage));
  }
  expect_worn_until_they_fit<2>(mobilised());
  expect_worn_until_they_fit<3>(mobilised());
}

/// Wear by compression or by frictional work needs traction.
TEST(OpenJoint, WearsNothingByLoadsThatItDoesNotBear) {
  for (const Driver& driver : {Driver(CompressionDriver{1e6}), Driver(WorkDriver{1e6})}) {
    Joint law = worn_by(IsotropicDamage{{0.8, 0.3, 5e-3, 5e-3}});
    law.driver = driver;
    OpenFace<3> face(law);
    const auto history = face.history();
    face.commit(ContactState::open, 1.001 * face.gap(4e-3, 0), 4e-3, before);
    EXPECT_EQ(face.history(), history);
  }
}

}  // namespace
}  // namespace sprekk::laws::testing
