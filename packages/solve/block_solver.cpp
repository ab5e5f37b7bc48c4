// Multigrid for one block, Ifpack2 for another.
#include <Ifpack2_Factory.hpp>
#include <MueLu_CreateTpetraPreconditioner.hpp>

#include "base/check.hpp"
#include "solve/block_solver.hpp"
#include "solve/fine_level.hpp"
#include "multigrid/multigrid.hpp"

namespace sprekk::solve {
namespace {

using fields::Map;
using fields::MultiVector;
using fields::Operator;
using multigrid::Multigrid;
using Teuchos::ParameterList;

constexpr int coarse_size_of_muelu = 1000;

/// Smoothed aggregation for elasticity. A coarse level is solved on one rank: the direct solver of this Trilinos is
/// wrong on several, and must not meet a singular matrix: its exception on that rank would leave the others waiting.
/// The tiny drop tolerance with filtering keeps MueLu from storing patterns of products, which would not fit when
/// contact closes; reuse "tP" keeps the aggregates and makes everything else anew: prolongators that are kept
/// ("RP") were smoothed without contact and do not reach across it. The largest eigenvalue
/// takes more than the usual 10 steps to find where few cells are unlike all others, as those with quarter points at
/// crack tips; with less than it, the smoother would not be positive.
/// A block of rock that is a single node on a coarse level has no neighbour in the graph of the bulk there; it must not
/// be taken for a node without unknowns, which only the finest level has.
ParameterList multigrid_defaults(int n_components, int n_ranks) {
  ParameterList list("MueLu");
  list.set("verbosity", "none");
  list.set("number of equations", n_components);
  list.set("multigrid algorithm", "sa");
  list.set("coarse: max size", coarse_size_of_muelu);
  list.set("reuse: type", "tP");
  list.set("aggregation: drop tol", 1e-12);
  list.set("sa: use filtered matrix", true);
  list.set("aggregation: preserve Dirichlet points", true);
  list.sublist("level 1").set("aggregation: preserve Dirichlet points", false);  // made from the finest
  list.set("rap: fix zero diagonals", true);  // an aggregate of one node has fewer unknowns than there are modes
  list.set("smoother: type", "CHEBYSHEV");
  list.sublist("smoother: params")
      .set("chebyshev: degree", 4)
      .set("chebyshev: ratio eigenvalue", 15.0)
      .set("chebyshev: eigenvalue max iterations", 20);
  if (n_ranks > 1) {
    list.set("repartition: enable", true);
    list.set("repartition: partitioner", "zoltan2");
    list.set("repartition: start level", 1);
    list.set("repartition: min rows per proc", 3 * coarse_size_of_muelu);
    list.set("repartition: target rows per proc", 3 * coarse_size_of_muelu);
    list.set("repartition: max imbalance", 1.3);
  }
  return list;
}

/// Raises the diagonal of a matrix a little while it lives, and leaves its bits as they were: parts that float, in the
/// bulk alone or where contact is open, would make the coarse matrix singular, and its direct solver fail on the one
/// rank that has it.
class RaisedDiagonal {
 public:
  explicit RaisedDiagonal(CrsMatrix& matrix) : matrix_(matrix), values_(base::n_local_rows(matrix)) {
    each([](Real& value, Real& kept) {
      kept = value;
      value *= 1 + 1e-8;
    });
  }
  ~RaisedDiagonal() {
    each([](Real& value, const Real& kept) { value = kept; });
  }
  RaisedDiagonal(const RaisedDiagonal&) = delete;
  RaisedDiagonal& operator=(const RaisedDiagonal&) = delete;

 private:
  template <class Work>
  void each(const Work& work) {
    const auto local = matrix_.getLocalMatrixHost();
    const auto rows = matrix_.getRowMap()->getLocalMap(), columns = matrix_.getColMap()->getLocalMap();
    for (LocalIndex row = 0, n = local.numRows(); row < n; ++row) {
      const LocalIndex diagonal = columns.getLocalElement(rows.getGlobalElement(row));
      for (auto k = local.graph.row_map(row); k < local.graph.row_map(row + 1); ++k)
        if (local.graph.entries(k) == diagonal) work(local.values(k), values_[row]);
    }
  }

