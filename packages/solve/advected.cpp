// Preconditioner of quantities that a flow carries, without a coarse level.
#include "solve/flow_factors.hpp"
#include "solve/minimal_residual.hpp"
#include "solve/preconditioner.hpp"

namespace sprekk::solve {
namespace {

constexpr int n_steps = 4;  // of the minimal residual

/// Incomplete factors of the matrix of a group, in a few steps of minimal residual.
class Advected : public Preconditioner {
 public:
  explicit Advected(const std::string& block) : Preconditioner("ILU", block) {}

  bool is_symmetric() const override { return false; }
  bool can_be_reused() const override { return false; }
  void describe(Teuchos::ParameterList& blocks) const override { blocks.sublist(block()).set("type", "ILU"); }

 private:
  void prepare(const LinearSystem& system, SolverCost& cost) override {
    matrix_.update(system);
    const auto factors = rcp(new FlowFactors(*matrix_.crs()));
    cost.bytes = factors->bytes();
    inverse_ = minimal_residual(matrix_.matrix(), factors, n_steps);
  }
  RCP<const fields::Operator> made() const override { return inverse_; }

  WholeMatrix matrix_;
  RCP<const fields::Operator> inverse_;
};

}  // namespace

std::unique_ptr<Preconditioner> make_advected(const std::string& block) { return std::make_unique<Advected>(block); }

}  // namespace sprekk::solve
