// Belos, preconditioned from the right by MueLu.
#include <BelosSolverFactory.hpp>
#include <BelosTpetraAdapter.hpp>
#include <MueLu_CreateTpetraPreconditioner.hpp>
#include <MueLu_MasterList.hpp>

#include "base/check.hpp"
#include "solve/linear_solver.hpp"

namespace sprekk::solve {
namespace {

using fields::MultiVector;
using fields::Operator;
using Teuchos::ParameterList;

constexpr int coarse_size = 1000;

/// Smoothed aggregation for elasticity. A coarse level is solved on one rank: the direct solver of this Trilinos is
/// wrong on several, and must not meet a singular matrix: its exception on that rank would leave the others waiting.
/// The tiny drop tolerance with filtering keeps MueLu from storing patterns of products, which would not fit when
/// contact closes; reuse "tP" keeps the aggregates and makes everything else anew.
ParameterList multigrid_defaults(int n_components, int n_ranks) {
  ParameterList list("MueLu");
  list.set("verbosity", "none");
  list.set("number of equations", n_components);
  list.set("multigrid algorithm", "sa");
  list.set("coarse: max size", coarse_size);
  list.set("transpose: use implicit", true);
  list.set("reuse: type", "tP");
  list.set("aggregation: drop tol", 1e-12);
  list.set("sa: use filtered matrix", true);
  list.set("rap: fix zero diagonals", true);  // an aggregate of one node has fewer unknowns than there are modes
  list.set("smoother: type", "CHEBYSHEV");
  list.sublist("smoother: params").set("chebyshev: degree", 2).set("chebyshev: ratio eigenvalue", 7.0);
  if (n_ranks > 1) {
    list.set("repartition: enable", true);
    list.set("repartition: partitioner", "zoltan2");
    list.set("repartition: start level", 1);
    list.set("repartition: min rows per proc", 3 * coarse_size);
    list.set("repartition: target rows per proc", 3 * coarse_size);
    list.set("repartition: max imbalance", 1.3);
  }
  return list;
}

ParameterList krylov_defaults() {
  ParameterList list("Belos");
  list.set("Maximum Iterations", 500);
  list.set("Num Blocks", 200, "basis of GMRES");
  list.set("Implicit Residual Scaling", "Norm of RHS");
  list.set("Explicit Residual Scaling", "Norm of RHS");
  return list;
}

/// Throws an Error that names the entry if a list has one that the library does not know; `allowed` are its lists.
void check_names(const ParameterList& given, const std::vector<ParameterList>& allowed) {
  for (const auto& item : given) {
    const std::string& name = item.first;
    bool known = name.rfind("level ", 0) == 0 || name == "user data";  // MueLu's sections of one level
    for (const auto& list : allowed) known = known || list.isParameter(name) || list.isSublist(name);
    SPREKK_CHECK(known, "{} has no parameter \"{}\"; its manual lists those that it has", given.name(), name);
  }
}

/// What the Krylov methods that are used here, or the one that is asked for, know.
std::vector<ParameterList> belos_parameters(const ParameterList& given) {
  std::vector<std::string> methods = {"Pseudo Block CG", "Pseudo Block GMRES"};
  if (given.isParameter("Solver Type")) methods = {given.get<std::string>("Solver Type")};
  std::vector<ParameterList> lists(1);
  lists[0].set("Solver Type", "");
  Belos::SolverFactory<Real, MultiVector, Operator> factory;
  for (const auto& method : methods) {
    try {
      lists.push_back(*factory.create(method, Teuchos::parameterList())->getValidParameters());
    } catch (const std::exception&) {
      throw Error(fmt::format("Belos has no solver \"{}\"", method));
    }
  }
  return lists;
}

/// The last paragraph of an exception's text: what went wrong, without the place in the library.
std::string gist(const std::string& text) {
  const auto end = text.find_last_not_of('\n') + 1, gap = text.rfind("\n\n", end - 1);
  return gap == std::string::npos ? text : text.substr(gap + 2, end - gap - 2);
}

class IterativeSolver : public LinearSolver {
 public:
  IterativeSolver(const LinearSolverOptions& options, const Block& block) : parameters_("iterative") {
    check_names(ParameterList(options.muelu).setName("MueLu"), {*MueLu::MasterList::List()});
    check_names(ParameterList(options.belos).setName("Belos"), belos_parameters(options.belos));
    parameters_.sublist("MueLu") = multigrid_defaults(block.n_components, block.map->getComm()->getSize());
    if (options.muelu.isParameter("smoother: type")) parameters_.sublist("MueLu").remove("smoother: params");
    parameters_.sublist("MueLu").setParameters(options.muelu);
    parameters_.sublist("Belos") = krylov_defaults();
    parameters_.sublist("Belos").setParameters(options.belos);
    // A matrix of the size of a coarse level is one: its direct solver is all of multigrid then.
    const int largest_coarse = parameters_.sublist("MueLu").get<int>("coarse: max size");
    if (static_cast<long long>(block.map->getGlobalNumElements()) <= largest_coarse) {
      coarse_ = make_direct_solver(options.mumps);
      parameters_.sublist("MUMPS") = coarse_->parameters();
    }
  }

