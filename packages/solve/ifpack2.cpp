// Preconditioners of Ifpack2, for one block or several joined blocks.
#include <Ifpack2_AdditiveSchwarz.hpp>
#include <Ifpack2_Factory.hpp>

#include <algorithm>
#include <array>

#include "base/check.hpp"
#include "solve/preconditioner.hpp"

namespace sprekk::solve {
namespace {

using fields::Map;
using fields::Operator;
using Teuchos::ParameterList;
using RowMatrix = Tpetra::RowMatrix<Real, LocalIndex, GlobalIndex>;
using Ifpack2Preconditioner = Ifpack2::Preconditioner<Real, LocalIndex, GlobalIndex>;

bool has_zero_on_diagonal(const CrsMatrix& matrix) {
  Vector diagonal(matrix.getRowMap());
  matrix.getLocalDiagCopy(diagonal);
  const auto d = diagonal.getLocalViewHost(Tpetra::Access::ReadOnly);
  for (std::size_t i = 0; i < d.extent(0); ++i)
    if (d(i, 0) == 0) return true;
  return false;
}

/// Returns the method of Ifpack2 with this name and these parameters.
RCP<Ifpack2Preconditioner> create(const std::string& method, const ParameterList& parameters,
                                  const RCP<const RowMatrix>& matrix) {
  const auto made = Ifpack2::Factory::create<RowMatrix>(method, matrix);
  ParameterList list(parameters);
  made->setParameters(list);
  return made;
}

RCP<CrsMatrix> matrix_of_one(const RCP<const Comm>& comm) {
  const auto map = rcp(new Map(1, 0, comm));
  const auto one = rcp(new CrsMatrix(map, 1));
  for (const GlobalIndex row : base::local_elements(*map))
    one->insertGlobalValues(row, 1, std::array{1.0}.data(), &row);
  one->fillComplete();
  return one;
}

/// Checks the parameters of the method SCHWARZ and of the method in its subdomains, for which Ifpack2 has four names.
void check_schwarz(const std::string& place, const ParameterList& given, ParameterList allowed,
                   const RCP<const Comm>& comm) {
  std::string method = "ILUT";  // default
  for (const std::string inner :
       {"inner preconditioner", "subdomain solver", "schwarz: inner preconditioner", "schwarz: subdomain solver"}) {
    allowed.set(inner + " name", "");
    allowed.sublist(inner + " parameters");
    if (given.isType<std::string>(inner + " name")) method = given.get<std::string>(inner + " name");
  }
  check_names(place, given, {allowed});
  for (const auto& item : given)
    if (item.second.isList() && item.first != "schwarz: reordering list")
      check_ifpack2(place + " > " + item.first, method, given.sublist(item.first), comm);
}

class Ifpack2Method : public Preconditioner {
 public:
  Ifpack2Method(const std::string& type, const std::string& block, const std::string& method,
                const ParameterList& parameters)
      : Preconditioner(type, block), type_(type), method_(method), parameters_(parameters) {}

  std::string given_list() const override { return type_ == "Ifpack2" ? type_ : ""; }
  bool is_symmetric() const override { return type_ == "Gauss-Seidel"; }  // unknown for others
  void describe(ParameterList& blocks) const override {
    auto& list = blocks.sublist(block());
    list.set("type", type_);
    if (type_ == "Ifpack2") list.sublist("Ifpack2").set("type", method_).setParameters(parameters_);
  }

 private:
  void prepare(const LinearSystem& system, SolverCost&) override {
    matrix_.update(system);
    const auto matrix = with_schur(system);
    SPREKK_CHECK(type_ != "Gauss-Seidel" || !has_zero_on_diagonal(*matrix),
                 "its matrix has zeros on the diagonal; solve directly, or eliminate the block locally");
    if (made_.is_null()) {
      made_ = create(method_, parameters_, matrix);
      made_->initialize();
    }
    made_->compute();
  }
  RCP<const Operator> made() const override { return made_; }

  /// Returns the matrix, for a single block with the Schur complements of other blocks added.
  RCP<const CrsMatrix> with_schur(const LinearSystem& system) {
    const auto& schur = system.diagonal.front().schur;
    if (schur.is_null() || system.diagonal.size() > 1) return matrix_.crs();
    if (sum_.is_null()) sum_ = rcp(new CrsMatrix(matrix_.crs()->getCrsGraph()));
    sum_->resumeFill();
    Kokkos::deep_copy(sum_->getLocalMatrixDevice().values, matrix_.crs()->getLocalMatrixDevice().values);
    add_to_diagonal(*sum_, *schur);
    sum_->fillComplete(matrix_.crs()->getDomainMap(), matrix_.crs()->getRangeMap());
    return sum_;
  }

  RCP<CrsMatrix> sum_;  // null: matrix of the system
  std::string type_, method_;
  ParameterList parameters_;
  WholeMatrix matrix_;
  RCP<Ifpack2Preconditioner> made_;
};

}  // namespace

void check_ifpack2(const std::string& place, const std::string& method, const ParameterList& given,
                   const RCP<const Comm>& comm, const std::vector<std::string>& known) {
  ParameterList list(given);
  list.setName(place);  // Ifpack2 uses it in messages
  RCP<Ifpack2Preconditioner> made;
  try {
    made = Ifpack2::Factory::create<RowMatrix>(method, matrix_of_one(comm));
    made->setParameters(list);
  } catch (const std::exception& error) {
    throw RefusedList(fmt::format("{}: {}", place, gist(error.what())));
  }
  if (const auto* schwarz = dynamic_cast<const Ifpack2::AdditiveSchwarz<RowMatrix>*>(
          made.get()))  // copies its list, which hides the use of entries
    return check_schwarz(place, given, *schwarz->getValidParameters(), comm);
  for (const auto& item : given)
    if (!list.getEntry(item.first).isUsed() && std::find(known.begin(), known.end(), item.first) == known.end())
      throw RefusedList(
          fmt::format("{} > \"{}\": {} does not read this parameter; see the manual of Ifpack2 for its parameters",
                      place, item.first, method));
}

std::unique_ptr<Preconditioner> make_ifpack2(const ParameterList& given, const std::vector<Block>& blocks) {
  ParameterList parameters(given);
  const auto method = parameters.get<std::string>("type");
  parameters.remove("type");
  check_ifpack2(fmt::format("Sprekk > Solver > Blocks > {} > Ifpack2", blocks.front().name), method, parameters,
                blocks.front().map->getComm());
  return std::make_unique<Ifpack2Method>("Ifpack2", blocks.front().name, method, parameters);
}

std::unique_ptr<Preconditioner> make_gauss_seidel(const std::vector<Block>& blocks) {
  ParameterList list;
  list.set("relaxation: type", "Symmetric Gauss-Seidel");
  list.set("relaxation: sweeps", 2);
  return std::make_unique<Ifpack2Method>("Gauss-Seidel", blocks.front().name, "RELAXATION", list);
}

}  // namespace sprekk::solve
