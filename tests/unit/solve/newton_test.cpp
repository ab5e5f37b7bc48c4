#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <limits>

#include "base/parameters.hpp"
#include "dense.hpp"
#include "solve/condensed_solve.hpp"
#include "solve/forced_solve.hpp"
#include "solve/newton.hpp"

namespace sprekk::test {
namespace {

using solve::Newton;
using solve::NewtonOptions;

TEST(Newton, SolvesContact) {
  for (const char* type : {"direct", "iterative"}) {
    GridProblem problem(Tpetra::getDefaultComm(), {2, 80, 8, true, true, -1});
    NewtonOptions options;
    options.linear_solver.type = type;
    Newton newton(problem, options);
    auto x = problem.zero();
    problem.set_time(1, 1);
    const auto report = newton.solve(x);
    ASSERT_TRUE(report.converged) << report.reason;
    EXPECT_GE(report.iterations, 2);
    EXPECT_LE(report.iterations, 12);
    EXPECT_EQ(int(report.history.size()), report.iterations + 1);
    // complementarity, checked independently of the residual; both states occur
    const auto w = problem.jump(*x[0]);
    int here[2] = {0, 0}, all[2];
    for (std::size_t i = 0; i < w->getLocalLength(); i += 2) {
      const Real l = x[2]->getData()[i], jump = w->getData()[i] + GridProblem::beta * x[1]->getData()[i];
      EXPECT_LE(l, 1e-9);
      EXPECT_GE(jump, -1e-9);
      EXPECT_NEAR(l * jump, 0, 1e-9);
      ++here[l < -1e-6];
    }
    Teuchos::reduceAll(*problem.comm(), Teuchos::REDUCE_SUM, 2, here, all);
    EXPECT_GT(all[0], 0);
    EXPECT_GT(all[1], 0);
    // prescribed values are exact
    for (std::size_t i = 0; i < x[0]->getLocalLength(); ++i) {
      const auto g = x[0]->getMap()->getGlobalElement(i);
      if (g / 2 / 80 == 7) {
        EXPECT_DOUBLE_EQ(x[0]->getData()[i], g % 2 == 0 ? problem.top(g / 2 % 80) : 0);
      }
    }
    // the second solve needs no iteration
    const auto again = newton.solve(x);
    EXPECT_TRUE(again.converged);
    EXPECT_EQ(again.iterations, 0);
    EXPECT_EQ(solve::iterations(again.linear_solves), 0);
  }
}

/// x a(x)^3 = 1, a = max(x, 1e-3): a fluid that opens its own flow path. With `lags`, a is a lagged coefficient.
class OpeningProblem : public ScalarProblem {
 public:
  OpeningProblem(const RCP<const Comm>& comm, bool lags)
      : ScalarProblem(
            comm, 1, [this](Real x, Real, Real) { return x * std::pow(given_ > 0 ? given_ : width(x), 3) - 1; },
            [this](Real x, Real, Real) {
              if (given_ > 0) return std::pow(given_, 3);
              return std::pow(width(x), 3) + (x > minimum ? 3 * x * x * x : 0);
            }),
        lags_(lags) {}

  /// Updates a with a relaxation suited to the slope -3.
  Real lag(Lag how, const Evaluation& x) override {
    if (!lags_ || how == Lag::none) {
      given_ = 0;
      return lags_ ? 0 : -1;
    }
    const auto values = x.x()[0]->getData();
    const Real found = width(values.size() == 0 ? 0 : values[0]);
    const Real here = given_ > 0 && values.size() > 0 ? std::abs(std::log(found / given_)) : 0;
    given_ = how == Lag::widest ? 1e2 : given_ > 0 ? given_ * std::pow(found / given_, 0.25) : found;
    Real away = 0;
    Teuchos::reduceAll(*comm(), Teuchos::REDUCE_MAX, 1, &here, &away);
    return away;
  }

