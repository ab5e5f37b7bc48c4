// Smoothed aggregation of MueLu, for one block or several joined blocks.
#include <Amesos2_Factory.hpp>
#include <Ifpack2_Factory.hpp>
#include <MueLu_CreateTpetraPreconditioner.hpp>
#include <MueLu_MasterList.hpp>

#include "base/check.hpp"
#include "solve/preconditioner.hpp"

namespace sprekk::solve {
namespace {

using fields::Map;
using fields::MultiVector;
using fields::Operator;
using Teuchos::ParameterList;

constexpr int coarse_size_of_muelu = 1000;

/// Returns the parameters of smoothed aggregation for elasticity.
/// - Coarse level: on one rank, because the direct solver of this Trilinos is wrong on several. Its matrix must not be
///   singular: an exception on this rank would leave the others waiting.
/// - Drop tolerance, tiny, with filtering: prevents MueLu from storing patterns of products, which become invalid when
///   contact closes.
/// - Reuse "tP": keeps aggregates only. Prolongators kept by "RP" were smoothed without contact and do not extend
///   across it.
/// - Eigenvalue iterations: more than the default of 10. A few cells may differ from all others, e.g. quarter-point
///   cells at crack tips. With an underestimated eigenvalue, the smoother would not be positive.
/// - Dirichlet points: only on the finest level. A block of rock with a single coarse node has no neighbours in the
///   graph of the bulk. It must not be treated as a node without unknowns.
ParameterList multigrid_defaults(int n_components, int n_ranks, bool has_places) {
  ParameterList list("MueLu");
  list.set("verbosity", "none");
  list.set("number of equations", n_components);
  list.set("multigrid algorithm", "sa");
  list.set("coarse: max size", coarse_size_of_muelu);
  list.set("reuse: type", "tP");
  list.set("aggregation: drop tol", 1e-12);
  list.set("sa: use filtered matrix", true);
  list.set("aggregation: preserve Dirichlet points", true);
  list.sublist("level 1").set("aggregation: preserve Dirichlet points", false);  // level made from the finest
  list.set("rap: fix zero diagonals", true);  // an aggregate of one node has fewer unknowns than modes
  list.set("smoother: type", "CHEBYSHEV");
  list.sublist("smoother: params")
      .set("chebyshev: degree", 4)
      .set("chebyshev: ratio eigenvalue", 15.0)
      .set("chebyshev: eigenvalue max iterations", 20);
  if (n_ranks > 1 && !has_places) list.set("coarse: type", "RELAXATION");  // on the ranks of the level
  if (n_ranks > 1 && has_places) {
    list.set("repartition: enable", true);
    list.set("repartition: partitioner", "zoltan2");
    list.set("repartition: start level", 1);
    list.set("repartition: min rows per proc", 3 * coarse_size_of_muelu);
    list.set("repartition: target rows per proc", 3 * coarse_size_of_muelu);
    list.set("repartition: max imbalance", 1.3);
  }
  return list;
}

/// Returns whether MueLu makes this smoother itself, with more data than parameters.
bool is_of_muelu(const std::string& type) {
  return type.rfind("LINESMOOTHING", 0) == 0 || type == "TOPOLOGICAL" || type == "AGGREGATE" || type == "HIPTMAIR";
}

/// Checks the parameters of a smoother, or of the solver of a coarse level, of this type.
void check_smoother(const std::string& place, const std::string& type, const ParameterList& given,
                    const RCP<const Comm>& comm) {
  static const std::vector<std::string> of_muelu = {
      "smoother: use blockcrsmatrix storage", "chebyshev: use rowsumabs diagonal scaling",
      "chebyshev: rowsumabs diagonal replacement tolerance", "chebyshev: rowsumabs diagonal replacement value"};
  if (is_of_muelu(type)) return;
  if (Ifpack2::Factory::isSupported<Tpetra::RowMatrix<Real, LocalIndex, GlobalIndex>>(type))
    return check_ifpack2(place, type, given, comm, of_muelu);
  ParameterList of_direct_solvers;
  of_direct_solvers.set("fix nullspace", false);
  check_names(place, given, {of_direct_solvers});
}

void check_coarse_type(const std::string& place, const ParameterList& given) {
  if (!given.isType<std::string>("coarse: type")) return;
  const auto type = given.get<std::string>("coarse: type");
  const bool known = type.empty() || type == "none" || is_of_muelu(type) || Amesos2::query(type) ||
                     Ifpack2::Factory::isSupported<Tpetra::RowMatrix<Real, LocalIndex, GlobalIndex>>(type);
  if (!known)
    throw RefusedList(
        fmt::format("{} > \"coarse: type\": is \"{}\", which neither Amesos2 nor Ifpack2 has here", place, type));
}

/// Checks the list of a scene, or its section for one level. `whole` contains the types that it omits.
void check_lists(const std::string& place, const ParameterList& given, const ParameterList& whole,
                 const RCP<const Comm>& comm) {
  check_names(place, given, {*MueLu::MasterList::List()});
  check_coarse_type(place, given);
  for (const std::string smoother : {"smoother: ", "smoother: pre ", "smoother: post ", "coarse: "}) {
    if (!given.isSublist(smoother + "params")) continue;
    std::string type;
    for (const auto* list : {&whole, &given})
      for (const std::string& of : {smoother == "coarse: " ? smoother : "smoother: ", smoother})
        if (list->isType<std::string>(of + "type")) type = list->get<std::string>(of + "type");
    check_smoother(fmt::format("{} > {}params", place, smoother), type, given.sublist(smoother + "params"), comm);
  }
}

/// Throws a RefusedList if MueLu, or a library to which it passes a nested list, rejects an entry of `given`; `whole`:
/// the defaults, overridden by `given`.
void check(const std::string& place, const ParameterList& given, const ParameterList& whole,
           const RCP<const Comm>& comm) {
  ParameterList top(given);
  top.remove("user data", false);
  for (const auto& item : given) {
    const std::string& name = item.first;
    if (name.rfind("level ", 0) != 0 || !item.second.isList()) continue;
    check_lists(place + " > " + name, given.sublist(name), whole, comm);
    top.remove(name);
  }
  check_lists(place, top, whole, comm);
  ParameterList list(whole);
  try {
    MueLu::ParameterListInterpreter<Real, LocalIndex, GlobalIndex, Map::node_type> interpreter(list, comm);
  } catch (const std::exception& error) {
    throw RefusedList(fmt::format("{}: {}", place, gist(error.what())));
  }
}

/// Raises the diagonal of a matrix slightly during its lifetime, and then restores it bitwise. Floating parts, in the
/// bulk or at open contact, would make the coarse matrix singular. The direct solver would then fail on its one rank.
class RaisedDiagonal {
 public:
  explicit RaisedDiagonal(CrsMatrix& matrix) : matrix_(matrix), values_(base::n_local_rows(matrix)) {
    each([](Real& value, Real& saved) {
      saved = value;
      value *= 1 + 1e-8;
    });
  }
  ~RaisedDiagonal() {
    each([](Real& value, const Real& saved) { value = saved; });
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

/// Adds support of alpha and beta to an operator that ignores them.
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

/// Multigrid of MueLu. One block: with its coordinates and near-null space, aggregated by its bulk. Several blocks: by
/// the matrix only.
class MueLuMultigrid : public Preconditioner {
 public:
  /// `given`: the scene contains some of the parameters.
  MueLuMultigrid(const std::string& block, const ParameterList& parameters, bool given)
      : Preconditioner("multigrid", block), parameters_(parameters), given_(given) {}

  int coarse_size() const override { return parameters_.get<int>("coarse: max size"); }
  void describe(ParameterList& blocks) const override {
    auto& list = blocks.sublist(block());
    list.set("type", "MueLu");
    list.sublist("MueLu").setParameters(parameters_);
  }

 private:
  std::string given_list() const override { return given_ ? "MueLu" : ""; }
  using Hierarchy = MueLu::TpetraOperator<Real, LocalIndex, GlobalIndex>;

  void prepare(const LinearSystem& system, SolverCost& cost) override {
    matrix_.update(system);
    const auto matrix = matrix_.crs();  // changed by RaisedDiagonal only
    const auto& bulk = system.diagonal.front().bulk;
    const bool by_bulk = bulk && system.diagonal.size() == 1;
    // with advection, strong couplings depend on the values: those of an earlier flow are outdated
    const bool rebuild = hierarchy_.is_null() || system.diagonal.front().is_other_graph ||
                         (symmetric_ && !system.symmetric) || system.diagonal.front().block.advected;
    if (rebuild) {
      symmetric_ = system.symmetric;
      if (by_bulk)
        bulk([&](const RCP<const Matrix>& of_bulk) { create(system, of_bulk->crs()); });
      else
        create(system, matrix);
    }
    if (!rebuild || by_bulk) {
      const RaisedDiagonal raised(*matrix);
      MueLu::ReuseTpetraPreconditioner(matrix, *hierarchy_);
    }
    cost.operator_complexity = hierarchy_->GetHierarchy()->GetOperatorComplexity();
    cost.bytes = (cost.operator_complexity - 1) * base::n_local_entries(*matrix) * (sizeof(Real) + sizeof(LocalIndex));
  }
  RCP<const Operator> made() const override { return rcp(new Scaled(hierarchy_)); }

  /// Creates the hierarchy. Aggregates follow the graph of the bulk, which has no edge across interfaces. For
  /// nonsymmetric matrices, the restriction is smoothed with the transposed matrix.
  void create(const LinearSystem& system, const RCP<CrsMatrix>& bulk) {
    const RaisedDiagonal raised(*bulk);
    ParameterList list(parameters_);
    list.get("problem: symmetric", symmetric_);
    list.get("transpose: use implicit", symmetric_);
    const auto& first = system.diagonal.front().block;
    if (system.diagonal.size() == 1 && !first.coordinates.is_null()) {
      auto& user_data = list.sublist("user data");
      if (first.near_null_space.n() > 0)
        user_data.set("Nullspace", rcp(new MultiVector(*first.near_null_space.make(), Teuchos::Copy)));
      user_data.set("Coordinates", rcp(new MultiVector(*first.coordinates, Teuchos::Copy)));
    }
    const RCP<Operator> from = bulk;
    hierarchy_ = MueLu::CreateTpetraPreconditioner(from, list);
  }

  ParameterList parameters_;
  bool given_;
  WholeMatrix matrix_;
  RCP<Hierarchy> hierarchy_;
  bool symmetric_ = true;
};

}  // namespace

std::unique_ptr<Preconditioner> make_muelu(const ParameterList& given, const std::vector<Block>& blocks) {
  const auto& first = blocks.front();
  const bool has_places = blocks.size() == 1 && !first.coordinates.is_null();
  auto list =
      multigrid_defaults(blocks.size() == 1 ? first.n_components : 1, first.map->getComm()->getSize(), has_places);
  if (first.advected) {
    list.set("smoother: type", "ILUT");  // Chebyshev polynomials grow if advection dominates
    // Aggregate sums of an M-matrix form an M-matrix. Coarse matrices with smoothed prolongators of a strong flow do
    // not, and cycles may diverge.
    list.set("multigrid algorithm", "unsmoothed");
  }
  if (first.advected || given.isParameter("smoother: type")) list.remove("smoother: params");
  list.setParameters(given);
  if (given.numParams() > 0)
    check(fmt::format("Sprekk > Solver > Blocks > {} > MueLu", first.name), given, list, first.map->getComm());
  return std::make_unique<MueLuMultigrid>(first.name, list, given.numParams() > 0);
}

}  // namespace sprekk::solve
