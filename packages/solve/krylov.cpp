#include "solve/krylov.hpp"

#include <BelosCGIteration.hpp>
#include <BelosSolverFactory.hpp>
#include <BelosTpetraAdapter.hpp>

#include <Teuchos_oblackholestream.hpp>

#include <algorithm>
#include <array>
#include <set>

#include "base/check.hpp"
#include "base/text.hpp"
#include "solve/preconditioner.hpp"

namespace sprekk::solve {

using fields::MultiVector;
using fields::Operator;
using Teuchos::ParameterList;

ParameterList krylov_defaults() {
  ParameterList list("Belos");
  list.set("Maximum Iterations", 500);
  list.set("Num Blocks", 60, "basis of GMRES");
  list.set("Implicit Residual Scaling", "Norm of RHS");
  list.set("Explicit Residual Scaling", "Norm of RHS");
  return list;
}

namespace {

/// Operator A that calls a function before each product.
class Watched : public Operator {
 public:
  Watched(const RCP<const Operator>& A, const std::function<void()>& before) : A_(A), before_(before) {}
  RCP<const fields::Map> getDomainMap() const override { return A_->getDomainMap(); }
  RCP<const fields::Map> getRangeMap() const override { return A_->getRangeMap(); }
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp mode, Real alpha, Real beta) const override {
    before_();
    A_->apply(x, y, mode, alpha, beta);
  }

 private:
  RCP<const Operator> A_;
  std::function<void()> before_;
};

}  // namespace

KrylovEnd krylov(const RCP<const Operator>& A, const RCP<const Operator>& M, const ParameterList& parameters,
                 const std::string& usual, const Vector& b, Vector& x, Real tolerance, int maximum,
                 const std::function<void()>& before_product) {
  using Problem = Belos::LinearProblem<Real, MultiVector, Operator>;
  RCP<const Operator> watched = A;
  if (before_product) watched = rcp(new Watched(A, before_product));
  const auto problem =
      rcp(new Problem(watched, Teuchos::rcpFromRef<MultiVector>(x), Teuchos::rcpFromRef<const MultiVector>(b)));
  problem->setRightPrec(M);
  problem->setProblem();
  const auto list = rcp(new ParameterList(parameters));
  const std::string method = list->get("Solver Type", usual);
  list->remove("Solver Type");
  if (method.find("GMRES") == std::string::npos) list->remove("Num Blocks", false);
  list->get("Convergence Tolerance", tolerance);
  if (maximum > 0) list->set("Maximum Iterations", std::min(maximum, list->get<int>("Maximum Iterations")));
  Belos::SolverFactory<Real, MultiVector, Operator> factory;
  const auto solver = factory.create(method, list);
  solver->setProblem(problem);
  try {
    const bool converged = solver->solve() == Belos::Converged;
    return {converged || solver->isLOADetected(), solver->getNumIters()};
  } catch (const Belos::CGIterateFailure&) {  // thrown on all ranks, as it depends on global sums
    return {false, 0, true};
  }
}

namespace {

const std::string place = "Sprekk > Solver > Linear solver > Belos";

/// Returns all parameters of a solver with defaults; null if Belos has no such solver for these matrices.
RCP<const ParameterList> parameters_of(const std::string& method) {
  try {
    return Belos::SolverFactory<Real, MultiVector, Operator>()
        .create(method, Teuchos::parameterList())
        ->getValidParameters();
  } catch (const std::exception&) {
    return Teuchos::null;
  }
}

std::vector<std::string> solvers() {
  std::set<std::string> names;
  for (const auto& name : Belos::SolverFactory<Real, MultiVector, Operator>().supportedSolverNames())
    if (!parameters_of(name).is_null()) names.insert(name);
  return {names.begin(), names.end()};
}

RCP<fields::CrsMatrix> small_matrix(int n, const RCP<const Comm>& comm) {
  const auto map = rcp(new fields::Map(n, 0, comm));
  const auto matrix = rcp(new fields::CrsMatrix(map, 1));
  for (const GlobalIndex row : base::local_elements(*map))
    matrix->insertGlobalValues(row, 1, std::array{1.0 + static_cast<Real>(row)}.data(), &row);
  matrix->fillComplete();
  return matrix;
}

/// Tries the parameters on a small system. A breakdown of the method is ignored, as it may work on other systems.
/// Throws a RefusedList for other exceptions. Collective.
void try_parameters(const ParameterList& given, const std::string& method, const RCP<const Comm>& comm) {
  auto parameters = krylov_defaults();
  parameters.setParameters(given);
  if (given.isParameter("Verbosity"))
    parameters.set<RCP<std::ostream>>("Output Stream", rcp(new Teuchos::oblackholestream));
  const auto A = small_matrix(200 + 2 * parameters.get<int>("Num Blocks"), comm);  // bases must fit
  fields::Vector b(A->getRowMap()), x(A->getRowMap());
  b.putScalar(1);
  try {
    krylov(A, A, parameters, method, b, x, 1e-6);
  } catch (const Belos::BelosError&) {
  } catch (const std::exception& error) {
    throw RefusedList(fmt::format("{}: {}", place, gist(error.what())));
  }
}

}  // namespace

/// Checks against the valid parameters of the selected method, else of the default methods.
void check_krylov(const ParameterList& given, const RCP<const Comm>& comm) {
  if (given.numParams() == 0) return;
  std::vector<std::string> methods = {"Pseudo Block CG", "Block GMRES"};
  if (given.isParameter("Solver Type")) {
    SPREKK_CHECK(given.isType<std::string>("Solver Type"), "{} > \"Solver Type\": must be the name of a solver", place);
    methods = {given.get<std::string>("Solver Type")};
  }
  std::vector<ParameterList> lists(1);
  lists[0].set("Solver Type", "");
  for (const auto& method : methods)
    if (const auto valid = parameters_of(method); valid.is_null())
      throw RefusedList(fmt::format("{} > \"Solver Type\": Belos has no solver \"{}\"; it has {}", place, method,
                                    base::quoted_list(solvers())));
    else
      lists.push_back(*valid);
  check_names(place, given, lists);
  for (const auto& method : methods) try_parameters(given, method, comm);
}

}  // namespace sprekk::solve