 private:
  static constexpr Real minimum = 1e-3;
  static Real width(Real x) { return std::max(x, minimum); }
  bool lags_;
  Real given_ = 0;
};

TEST(Newton, FindsWhatAFluidOpensFromFixedPointsOnly) {
  for (const bool lags : {false, true}) {
    OpeningProblem problem(Tpetra::getDefaultComm(), lags);
    Newton newton(problem, {});
    auto x = problem.constant(0);
    problem.set_time(1, 1);
    const auto report = newton.solve(x);
    EXPECT_EQ(report.converged, lags) << report.reason;
    if (!lags) continue;
    EXPECT_LE(report.iterations, 15);
    for (const Real found : x[0]->getData()) EXPECT_NEAR(found, 1, 1e-10);
  }
}

/// When the flow begins, a solve of the carried quantity alone replaces its step, which is linearised about the state
/// of rest. A flow that stays the same needs none.
TEST(Newton, CarriesAQuantityWithTheNewFlow) {
  for (const bool heats : {false, true})
    for (const char* type : {"direct", "iterative"}) {
      CarriedProblem problem(Tpetra::getDefaultComm(), heats);
      NewtonOptions options;
      options.linear_solver.type = type;
      Newton newton(problem, options);
      auto x = problem.zero();
      problem.set_time(1e6, 1);
      const auto report = newton.solve(x);
      ASSERT_TRUE(report.converged) << report.reason;
      EXPECT_EQ(report.advected_solves.size(), 1u) << heats;
      EXPECT_LE(report.iterations, heats ? 3 : 1);
      const Real p = x[0]->getData()[0], T = x[1]->getData()[0];
      EXPECT_NEAR(T, p / (1 + p), 1e-12);
      EXPECT_NEAR(p, 1e6 * (1 + (heats ? 1e-7 : 0) * T), 1e-5);
      BlockVector b = problem.zero(), dx = problem.zero();
      b[0]->putScalar(1);
      const auto response = newton.solve_linearized(x, b, dx, 1e-12);
      ASSERT_TRUE(response.converged) << response.reason;
      const Real slope = heats ? 0.1 : 0;  // of p in T
      EXPECT_NEAR(dx[1]->getData()[0], -(T - 1) / (1 + p + slope * (T - 1)), 1e-15);
      const auto again = newton.solve(x);
      EXPECT_TRUE(again.converged && again.advected_solves.empty());
    }
}

/// A balance whose sum never closes. Each iteration decreases x by 1; only x = -1 has a small measure.
class OpenBalance : public ScalarProblem {
 public:
  explicit OpenBalance(const RCP<const Comm>& comm)
      : ScalarProblem(
            comm, comm->getSize(), [](Real, Real, Real) { return 1.0; }, [](Real, Real, Real) { return 1.0; }),
        blocks_(ScalarProblem::blocks()) {
    blocks_.front().balance = true;
  }
  const std::vector<Block>& blocks() const override { return blocks_; }
  std::vector<Measure> measures(const Evaluation& at, const BlockVector&) override {
    return {{"x", std::abs(at.x()[0]->getData()[0] + 1) < 0.5 ? accepted : 1}};
  }
  Real merit(const Evaluation& at, const BlockVector&) override { return std::pow(at.x()[0]->getData()[0] + 1000, 2); }
  static constexpr Real accepted = 1e-13;

 private:
  std::vector<Block> blocks_;
};

/// If additional iterations for the sum of a balance fail, the solve returns the iterate before them, with its
/// measures.
TEST(Newton, ReturnsToTheIterateBeforeAdditionalIterations) {
  OpenBalance problem(Tpetra::getDefaultComm());
  Newton newton(problem, {});
  auto x = problem.constant(0);
  problem.set_time(1, 1);
  const auto report = newton.solve(x);
  EXPECT_TRUE(report.converged) << report.reason;
  EXPECT_EQ(report.iterations, 2);
  ASSERT_EQ(report.measures.size(), 1u);
  EXPECT_EQ(report.measures[0].value, OpenBalance::accepted);
  EXPECT_NEAR(x[0]->getData()[0], -1, 1e-12);
}

/// x decreases by f(x), which is given for the successive iterates x_0 = 0, x_1, ... The measures of x_0 alone have not
/// converged. f is the error of the sum of a balance, relative to f(0) = 1. Merits of converged iterates are round-off.
class GivenImbalances : public ScalarProblem {
 public:
  GivenImbalances(const RCP<const Comm>& comm, const std::vector<Real>& given)
      : ScalarProblem(
            comm, comm->getSize(), [this](Real x, Real, Real) { return f_[index_of(x)]; },
            [](Real, Real, Real) { return 1.0; }),
        f_(given),
        blocks_(ScalarProblem::blocks()) {
    for (const Real f : f_) x_.push_back(x_.back() - f);
    blocks_.front().balance = true;
  }
  Real iterate(int k) const { return x_[k]; }
  const std::vector<Block>& blocks() const override { return blocks_; }
  std::vector<Measure> measures(const Evaluation& at, const BlockVector&) override {
    const std::size_t k = index_of(at.x()[0]->getData()[0]);
    return {{"x", k == 0 ? 1 : 1e-13 * k}};
  }
  /// The merit disregards round-off.
  Real merit(const Evaluation& at, const BlockVector&) override { return at.x()[0]->getData()[0] == 0 ? 1 : 0; }

