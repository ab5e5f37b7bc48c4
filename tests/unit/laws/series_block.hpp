// Joint in series with a block of rock under uniform strain: tests of the joint law without a mesh.
#pragma once

#include <gtest/gtest.h>

#include <Sacado.hpp>
#include <algorithm>
#include <array>
#include <cmath>

#include "laws/joint.hpp"

namespace sprekk::laws::testing {

/// Joint law with the first kind of each role; tests set its parameters.
using SimpleJoint = JointLaw<LinearShear, CoulombFriction, NormalGap<ConstantDilation, BartonBandisClosure>>;

/// Solves A x = b by Gaussian elimination with partial pivoting; b becomes x.
template <int n>
void solve(Real (&A)[n][n], Real (&b)[n]) {
  for (int k = 0; k < n; ++k) {
    int pivot = k;
    for (int i = k + 1; i < n; ++i)
      if (std::abs(A[i][k]) > std::abs(A[pivot][k])) pivot = i;
    std::swap(A[k], A[pivot]);
    std::swap(b[k], b[pivot]);
    for (int i = k + 1; i < n; ++i) {
      const Real factor = A[i][k] / A[k][k];
      for (int j = k; j < n; ++j) A[i][j] -= factor * A[k][j];
      b[i] -= factor * b[k];
    }
  }
  for (int k = n - 1; k >= 0; --k) {
    for (int j = k + 1; j < n; ++j) b[k] -= A[k][j] * b[j];
    b[k] /= A[k][k];
  }
}

/// Block with stiffnesses k_n, k_s and one joint. The top of the block has the displacement d = (n, t1[, t2]):
///   w + lambda/k - d = 0,  R(w, lambda) = 0.
template <int dim>
struct SeriesBlock {
  SimpleJoint law;
  Real k_n = 3, k_s = 1;
  Real c = 1;  ///< augmentation constant
  std::array<Real, dim - 1> p_old{};
  Real w[dim] = {}, lambda[dim] = {};
  ContactState state = ContactState::stick;
  int iterations = 0;

  /// Solves one step of implicit Euler by Newton's method from the present state. Does not update p_old.
  void step(const std::array<Real, dim>& d) {
    Real size = 0;
    for (Real value : d) size = std::max(size, std::abs(value));
    for (iterations = 1; iterations <= 60; ++iterations) {
      Real x[2 * dim];
      newton_step(d, x);
      Real largest = 0;
      for (int i = 0; i < dim; ++i) {
        w[i] -= x[i];
        lambda[i] -= x[dim + i];
        largest = std::max({largest, std::abs(x[i]), std::abs(x[dim + i]) / std::max(k_n, k_s)});
      }
      if (largest <= 1e-15 * size) return;
    }
    ADD_FAILURE() << "Newton's method did not converge";
  }

  /// Returns the plastic tangential jump of the present state.
  std::array<Real, dim - 1> plastic() const {
    Real old[dim - 1], elastic[dim], part[dim];
    std::copy(p_old.begin(), p_old.end(), old);
    split_jump<dim>(law, state, w, lambda, old, elastic, part);
    std::array<Real, dim - 1> p;
    std::copy(part + 1, part + dim, p.begin());
    return p;
  }

  void commit() {
    if (state != ContactState::stick) p_old = plastic();
  }

 private:
  /// Computes the Newton correction x of (w, lambda).
  void newton_step(const std::array<Real, dim>& d, Real (&x)[2 * dim]) {
    using Fad = Sacado::Fad::SFad<Real, 2 * dim>;
    Fad jump[dim], traction[dim], R[dim];
    Real old[dim - 1], A[2 * dim][2 * dim] = {};
    std::copy(p_old.begin(), p_old.end(), old);
    for (int i = 0; i < dim; ++i) {
      jump[i] = Fad(2 * dim, i, w[i]);
      traction[i] = Fad(2 * dim, dim + i, lambda[i]);
    }
    state = contact_residual<dim>(law, augmentation(law, c), jump, traction, old, R);
    for (int i = 0; i < dim; ++i) {
      const Fad block = jump[i] + traction[i] / (i == 0 ? k_n : k_s) - d[i];
      x[i] = block.val();
      x[dim + i] = R[i].val();
      for (int j = 0; j < 2 * dim; ++j) {
        A[i][j] = block.dx(j);
        A[dim + i][j] = R[i].dx(j);
      }
    }
    solve(A, x);
  }
};

/// Joint with K_t = 2, mu = 0.6, theta = 10 degrees, g0 = 0.01, Du = 0.1, K_n = 5. In series with k_s = 1 its shear
/// stiffness is K_s = 2/3; tests use k_n = 3.
inline SimpleJoint reference_joint() {
  SimpleJoint joint;
  joint.elastic.inverse_stiffness = 1 / 2.0;
  joint.friction.coefficient = 0.6;
  joint.gap.initial = 0.01;
  joint.gap.dilation.tangent = std::tan(10 * 3.14159265358979323846 / 180);
  joint.gap.closure = {0.1, 5};
  return joint;
}

/// Reference joint without dilation, closure and gap.
inline SimpleJoint plain_joint() {
  SimpleJoint joint = reference_joint();
  joint.gap = {};
  return joint;
}

/// Closed-form state of the block in 2D.
struct ClosedForm {
  ContactState state;
  Real lambda_t, lambda_n, plastic, opening;
};

/// Returns the state after one step from p_old. In each regime the normal force N solves a N + Du N/(Du K_n + N) = b.
inline ClosedForm closed_form(const SimpleJoint& law, Real k_n, Real k_s, Real d_t, Real d_n, Real p_old) {
  const Real Du = law.gap.closure.maximum, K_n = law.gap.closure.stiffness, g0 = law.gap.initial;
  const Real mu = law.friction.coefficient, tan = law.gap.dilation.tangent,
             K_s = 1 / (1 / k_s + law.elastic.inverse_stiffness);
  const auto normal_force = [&](Real a, Real b) {
    const Real half = (a * Du * K_n + Du - b) / 2;
    return (-half + std::sqrt(half * half + a * b * Du * K_n)) / a;
  };
  if (d_n >= g0 + tan * std::abs(d_t)) return {ContactState::open, 0, 0, d_t, d_n};
  Real N = normal_force(1 / k_n, g0 + tan * std::abs(p_old) - d_n);
  const Real trial = K_s * (d_t - p_old);
  if (std::abs(trial) <= mu * N) return {ContactState::stick, trial, -N, p_old, d_n + N / k_n};
  N = normal_force(1 / k_n + mu * tan / K_s, g0 + tan * std::abs(d_t) - d_n);
  const Real sign = trial > 0 ? 1 : -1;
  return {ContactState::slip, sign * mu * N, -N, d_t - sign * mu * N / K_s, d_n + N / k_n};
}

inline void expect_equal(const SeriesBlock<2>& block, const ClosedForm& exact, Real relative) {
  EXPECT_EQ(static_cast<int>(block.state), static_cast<int>(exact.state));
  EXPECT_NEAR(block.lambda[1], exact.lambda_t, relative * std::abs(exact.lambda_t) + 1e-14);
  EXPECT_NEAR(block.lambda[0], exact.lambda_n, relative * std::abs(exact.lambda_n) + 1e-14);
  EXPECT_NEAR(block.plastic()[0], exact.plastic, relative * std::abs(exact.plastic) + 1e-14);
  EXPECT_NEAR(block.w[0], exact.opening, relative * std::abs(exact.opening) + 1e-14);
}

}  // namespace sprekk::laws::testing