  CrsMatrix& matrix_;
  std::vector<Real> values_;
};

/// Another operator, which takes no notice of alpha and beta, and minds them.
class Scaled : public Operator {
 public:
  explicit Scaled(RCP<const Operator> A) : A_(std::move(A)) {}
  RCP<const Map> getDomainMap() const override { return A_->getDomainMap(); }
  RCP<const Map> getRangeMap() const override { return A_->getRangeMap(); }
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp mode, Real alpha, Real beta) const override {
    if (alpha == 1 && beta == 0) return A_->apply(x, y, mode);
    MultiVector Ax(y.getMap(), y.getNumVectors());
    A_->apply(x, Ax, mode);
    y.update(alpha, Ax, beta);
  }

 private:
  RCP<const Operator> A_;
};

class MueLuMultigrid : public BlockSolver {
 public:
  MueLuMultigrid(const std::string& name, const ParameterList& parameters)
      : BlockSolver(fmt::format("multigrid of '{}'", name)), parameters_(parameters) {}

 private:
  using Hierarchy = MueLu::TpetraOperator<Real, LocalIndex, GlobalIndex>;

  void prepare(const DiagonalBlock& block, SolverCost& cost) override {
    // MueLu takes matrices that may change; only RaisedDiagonal changes this one
    const auto matrix = block.matrix->crs();
    const bool anew = hierarchy_.is_null() || (symmetric_ && !block.symmetric);
    if (anew) {
      symmetric_ = block.symmetric;
      const auto make = [&](const RCP<const Matrix>& bulk) { create(block.block, bulk->crs()); };
      block.bulk ? block.bulk(make) : make(block.matrix);
    }
    if (!anew || block.bulk) {
      const RaisedDiagonal raised(*matrix);
      MueLu::ReuseTpetraPreconditioner(matrix, *hierarchy_);
    }
    cost.operator_complexity = hierarchy_->GetHierarchy()->GetOperatorComplexity();
    cost.bytes = (cost.operator_complexity - 1) * base::n_local_entries(*matrix) * (sizeof(Real) + sizeof(LocalIndex));
  }
  RCP<const Operator> prepared() const override { return rcp(new Scaled(hierarchy_)); }

  /// Aggregates by the graph of the bulk, where no edge crosses an interface. Where the matrix is not symmetric the
  /// restriction is smoothed with its transpose.
  void create(const Block& block, const RCP<CrsMatrix>& bulk) {
    const RaisedDiagonal raised(*bulk);
    ParameterList list(parameters_);
    list.get("problem: symmetric", symmetric_);
    list.get("transpose: use implicit", symmetric_);
    auto& user_data = list.sublist("user data");
    if (block.near_null_space.n() > 0)
      user_data.set("Nullspace", rcp(new MultiVector(*block.near_null_space.make(), Teuchos::Copy)));
    user_data.set("Coordinates", rcp(new MultiVector(*block.coordinates, Teuchos::Copy)));
    const RCP<Operator> from = bulk;
    hierarchy_ = MueLu::CreateTpetraPreconditioner(from, list);
  }

  ParameterList parameters_;
  RCP<Hierarchy> hierarchy_;
  bool symmetric_ = true;
};

/// Multigrid on blocks of nodes.
class NodeMultigrid : public BlockSolver {
 public:
  explicit NodeMultigrid(const std::string& name) : BlockSolver(fmt::format("multigrid of '{}'", name)) {}

  bool flat() const override { return !multigrid_.is_null() && multigrid_->flat(); }

 private:
  void prepare(const DiagonalBlock& block, SolverCost& cost) override {
    if (multigrid_.is_null()) {
      const int n = block.block.n_components;
      const auto modes = block.block.near_null_space.make();
      const auto& places = block.block.coordinates;
      multigrid::Nodes nodes;
      const auto look = [&](const RCP<const Matrix>& bulk) {
        nodes = multigrid::nodes_of(multigrid::node_matrix(*bulk, n), modes, places);
      };
      block.bulk ? block.bulk(look) : look(block.matrix);
      multigrid_ = rcp(new Multigrid(block.matrix, std::move(nodes), n, modes));
    }
    multigrid_->setup(block.matrix, block.symmetric, block.careful);
    cost.operator_complexity = multigrid_->operator_complexity();
    cost.bytes = multigrid_->bytes();
    cost.cycle_bytes = multigrid_->cycle_bytes();
  }
  RCP<const Operator> prepared() const override { return multigrid_; }