  bool reads_bulk() const override { return !coarse_; }

  std::string setup(const RCP<const CrsMatrix>& matrix, const Block& block, bool symmetric,
                    const RCP<const CrsMatrix>& bulk) override {
    if (coarse_) return coarse_->setup(matrix, block, symmetric, bulk);
    symmetric_ = symmetric;
    // Tpetra's and MueLu's interfaces take operators that may change; nothing here changes the matrix.
    matrix_ = Teuchos::rcp_const_cast<CrsMatrix>(matrix);
    try {
      base::collectively(*matrix->getComm(), [&] {
        raised_ = raised(*matrix);
        if (preconditioner_.is_null()) create(block, bulk);
        MueLu::ReuseTpetraPreconditioner(raised_, *preconditioner_);
      });
      failure_.clear();
    } catch (const Error& error) {
      preconditioner_ = Teuchos::null;
      failure_ = fmt::format("multigrid set-up: {}", gist(error.what()));
    }
    return failure_;
  }

  LinearReport solve(const Vector& b, Vector& x, Real tolerance) override {
    if (coarse_) return coarse_->solve(b, x, tolerance);
    LinearReport report;
    x.putScalar(0);
    report.reason = failure_;
    if (!failure_.empty() || b.normInf() == 0) {
      report.converged = failure_.empty();
      return report;
    }
    try {
      base::collectively(*matrix_->getComm(), [&] { report.iterations = iterate(b, x, tolerance); });
    } catch (const Error& error) {
      report.reason = fmt::format("iterative solve: {}", gist(error.what()));
      return report;
    }
    Vector r(b.getMap());
    report.residual = relative_residual(*matrix_, b, x, r);
    report.converged = report.residual <= std::max(10 * tolerance, acceptable_linear_residual);
    if (!report.converged)
      report.reason = fmt::format("iterative solve: relative residual {:.1e} after {} iterations, {:.0e} was asked for",
                                  report.residual, report.iterations, tolerance);
    return report;
  }

  const ParameterList& parameters() const override { return parameters_; }

 private:
  /// The matrix with its diagonal raised a little: parts that float, in the bulk alone or where contact is open, would
  /// make the coarse matrix singular, and its direct solver fail on the one rank that has it.
  static RCP<CrsMatrix> raised(const CrsMatrix& matrix) {
    const auto copy = rcp(new CrsMatrix(matrix, Teuchos::Copy));
    const auto local = copy->getLocalMatrixHost();
    const auto& columns = *copy->getColMap();
    for (LocalIndex row = 0, n = local.numRows(); row < n; ++row)
      for (auto k = local.graph.row_map(row); k < local.graph.row_map(row + 1); ++k)
        if (columns.getGlobalElement(local.graph.entries(k)) == copy->getRowMap()->getGlobalElement(row))
          local.values(k) *= 1 + 1e-8;
    return copy;
  }

  /// Aggregates by the graph of the bulk, where no edge crosses an interface.
  void create(const Block& block, const RCP<const CrsMatrix>& bulk) {
    ParameterList list(parameters_.sublist("MueLu"));
    auto& user_data = list.sublist("user data");
    if (!block.near_null_space.is_null())
      user_data.set("Nullspace", rcp(new MultiVector(*block.near_null_space, Teuchos::Copy)));
    if (!block.coordinates.is_null())
      user_data.set("Coordinates", rcp(new MultiVector(*block.coordinates, Teuchos::Copy)));
    const RCP<Operator> from = bulk.is_null() ? raised_ : raised(*bulk);
    preconditioner_ = MueLu::CreateTpetraPreconditioner(from, list);
  }

  int iterate(const Vector& b, Vector& x, Real tolerance) {
    using Problem = Belos::LinearProblem<Real, MultiVector, Operator>;
    const auto problem =
        rcp(new Problem(matrix_, Teuchos::rcpFromRef<MultiVector>(x), Teuchos::rcpFromRef<const MultiVector>(b)));
    problem->setRightPrec(preconditioner_);
    problem->setProblem();
    const auto list = rcp(new ParameterList(parameters_.sublist("Belos")));
    const std::string method = list->get("Solver Type", symmetric_ ? "Pseudo Block CG" : "Pseudo Block GMRES");
    list->remove("Solver Type");
    if (method.find("GMRES") == std::string::npos) list->remove("Num Blocks", false);
    list->get("Convergence Tolerance", tolerance);
    Belos::SolverFactory<Real, MultiVector, Operator> factory;
    const auto solver = factory.create(method, list);
    solver->setProblem(problem);
    solver->solve();
    return solver->getNumIters();
  }

  ParameterList parameters_;
  std::unique_ptr<LinearSolver> coarse_;
  RCP<CrsMatrix> matrix_, raised_;
  RCP<MueLu::TpetraOperator<Real, LocalIndex, GlobalIndex>> preconditioner_;
  bool symmetric_ = false;
  std::string failure_ = "the matrix was not set up";
};

}  // namespace

std::unique_ptr<LinearSolver> make_iterative_solver(const LinearSolverOptions& options, const Block& block) {
  return std::make_unique<IterativeSolver>(options, block);
}

}  // namespace sprekk::solve
