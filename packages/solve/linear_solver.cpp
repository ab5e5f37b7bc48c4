#include "solve/linear_solver.hpp"

#include <numeric>
#include <sstream>

#include "base/check.hpp"
#include "base/parameters.hpp"
#include "solve/krylov.hpp"
#include "solve/preconditioner.hpp"

namespace sprekk::solve {

int iterations(const std::vector<LinearReport>& solves) {
  return std::accumulate(solves.begin(), solves.end(), 0,
                         [](int sum, const auto& solve) { return sum + solve.iterations; });
}

namespace {

/// Rejects entries that the libraries would accept. Sprekk determines how MUMPS receives the matrix. Belos does not
/// check counts.
void check_library_entries(base::Section& section, const Teuchos::ParameterList& mumps,
                           const Teuchos::ParameterList& belos) {
  for (const int i : {5, 18, 19, 20, 21, 30, 31}) {
    const auto name = fmt::format("ICNTL({})", i);
    if (mumps.isParameter(name))
      section.fail_inside(
          fmt::format("MUMPS > \"{}\": cannot be set: Sprekk controls the transfer of matrix and solution", name));
  }
  for (const auto& [name, minimum] : {std::pair("Maximum Iterations", 1), std::pair("Maximum Restarts", 0),
                                      std::pair("Num Blocks", 1), std::pair("Block Size", 1)}) {
    const auto* entry = belos.getEntryPtr(name);
    if (entry && !(entry->isType<int>() && Teuchos::getValue<int>(*entry) >= minimum))
      section.fail_inside(
          fmt::format("Belos > \"{}\": is {}, must be an integer, at least {}", name, base::describe(*entry), minimum));
  }
}

}  // namespace

void LinearSolverOptions::describe(base::Section& section) {
  section.choice(
      type, "type", {"auto", "direct", "iterative"},
      "method of linear solves; direct: MUMPS; iterative: Belos with multigrid; auto: direct up to the limits below");
  section.entry(tolerance, "tolerance", "-", base::positive(), "relative residual of every linear solve");
  section.entry(forcing, "forcing", "-",
                "early end of iterative solves: while contact states change, if two accuracies a factor of 100 apart "
                "give the same states; afterwards, if more accuracy does not improve Newton's method");
  section.entry(direct_limit_2d, "direct limit 2D", "-",
                "maximum number of unknowns for direct solves in 2D, with type auto");
  section.entry(direct_limit_3d, "direct limit 3D", "-",
                "maximum number of unknowns for direct solves in 3D, with type auto");
  section.entry(reproducible, "reproducible", "-",
                "bitwise reproducibility of direct solves on several ranks, by factorisation on rank 0 alone; absent: "
                "true with checkpoints");
  section.passthrough(mumps, "MUMPS", "control parameters of MUMPS by the names ICNTL(i) and CNTL(i)");
  section.passthrough(belos, "Belos", "parameters of the library Belos; \"Solver Type\" selects another Krylov method");
  section.hint({"MueLu"},
               "It belongs to a block: Solver > Blocks > (field) > \"type\" MueLu, and \"MueLu\" in the same section.");
  check_library_entries(section, mumps, belos);
}

std::string ChosenSolver::describe() const {
  std::ostringstream text;
  text << reason << '\n';
  solver->parameters().print(text, Teuchos::ParameterList::PrintOptions().indent(2).showTypes(false));
  return text.str();
}

ChosenSolver make_linear_solver(const LinearSolverOptions& options, const std::vector<Block>& blocks) {
  bool is_3d = false;
  long long n = 0;
  for (const auto& block : blocks) {
    is_3d = is_3d || (!block.coordinates.is_null() && block.coordinates->getNumVectors() == 3);
    n += block.map->getGlobalNumElements();
  }
  const long long limit = is_3d ? options.direct_limit_3d : options.direct_limit_2d;
  const bool direct = options.type == "direct" || (options.type == "auto" && n <= limit);
  std::string reason = options.type == "auto"
                           ? fmt::format("{}: {} with {} unknowns; direct up to {}", direct ? "direct" : "iterative",
                                         is_3d ? "3D" : "2D", n, limit)
                           : fmt::format("{}: selected; {} unknowns", options.type, n);
  if (!direct) {
    make_direct_solver(options.mumps);  // only for its checks
    return {make_iterative_solver(options, blocks), reason};
  }
  make_preconditioner(options.preconditioner, blocks);  // only for its checks: options must be valid in any case
  check_krylov(options.belos, blocks.front().map->getComm());
  const int n_ranks = blocks.front().map->getComm()->getSize();
  const bool on_one_rank = options.reproducible.value_or(false) && n_ranks > 1;
  if (on_one_rank) reason += "; reproducible: factored on rank 0";
  return {make_direct_solver(options.mumps, on_one_rank ? 1 : n_ranks), reason};
}

Real relative_residual(const fields::Operator& matrix, const Vector& b, const Vector& x, Vector& r) {
  matrix.apply(x, r);
  r.update(1, b, -1);
  const Real size = b.norm2(), residual = r.norm2();
  return residual == 0 ? 0 : residual / size;
}

}  // namespace sprekk::solve
