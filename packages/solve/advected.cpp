// Preconditioner of quantities that a flow carries: incomplete factors in the order of the flow, or multigrid.
#include "base/over_ranks.hpp"
#include "solve/flow_factors.hpp"
#include "solve/minimal_residual.hpp"
#include "solve/preconditioner.hpp"

namespace sprekk::solve {
namespace {

/// Rows that take from others in a flow, relative to all rows, from which on the flow determines the method.
constexpr Real min_directed = 0.01;
constexpr int n_steps = 4, n_steps_at_rest = 2;  // of the minimal residual

/// Incomplete factors of the matrix of a group, in a few steps of minimal residual. Without a flow, multigrid replaces
/// the factors if there is one.
class Advected : public Preconditioner {
 public:
  Advected(const std::string& block, std::unique_ptr<Preconditioner> at_rest)
      : Preconditioner("ILU", block), at_rest_(std::move(at_rest)) {}

  bool is_symmetric() const override { return false; }
  bool can_be_reused() const override { return false; }
  std::vector<SolverCost> costs() const override {
    auto all = Preconditioner::costs();
    if (at_rest_)
      for (const auto& cost : at_rest_->costs())
        if (cost.n_setups > 0) all.push_back(cost);
    return all;
  }
  void describe(Teuchos::ParameterList& blocks) const override {
    blocks.sublist(block()).set("type", at_rest_ ? "auto" : "ILU");
  }

 private:
  void prepare(const LinearSystem& system, SolverCost& cost) override {
    matrix_.update(system);
    factors_ = rcp(new FlowFactors(*matrix_.crs()));
    const bool flows = !at_rest_ || is_directed(*system.joined->map());
    fields::Vector diagonal(matrix_.matrix()->row_map());
    matrix_.matrix()->copy_diagonal(diagonal);
    if (flows) {
      factors_->factor();
      cost.bytes = factors_->bytes();
      inverse_ = rcp(new MinimalResidual(matrix_.matrix(), factors_, diagonal, n_steps));
    } else {
      at_rest_->setup(system);
      inverse_ = rcp(new MinimalResidual(matrix_.matrix(), at_rest_->inverse(), diagonal, n_steps_at_rest));
    }
  }

  /// Collective.
  bool is_directed(const fields::Map& map) const {
    const auto directed = base::sum_over_ranks<GlobalIndex>(*map.getComm(), factors_->n_directed());
    return directed > min_directed * static_cast<Real>(map.getGlobalNumElements());
  }

  RCP<const fields::Operator> made() const override { return inverse_; }

  std::unique_ptr<Preconditioner> at_rest_;  // null: factors only
  WholeMatrix matrix_;
  RCP<FlowFactors> factors_;
  RCP<const fields::Operator> inverse_;
};

}  // namespace

std::unique_ptr<Preconditioner> make_advected(const std::string& block, std::unique_ptr<Preconditioner> at_rest) {
  return std::make_unique<Advected>(block, std::move(at_rest));
}

}  // namespace sprekk::solve