  RCP<Multigrid> multigrid_;
};

/// A fine level for one block among others.
class TwoLevel : public BlockSolver {
 public:
  TwoLevel(const ParameterList& muelu, const Block& block)
      : BlockSolver(fmt::format("fine level of '{}'", block.name)),
        joined_(std::make_shared<Joined>(std::vector{block.map})),
        level_(muelu, {block}) {}
  std::vector<SolverCost> costs() const override {
    auto all = BlockSolver::costs();
    all.push_back(level_.order_one_cost());
    return all;
  }

 private:
  void prepare(const DiagonalBlock& block, SolverCost&) override {
    level_.setup({joined_, {block.matrix}, block.symmetric, {block}, {}});
  }
  RCP<const Operator> prepared() const override { return level_.inverse(); }

  std::shared_ptr<const Joined> joined_;
  FineLevel level_;
};

bool has_zero_on_diagonal(const Matrix& matrix) {
  Vector diagonal(matrix.row_map());
  matrix.copy_diagonal(diagonal);
  const auto d = diagonal.getLocalViewHost(Tpetra::Access::ReadOnly);
  for (std::size_t i = 0; i < d.extent(0); ++i)
    if (d(i, 0) == 0) return true;
  return false;
}

class Relaxation : public BlockSolver {
 public:
  explicit Relaxation(const std::string& name) : BlockSolver(fmt::format("Gauss-Seidel of '{}'", name)) {}

 private:
  void prepare(const DiagonalBlock& block, SolverCost&) override {
    const bool absent = block.matrix.is_null();
    const auto matrix = absent ? Teuchos::null : block.matrix->crs();  // by all ranks, before any may throw
    SPREKK_CHECK(!absent && !has_zero_on_diagonal(*block.matrix),
                 "its matrix has zeros on the diagonal; solve directly, or eliminate the block locally");
    if (relaxation_.is_null()) {
      relaxation_ = Ifpack2::Factory::create<Tpetra::RowMatrix<Real, LocalIndex, GlobalIndex>>("RELAXATION", matrix);
      ParameterList list;
      list.set("relaxation: type", "Symmetric Gauss-Seidel");
      list.set("relaxation: sweeps", 2);
      relaxation_->setParameters(list);
      relaxation_->initialize();
    }
    relaxation_->compute();
  }
  RCP<const Operator> prepared() const override { return relaxation_; }

  RCP<Ifpack2::Preconditioner<Real, LocalIndex, GlobalIndex>> relaxation_;
};

}  // namespace

bool takes_muelu(const ParameterList& muelu, const Block& block) {
  const int n_modes = block.near_null_space.n() > 0 ? block.near_null_space.n() : block.n_components;
  return muelu.numParams() > 0 || !Multigrid::can_solve(block.n_components, n_modes);
}

ParameterList multigrid_parameters(const ParameterList& muelu, const Block& block) {
  auto list = multigrid_defaults(block.n_components, block.map->getComm()->getSize());
  if (muelu.isParameter("smoother: type")) list.remove("smoother: params");
  list.setParameters(muelu);
  return list;
}

RCP<BlockSolver> make_block_solver(const ParameterList& muelu, const Block& block) {
  if (block.coordinates.is_null()) return rcp(new Relaxation(block.name));
  if (!block.interpolation.is_null()) return rcp(new TwoLevel(muelu, block));
  return make_multigrid(muelu, block);
}

RCP<BlockSolver> make_multigrid(const ParameterList& muelu, const Block& block) {
  if (!takes_muelu(muelu, block)) return rcp(new NodeMultigrid(block.name));
  return rcp(new MueLuMultigrid(block.name, multigrid_parameters(muelu, block)));
}

}  // namespace sprekk::solve
