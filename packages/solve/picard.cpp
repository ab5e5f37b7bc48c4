#include "solve/picard.hpp"

namespace sprekk::solve {
namespace {

using Lag = BlockProblem::Lag;

constexpr Real far = 1;        // limit for |ln| of the ratio of coefficients
constexpr Real closer = 0.3;   // factor of the distance after a failure of Newton's method
constexpr Real little = 0.05;  // for near_, reached after three failures of Newton's method
constexpr Real min_step = 0.25, max_growth = 1e3;

}  // namespace

Picard::Picard(BlockProblem& problem, const Evaluation& x) : problem_(problem) {
  problem_.lag(Lag::none, x);
  possible_ = lags_ = problem_.lag(Lag::follow, x) >= 0;
}

bool Picard::agrees() const { return near_ < little; }

bool Picard::follow(const Evaluation& x) {
  const bool first = n_++ == 0;
  fresh_ = first;
  const Real away = problem_.lag(Lag::follow, x);
  if (first && !(away <= far)) {
    problem_.lag(Lag::widest, x);
    return true;
  }
  if (away < near_) {
    problem_.lag(Lag::none, x);
    lags_ = false;
  }
  return false;
}

bool Picard::resume(const Evaluation& from, Real step, Real merit, Real merit_before) {
  if (step >= min_step && merit <= max_growth * merit_before) return false;
  problem_.lag(Lag::follow, from);
  lags_ = fresh_ = true;
  near_ *= closer;
  return true;
}

}  // namespace sprekk::solve
