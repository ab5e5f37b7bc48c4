#include "solve/balance_check.hpp"
#include "unit/solve/fake_problems.hpp"

#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>

namespace sprekk::test {
namespace {

using solve::BalanceCheck;

/// Blocks of two rows on each rank, with the residual `rows`. The second row of a block may be constrained.
class RowsProblem : public BlockProblem {
 public:
  explicit RowsProblem(const RCP<const Comm>& comm) : comm_(comm), matrix_(4) {
    const GlobalIndex first = 2 * comm->getRank();
    const auto map = make_map({first, first + 1}, comm);
    for (const char* name : {"temperature", "face temperature", "concentration", "displacement"})
      blocks_.push_back({name, map, 1, 1, 1, Teuchos::null, {}});
    for (std::size_t b = 0; b < 3; ++b) {
      blocks_[b].balance = blocks_[b].advected = true;
      blocks_[b].quantity = blocks_[b < 2 ? 0 : b].name;
    }
  }
  using Rows = std::array<std::array<Real, 2>, 4>;
  Rows rows{};
  bool constrains = false;

  BlockVector r() const {
    BlockVector result;
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      result.push_back(rcp(new Vector(blocks_[b].map)));
      for (int i = 0; i < 2; ++i) result[b]->replaceLocalValue(i, rows[b][i]);
    }
    return result;
  }

  RCP<const Comm> comm() const override { return comm_; }
  const std::vector<Block>& blocks() const override { return blocks_; }
  const std::vector<LocalGroup>& local_groups() const override { return groups_; }
  void set_time(Real, Real) override {}
  void commit(const Evaluation&) override {}
  void residual(const Evaluation& at, BlockVector& r) override { raw_residual(at, r); }
  void raw_residual(const Evaluation&, BlockVector& r) override { fields::copy(this->r(), r); }
  void jacobian(const Evaluation&) override {}
  const BlockMatrix& matrix() const override { return matrix_; }
  bool symmetric() const override { return false; }
  ConstView<char*> constrained(int) const override {
    const View<char*> flags("flags", 2);
    const auto host = Kokkos::create_mirror_view(flags);
    host(1) = constrains;
    Kokkos::deep_copy(flags, host);
    return flags;
  }
  std::vector<Measure> measures(const Evaluation&, const BlockVector&) override { return {}; }
  Real merit(const Evaluation&, const BlockVector&) override { return 0; }

 private:
  RCP<const Comm> comm_;
  std::vector<Block> blocks_;
  std::vector<LocalGroup> groups_;
  BlockMatrix matrix_;
};

/// Flows of the first iterate: heat 1e6 W, tracer 1e-3 mol/s.
constexpr RowsProblem::Rows first = {{{1e6, -1e6}, {1e6, 0}, {1e-3, 0}, {1e9, 0}}};
const std::vector<Measure> all_change = {{"temperature", 1}, {"face temperature", 1}, {"concentration", 1}};

/// Returns whether the balances close with these rows of the last iterate.
bool closes(const RowsProblem::Rows& last, const std::vector<Measure>& measures = all_change, bool constrains = false) {
  RowsProblem problem(Tpetra::getDefaultComm());
  problem.constrains = constrains;
  BalanceCheck check(problem);
  check.start(measures, 1e-10);
  problem.rows = first;
  check.note(problem.r());
  problem.rows = last;
  check.note(problem.r());
  return check.imbalance(fields::Evaluation(problem.r())) <= BalanceCheck::allowed;
}

TEST(BalanceCheck, ComparesTheSumOfEachQuantityWithItsOwnFlows) {
  EXPECT_TRUE(closes({{{5, 0}, {-5, 0}, {0, 0}, {1, 0}}}));     // blocks of one quantity exchange it
  EXPECT_FALSE(closes({{{0.2, 0}, {0, 0}, {0, 0}, {0, 0}}}));   // 7e-8 of the heat
  EXPECT_TRUE(closes({{{2e-3, 0}, {0, 0}, {0, 0}, {0, 0}}}));   // 7e-10 of the heat
  EXPECT_FALSE(closes({{{0, 0}, {0, 0}, {1e-5, 0}, {0, 0}}}));  // 1e-2 of the tracer, 1e-12 of the heat
  EXPECT_TRUE(closes({{{0, 0}, {0, 0}, {1e-5, -1e-5}, {0, 0}}}));
}

TEST(BalanceCheck, IgnoresQuantitiesThatTheSolveDoesNotChange) {
  const RowsProblem::Rows last = {{{5, 0}, {0, 0}, {1e-5, 0}, {0, 0}}};
  EXPECT_FALSE(closes(last, {{"temperature", 1}, {"concentration", 1e-11}}));
  EXPECT_FALSE(closes(last, {{"temperature", 1e-11}, {"concentration", 1}}));
  EXPECT_TRUE(closes(last, {{"temperature", 1e-11}, {"concentration", 1e-11}}));
}

/// The flow through a constrained unknown, 1e4 mol/s, is a scale of the sum.
TEST(BalanceCheck, CountsFlowsThroughConstrainedUnknowns) {
  EXPECT_TRUE(closes({{{0, 0}, {0, 0}, {1e-5, 1e4}, {0, 0}}}, all_change, true));
  EXPECT_FALSE(closes({{{0, 0}, {0, 0}, {1e-2, 1e4}, {0, 0}}}, all_change, true));
}

}  // namespace
}  // namespace sprekk::test
