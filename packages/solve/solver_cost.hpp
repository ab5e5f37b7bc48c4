// Costs of approximate inverses: set-ups, applications, memory.
#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "fields/types.hpp"

namespace sprekk::solve {

/// Costs of one approximate inverse since the start of the run. Times and memory are those of this rank.
struct SolverCost {
  std::string name;
  int n_setups = 0;
  long long n_applications = 0;
  double setup_seconds = 0, application_seconds = 0;
  double operator_complexity = 0;          ///< matrix entries of all levels, relative to the finest; 0: not multigrid
  double bytes = 0;                        ///< stored on this rank, bytes
  double cycle_bytes = 0;                  ///< matrices read by an application on this rank, bytes; 0: unknown
  std::vector<GlobalIndex> n_unknowns;     ///< [level] over all ranks; empty: unknown, also below
  std::vector<int> n_ranks;                ///< [level] number of ranks with unknowns
  double messages = 0, message_bytes = 0;  ///< received by this rank in an application
};

/// Adds the time of work(), s, to `seconds`.
template <class Work>
void timed(double& seconds, const Work& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Operator that counts and times the applications of another one.
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