 private:
  std::size_t index_of(Real x) const {
    std::size_t k = 0;
    while (k + 1 < f_.size() && x < (x_[k] + x_[k + 1]) / 2) ++k;
    return k;
  }
  std::vector<Real> f_, x_ = {0};
  std::vector<Block> blocks_;
};

/// Of the iterates with converged measures, the solve returns the one with the smallest error of the sum. An iterate is
/// no solution while a sum exceeds the flows and decreases. A sum that three iterations do not halve is round-off of
/// large stored amounts.
TEST(Newton, ReturnsTheIterateWithTheSmallestImbalance) {
  struct Case {
    std::vector<Real> imbalances;
    int iterations, returned;
  };
  for (const auto& [imbalances, iterations, returned] :
       {Case{{1, 1e-10}, 1, 1},                                                     // the sum closes
        Case{{1, 5e-8, 1e-10}, 2, 2},                                               // after an additional iteration
        Case{{1, 1e-3, 1e-4, 1e-5, 1e-9}, 3, 3},                                    // two additional iterations at most
        Case{{1, 1e-3, 9e-4, 1e-10}, 2, 2},                                         // the last one must halve the error
        Case{{1, 1e-3, 2e-3, 1e-10}, 2, 1},                                         // larger error
        Case{{1, 1e-3, 1e-4, 5e-4, 1e-10}, 3, 2}, Case{{1, 30, 9, 2, 1e-9}, 4, 4},  // above the flows
        Case{{1, 30, 29, 31, 32, 1e-10}, 4, 2},                                     // round-off
        Case{{1, 30, 29, 14, 13, 12, 15, 1e-10}, 6, 5},                             // halved once
        Case{{1, 30, 22, 16, 12, 9, 1e-9}, 6, 6}}) {  // halved in two iterations, again and again
    GivenImbalances problem(Tpetra::getDefaultComm(), imbalances);
    Newton newton(problem, {});
    auto x = problem.constant(0);
    problem.set_time(1, 1);
    const auto report = newton.solve(x);
    ASSERT_TRUE(report.converged) << report.reason;
    EXPECT_EQ(report.iterations, iterations);
    EXPECT_NEAR(x[0]->getData()[0], problem.iterate(returned), 1e-12);
    EXPECT_EQ(report.measures[0].value, 1e-13 * returned);
  }
}

TEST(Newton, SolvesALinearProblemOnceAndKeepsItsFactors) {
  GridProblem problem(Tpetra::getDefaultComm(), {2, 6, 6, false, true, -1});
  Newton newton(problem, {});
  auto x = problem.zero();
  for (int step = 1; step <= 3; ++step) {
    problem.set_time(step, 1);
    const auto report = newton.solve(x);
    ASSERT_TRUE(report.converged) << report.reason;
    EXPECT_EQ(report.iterations, 1);
    EXPECT_EQ(solve::iterations(report.linear_solves), 1);
    EXPECT_TRUE(report.linear_solves.front().used);
  }
  EXPECT_EQ(newton.linear().n_setups(), 1);
  EXPECT_EQ(problem.n_jacobians, 3);
}

TEST(Newton, LineSearchSavesWhatFullStepsLose) {
  // Full Newton steps for atan from 3 alternate in sign and grow.
  ScalarProblem problem(
      Tpetra::getDefaultComm(), 5, [](Real x, Real, Real) { return std::atan(x); },
      [](Real x, Real, Real) { return 1 / (1 + x * x); });
  Newton newton(problem, {});
  auto x = problem.constant(3);
  const auto report = newton.solve(x);
  EXPECT_TRUE(report.converged) << report.reason;
  EXPECT_NEAR(x[0]->normInf(), 0, 1e-10);
}

TEST(Newton, ReportsWhatHasNoSolution) {
  ScalarProblem problem(
      Tpetra::getDefaultComm(), 4, [](Real x, Real, Real) { return 1 + x * x; },
      [](Real x, Real, Real) { return 2 * x; });
  NewtonOptions options;
  options.max_iterations = 7;
  Newton newton(problem, options);
  auto x = problem.constant(3);
  const auto report = newton.solve(x);
  EXPECT_FALSE(report.converged);
  EXPECT_EQ(report.iterations, 7);
  for (const auto& linear : report.linear_solves) EXPECT_FALSE(linear.used);
  EXPECT_NE(report.reason.find("no convergence in 7 iterations: 'r' is"), std::string::npos) << report.reason;
}

TEST(Newton, ReportsASingularJacobian) {
  ScalarProblem problem(
      Tpetra::getDefaultComm(), 4, [](Real x, Real, Real) { return 1 + x * x; },
      [](Real x, Real, Real) { return 2 * x; });
  Newton newton(problem, {});
  auto x = problem.constant(0);
  const auto report = newton.solve(x);
  EXPECT_FALSE(report.converged);
  EXPECT_NE(report.reason.find("singular"), std::string::npos) << report.reason;
  EXPECT_EQ(report.iterations, 4);  // one, and three with damping, which has no effect here
}

TEST(Newton, ReportsWhatIsNotANumber) {
  ScalarProblem problem(
      Tpetra::getDefaultComm(), 4, [](Real x, Real, Real) { return std::log(x); },
      [](Real x, Real, Real) { return 1 / x; });
  Newton newton(problem, {});
  auto x = problem.constant(-1);
  const auto report = newton.solve(x);
  EXPECT_FALSE(report.converged);
  EXPECT_EQ(report.reason, "the residual is not finite");
  auto y = problem.constant(10);  // the full step leads to 10 - 10 log(10) < 0, and is shortened
  EXPECT_TRUE(newton.solve(y).converged);
  for (LocalIndex i = 0; i < static_cast<LocalIndex>(y[0]->getLocalLength()); ++i)
    EXPECT_NEAR(y[0]->getLocalViewHost(Tpetra::Access::ReadOnly)(i, 0), 1, 1e-10);
}

TEST(Newton, PassesErrorsOfTheProblemOn) {
  ScalarProblem problem(
      Tpetra::getDefaultComm(), 4, [](Real, Real, Real) -> Real { throw Error("law: out of range"); },
      [](Real, Real, Real) { return 1; });
  Newton newton(problem, {});
  auto x = problem.constant(0);
  EXPECT_THROW(newton.solve(x), Error);
}

TEST(NewtonOptions, AreReadFromParameters) {
  Teuchos::ParameterList list;
  list.set("tolerance", 1e-7);
  auto& linear = list.sublist("Linear solver");
  linear.set("type", "direct");
  linear.sublist("MUMPS").set("ICNTL(14)", 55);
  auto options = base::read<NewtonOptions>(list, "scene.xml", "Newton");
  EXPECT_EQ(options.tolerance, 1e-7);
  EXPECT_EQ(options.max_iterations, 30);
  GridProblem problem(Tpetra::getDefaultComm(), {});
  const Newton newton(problem, options);
  const auto text = newton.linear().solver().describe();
  EXPECT_EQ(text.find("direct: selected; 60 unknowns"), 0u) << text;
  EXPECT_NE(text.find("ICNTL(14) = 55"), std::string::npos) << text;
  EXPECT_NE(text.find("ICNTL(7) = 7"), std::string::npos) << text;
  linear.set("type", "fast");
  EXPECT_THROW(base::read<NewtonOptions>(list, "scene.xml", "Newton"), Error);
}

TEST(ForcedSolve, AppliesTheJacobianOfTheResidual) {
  GridProblem problem(Tpetra::getDefaultComm(), {});
  solve::CondensedSolve linear(problem, {});
  solve::ForcedSolve forced(problem, linear);
  auto x = problem.zero(), dx = problem.zero();
  for (auto* v : {&x, &dx}) {
    std::vector<Real> values(gather(*v).size());
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::sin(2.3 * i + (v == &x));
    scatter(values, *v);
  }
  const auto f_of = [&](Real h) {
    auto y = problem.zero(), f = problem.zero();
    for (std::size_t b = 0; b < y.size(); ++b) y[b]->update(1, *x[b], h, *dx[b], 0);
    problem.residual(y, f);
    return gather(f);
  };
  auto y = problem.zero();
  forced.jacobian(x);
  forced.apply(dx, y);
  const auto product = gather(y), plus = f_of(1e-6), minus = f_of(-1e-6);
  for (std::size_t i = 0; i < product.size(); ++i) EXPECT_NEAR(product[i], (plus[i] - minus[i]) / 2e-6, 1e-7);
}

}  // namespace
}  // namespace sprekk::test
