#include "solve/krylov.hpp"

#include <BelosCGIteration.hpp>
#include <BelosSolverFactory.hpp>
#include <BelosTpetraAdapter.hpp>

#include <algorithm>

#include "base/check.hpp"
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

/// By what the methods that are used here, or the one that is asked for, know.
void check_krylov(const ParameterList& given) {
  std::vector<std::string> methods = {"Pseudo Block CG", "Block GMRES"};
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
  check_names(ParameterList(given).setName("Belos"), lists);
}

namespace {

/// A that calls a function before each product.
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
                 const std::string& usual, const Vector& b, Vector& x, Real tolerance, int most,
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
  if (most > 0) list->set("Maximum Iterations", std::min(most, list->get<int>("Maximum Iterations")));
  Belos::SolverFactory<Real, MultiVector, Operator> factory;
  const auto solver = factory.create(method, list);
  solver->setProblem(problem);
  try {
    const bool converged = solver->solve() == Belos::Converged;
    return {converged || solver->isLOADetected(), solver->getNumIters()};
  } catch (const Belos::CGIterateFailure&) {  // by sums over all ranks, on all of them
    return {false, 0, true};
  }
}

}  // namespace sprekk::solve
