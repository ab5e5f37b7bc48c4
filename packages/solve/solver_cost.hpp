// What approximate inverses cost: set-ups, applications, memory.
#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "fields/types.hpp"

namespace sprekk::solve {

/// Of one approximate inverse since the start of the run; times and memory are those of this rank.
struct SolverCost {
  std::string name;
  int n_setups = 0;
  long long n_applications = 0;
  double setup_seconds = 0, application_seconds = 0;
  double operator_complexity = 0;  ///< entries of the matrices of all levels over those of the finest; 0: not multigrid
  double bytes = 0;                ///< that it stores on this rank
  double cycle_bytes = 0;          ///< of matrices that an application reads on this rank; 0: not known
  std::vector<GlobalIndex> n_unknowns;     ///< [level] of all ranks; empty: not known, as the following
  std::vector<int> n_ranks;                ///< [level] that have some of them
  double messages = 0, message_bytes = 0;  ///< that this rank receives in an application
};

/// Adds the time that work() takes to `seconds`.
template <class Work>
void timed(double& seconds, const Work& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Another operator, with its applications counted and timed in a cost.
class CountedOperator : public fields::Operator {
 public:
  CountedOperator(RCP<const fields::Operator> counted, std::shared_ptr<SolverCost> cost)
      : counted_(std::move(counted)), cost_(std::move(cost)) {}
  RCP<const fields::Map> getDomainMap() const override { return counted_->getDomainMap(); }
  RCP<const fields::Map> getRangeMap() const override { return counted_->getRangeMap(); }
  void apply(const fields::MultiVector& x, fields::MultiVector& y, Teuchos::ETransp mode, Real alpha,
             Real beta) const override {
    timed(cost_->application_seconds, [&] { counted_->apply(x, y, mode, alpha, beta); });
    ++cost_->n_applications;
  }

 private:
  RCP<const fields::Operator> counted_;
  std::shared_ptr<SolverCost> cost_;
};

}  // namespace sprekk::solve
