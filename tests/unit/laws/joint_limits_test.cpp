// Limits of the joint law, its derivatives, and independence of the augmentation.
#include <vector>

#include "laws/joint.hpp"
#include "series_block.hpp"

namespace sprekk::laws::testing {
namespace {

const std::array<Real, 2> loads[] = {{-0.1, 0.05}, {-0.1, 0.5}, {-0.05, 1.0}, {0.05, 0.3}, {0.2, 0.2}, {-0.1, -0.6}};

void expect_closed_form(const SimpleJoint& law) {
  for (const auto& d : loads)
    for (Real p_old : {0.0, 0.1}) {
      SCOPED_TRACE(::testing::Message() << "d = (" << d[0] << ", " << d[1] << "), p_old = " << p_old);
      SeriesBlock<2> block;
      block.law = law;
      block.p_old = {p_old};
      block.step(d);
      expect_equal(block, closed_form(law, block.k_n, block.k_s, d[1], d[0], p_old), 1e-11);
    }
}

TEST(JointLimits, RigidInShear) {
  SimpleJoint law = reference_joint();
  law.elastic.inverse_stiffness = 0;
  expect_closed_form(law);
}

TEST(JointLimits, StiffInShearTendsToRigid) {
  SimpleJoint rigid = reference_joint(), stiff = rigid;
  rigid.elastic.inverse_stiffness = 0;
  stiff.elastic.inverse_stiffness = 1e-12;
  for (const auto& d : loads) {
    SeriesBlock<2> a, b;
    a.law = rigid;
    b.law = stiff;
    a.step(d);
    b.step(d);
    EXPECT_NEAR(a.lambda[1], b.lambda[1], 1e-11);
    EXPECT_NEAR(a.plastic()[0], b.plastic()[0], 1e-11);
  }
}

TEST(JointLimits, NoClosure) {
  SimpleJoint law = reference_joint();
  law.gap.closure.maximum = 0;
  expect_closed_form(law);
  law.elastic.inverse_stiffness = 0;
  expect_closed_form(law);
}

/// Without friction the joint slips and dilates; the jump d_t is fully plastic.
TEST(JointLimits, NoFriction) {
  SimpleJoint law = reference_joint();
  law.friction.coefficient = 0;
  expect_closed_form(law);
  SeriesBlock<2> block;
  block.law = law;
  block.step({-0.1, 0.3});
  EXPECT_NEAR(block.plastic()[0], 0.3, 1e-14);
  EXPECT_NEAR(block.lambda[1], 0, 1e-14);
}

/// With vanishing stiffness the joint sticks elastically, without plastic jump and dilation.
TEST(JointLimits, NoTangentialStiffness) {
  SimpleJoint law = reference_joint();
  law.elastic.inverse_stiffness = 1e14;
  SeriesBlock<2> block;
  block.law = law;
  block.step({-0.1, 0.3});
  EXPECT_EQ(static_cast<int>(block.state), static_cast<int>(ContactState::stick));
  EXPECT_NEAR(block.lambda[1], 0, 1e-13);
  EXPECT_NEAR(block.plastic()[0], 0, 1e-12);
  EXPECT_NEAR(block.w[0], closed_form(law, 3, 1, 0, -0.1, 0).opening, 1e-12);
}

TEST(JointLaw, TouchingUnloadedFaceSticks) {
  for (Real compliance : {0.0, 0.5})
    for (Real closure : {0.0, 0.1}) {
      SimpleJoint law = reference_joint();
      law.elastic.inverse_stiffness = compliance;
      law.gap.closure.maximum = closure;
      const Real w[] = {law.gap.initial, 0, 0}, lambda[] = {0, 0, 0}, old[] = {0, 0};
      Real R[3] = {1, 1, 1};
      EXPECT_EQ(static_cast<int>(contact_residual<3>(law, augmentation(law, 2.0), w, lambda, old, R)),
                static_cast<int>(ContactState::stick));
      for (Real value : R) EXPECT_EQ(value, 0);
      const Real apart[] = {law.gap.initial + 1e-15, 0, 0};
      EXPECT_EQ(static_cast<int>(contact_residual<3>(law, augmentation(law, 2.0), apart, lambda, old, R)),
                static_cast<int>(ContactState::open));
    }
}

/// At rest, a face beyond the friction bound by round-off sticks. A face further beyond the bound, or with a jump,
/// slips.
TEST(JointLaw, OnTheLimitAtRestSticks) {
  SimpleJoint law;
  law.friction.coefficient = 0.6;
  law.elastic.inverse_stiffness = 0.5;
  const auto state = [&](Real beyond, Real moved) {
    const Real lambda[] = {-1, 0.36 * (1 + beyond), -0.48 * (1 + beyond)};
    const Real w[] = {0, 0.5 * lambda[1] + 0.6 * moved, 0.5 * lambda[2] - 0.8 * moved}, old[] = {0, 0};
    Real R[3];
    const auto state = contact_residual<3>(law, augmentation(law, 2.0), w, lambda, old, R);
    for (int i = 1; i < 3 && state == ContactState::stick; ++i) EXPECT_NEAR(R[i], 0, 1e-10);
    return static_cast<int>(state);
  };
  const int stick = static_cast<int>(ContactState::stick), slip = static_cast<int>(ContactState::slip);
  EXPECT_EQ(state(1e-13, 0), stick);
  EXPECT_EQ(state(-1e-13, 0), stick);
  EXPECT_EQ(state(1e-8, 0), slip);
  EXPECT_EQ(state(1e-13, 1e-8), slip);
  EXPECT_EQ(state(0, -1e-13), stick);
}

TEST(JointLaw, SolutionDoesNotDependOnTheAugmentation) {
  for (const auto& d : loads) {
    std::vector<Real> first;
    for (Real c : {0.1, 1.0, 7.0, 50.0}) {
      SeriesBlock<2> block;
      block.law = reference_joint();
      block.c = c;
      block.step(d);
      const std::vector<Real> result{block.w[0], block.w[1], block.lambda[0], block.lambda[1], block.plastic()[0]};
      if (first.empty()) first = result;
      for (std::size_t k = 0; k < result.size(); ++k) EXPECT_NEAR(result[k], first[k], 1e-12) << "c = " << c;
    }
  }
}

TEST(JointLaw, AugmentationIsInSeriesWithTheJoint) {
  SimpleJoint law = reference_joint();
  const auto c = augmentation(law, 4.0);
  EXPECT_DOUBLE_EQ(c.normal, 1 / (1 / 4.0 + 1 / 5.0));
  EXPECT_DOUBLE_EQ(c.tangential, 1 / (1 / 4.0 + 1 / 2.0));
  law.elastic.inverse_stiffness = 0;
  law.gap.closure.maximum = 0;
  EXPECT_DOUBLE_EQ(augmentation(law, 4.0).normal, 4);
  EXPECT_DOUBLE_EQ(augmentation(law, 4.0).tangential, 4);
}

/// A face with a jump and dilation but without traction slides for any joint stiffness, if mu tan(theta) < 1.
TEST(JointLaw, AFaceThatOverlapsByItsDilationSlides) {
  for (const Real compliance : {1e-3, 1.0, 1e3, 1e6})
    for (const Real mu : {0.1, 0.9}) {
      SimpleJoint law;
      law.friction.coefficient = mu;
      law.gap.dilation.tangent = 0.9;
      law.elastic.inverse_stiffness = compliance;
      law.sliding_compliance = mu * 0.9 * compliance;
      const Real w[] = {0, 0.6, -0.8}, lambda[] = {0, 0, 0}, old[] = {0, 0};
      Real R[3];
      EXPECT_EQ(static_cast<int>(contact_residual<3>(law, augmentation(law, 2.0), w, lambda, old, R)),
                static_cast<int>(ContactState::slip))
          << compliance << " " << mu;
    }
}

/// Away from solutions, the bound follows from the projected normal traction y, not from lambda_n.
TEST(JointLaw, ResidualIsThatOfTheProjections) {
  const SimpleJoint law = reference_joint();
  const auto c = augmentation(law, 1.5);
  const Real w[] = {-0.1, 0.9, -0.4}, lambda[] = {-0.3, 0.1, 0.2}, old[] = {0.02, 0.1};
  const Real p[] = {0.9 - 0.05, -0.4 - 0.1};
  const Real gap = 0.01 + law.gap.dilation.tangent * std::hypot(p[0], p[1]) - 0.1 * 0.3 / (0.5 + 0.3);
  const Real y = -0.3 + c.normal * (-0.1 - gap);
  const Real z[] = {0.1 + c.tangential * (p[0] - 0.02), 0.2 + c.tangential * (p[1] - 0.1)};
  Real R[3];
  EXPECT_EQ(static_cast<int>(contact_residual<3>(law, c, w, lambda, old, R)), static_cast<int>(ContactState::slip));
  EXPECT_NEAR(R[0], -0.3 - y, 1e-14);
  for (int i = 0; i < 2; ++i) EXPECT_NEAR(R[i + 1], lambda[i + 1] + 0.6 * y * z[i] / std::hypot(z[0], z[1]), 1e-14);
}

/// Compares the derivatives of contact_residual by Sacado with central differences.
template <int dim>
void expect_exact_derivative(const SimpleJoint& law, const Real (&w)[dim], const Real (&lambda)[dim],
                             const Real (&old)[dim - 1], ContactState expected) {
  using Fad = Sacado::Fad::SFad<Real, 2 * dim>;
  Fad jump[dim], traction[dim], R[dim];
  for (int i = 0; i < dim; ++i) {
    jump[i] = Fad(2 * dim, i, w[i]);
    traction[i] = Fad(2 * dim, dim + i, lambda[i]);
  }
  const auto c = augmentation(law, 1.5);
  ASSERT_EQ(static_cast<int>(contact_residual<dim>(law, c, jump, traction, old, R)), static_cast<int>(expected));
  const Real h = 1e-6;
  for (int j = 0; j < 2 * dim; ++j) {
    Real value[2][dim];
    for (int sign : {0, 1}) {
      Real x[dim], y[dim];
      std::copy(w, w + dim, x);
      std::copy(lambda, lambda + dim, y);
      (j < dim ? x[j] : y[j - dim]) += sign ? h : -h;
      ASSERT_EQ(static_cast<int>(contact_residual<dim>(law, c, x, y, old, value[sign])), static_cast<int>(expected));
    }
    for (int i = 0; i < dim; ++i)
      EXPECT_NEAR(R[i].dx(j), (value[1][i] - value[0][i]) / (2 * h), 1e-8) << i << ", " << j;
  }
}

TEST(JointLaw, DerivativesInEachState) {
  SimpleJoint law = reference_joint();
  for (Real compliance : {0.5, 0.0}) {
    law.elastic.inverse_stiffness = compliance;
    expect_exact_derivative<2>(law, {0.4, 0.2}, {0.1, -0.1}, {0.05}, ContactState::open);
    expect_exact_derivative<2>(law, {-0.1, 0.06}, {-0.3, 0.04}, {0.02}, ContactState::stick);
    expect_exact_derivative<2>(law, {-0.1, -0.5}, {-0.3, 0.1}, {0.02}, ContactState::slip);
    expect_exact_derivative<2>(law, {-0.3, 0.5}, {0.05, 0.1}, {0.02}, ContactState::slip);  // tensile iterate
    expect_exact_derivative<3>(law, {0.4, 0.2, -0.1}, {0.1, -0.1, 0.2}, {0.05, 0}, ContactState::open);
    expect_exact_derivative<3>(law, {-0.1, 0.06, -0.03}, {-0.3, 0.04, 0.02}, {0.02, -0.03}, ContactState::stick);
    expect_exact_derivative<3>(law, {-0.1, -0.5, 0.3}, {-0.3, 0.1, 0.2}, {0.02, 0.1}, ContactState::slip);
  }
}

TEST(Norm, HasZeroDerivativeAtZero) {
  using Fad = Sacado::Fad::SFad<Real, 2>;
  const Fad zero[] = {Fad(2, 0, 0.0), Fad(2, 1, 0.0)};
  const Fad size = norm(zero);
  EXPECT_EQ(size.val(), 0);
  for (int i = 0; i < 2; ++i) EXPECT_EQ(size.dx(i), 0);
  const Fad v[] = {Fad(2, 0, 3.0), Fad(2, 1, -4.0)};
  EXPECT_DOUBLE_EQ(norm(v).val(), 5);
  EXPECT_DOUBLE_EQ(norm(v).dx(0), 0.6);
  EXPECT_DOUBLE_EQ(norm(v).dx(1), -0.8);
}

/// Returns the closure under a normal traction.
template <class T>
T closed(const BartonBandisClosure& closure, const T& lambda_n) {
  Contact<T> at;
  at.lambda_n = lambda_n;
  return closure.opening(at);
}

TEST(BartonBandisClosure, IsOnceContinuouslyDifferentiableAtZero) {
  using Fad = Sacado::Fad::SFad<Real, 1>;
  const BartonBandisClosure closure{0.1, 5};
  for (Real traction : {-1e-14, 0.0, 1e-14}) {
    const Fad value = closed(closure, Fad(1, 0, traction));
    EXPECT_NEAR(value.val(), 0, 1e-14);
    EXPECT_NEAR(value.dx(0), 1 / 5.0, 1e-12);
  }
  EXPECT_NEAR(closed(closure, -0.5), -0.05, 1e-15);  // Du K_n: half of the largest closure
  EXPECT_NEAR(closed(closure, -1e12), -0.1, 1e-12);
  EXPECT_EQ(closed(BartonBandisClosure{0, 5}, -3.0), 0);
  EXPECT_EQ((BartonBandisClosure{0, 5}.initial_compliance()), 0);
  EXPECT_EQ(closed(BartonBandisClosure{}, -3.0), 0);
}

TEST(BartonBandisClosure, OfNoMaximumIsLinear) {
  using Fad = Sacado::Fad::SFad<Real, 1>;
  const BartonBandisClosure linear{std::numeric_limits<Real>::infinity(), 50e9}, nearly{1e12, 50e9};
  for (Real traction : {-2e6, -1.0, 0.0, 1.0}) {
    const Fad value = closed(linear, Fad(1, 0, traction));
    EXPECT_DOUBLE_EQ(value.val(), traction / 50e9);
    EXPECT_DOUBLE_EQ(value.dx(0), 1 / 50e9);
    EXPECT_NEAR(closed(nearly, traction), value.val(), 1e-15 * std::abs(value.val()));
  }
  EXPECT_DOUBLE_EQ(linear.initial_compliance(), 1 / 50e9);
}

/// Returns the change of R_n with lambda_n along the slip, divided by c_n. It is the compliance B' + mu dp/K_t of the
/// face, with the dilation dp for slip along the traction. An iterate with p = -0.2 slides against its traction.
template <int dim>
Real compliance_of_iterate(Real p_old) {
  using Fad = Sacado::Fad::SFad<Real, 2 * dim>;
  SimpleJoint law = reference_joint();
  law.elastic.inverse_stiffness = 1;
  law.gap.closure.maximum = 0;
  const auto c = augmentation(law, 1);
  const Real opening = law.gap.initial + 0.2 * law.gap.dilation.tangent, direction[] = {0.6, -0.8};
  Real w[dim] = {opening}, lambda[dim] = {-0.5}, old[dim - 1], R_value[dim];
  Fad jump[dim], traction[dim], R[dim];
  for (int i = 0; i < dim - 1; ++i) {
    const Real along = dim == 2 ? 1 : direction[i];
    w[i + 1] = 0.5 * along;
    lambda[i + 1] = 0.7 * along;
    old[i] = p_old * along;
  }
  for (int i = 0; i < dim; ++i) {
    jump[i] = Fad(2 * dim, i, w[i]);
    traction[i] = Fad(2 * dim, dim + i, lambda[i]);
  }
  EXPECT_EQ(contact_residual<dim>(law, c, jump, traction, old, R), ContactState::slip);
  contact_residual<dim>(law, c, w, lambda, old, R_value);
  for (int i = 0; i < dim; ++i) EXPECT_EQ(R[i].val(), R_value[i]);
  EXPECT_NEAR(R_value[0], 0, 1e-15);  // the gap dilates by |p| in both directions
  Real sum = R[0].dx(dim);
  for (int i = 1; i < dim; ++i) sum -= law.friction.coefficient * (dim == 2 ? 1 : direction[i - 1]) * R[0].dx(dim + i);
  return sum / c.normal;
}

TEST(JointLimits, SlipAgainstTheTractionDoesNotSoften) {
  const SimpleJoint law = reference_joint();
  const Real dilates = law.friction.coefficient * law.gap.dilation.tangent;
  EXPECT_NEAR(compliance_of_iterate<2>(0), dilates, 1e-14);
  EXPECT_NEAR(compliance_of_iterate<3>(0), dilates, 1e-14);
  EXPECT_NEAR(compliance_of_iterate<2>(0.05), dilates, 1e-14);
  EXPECT_NEAR(compliance_of_iterate<2>(-0.05), -dilates, 1e-14);  // p_old is opposite to z
  EXPECT_NEAR(compliance_of_iterate<3>(-0.05), -dilates, 1e-14);
}

}  // namespace
}  // namespace sprekk::laws::testing
