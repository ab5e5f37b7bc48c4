#include "multigrid/mumps.hpp"

#include <mpi.h>

#include <Teuchos_CommHelpers.hpp>
#include <Tpetra_Details_extractMpiCommFromTeuchos.hpp>

#include <algorithm>
#include <cstdio>
#include <numeric>

#include "base/check.hpp"
#include "base/value.hpp"

namespace sprekk::multigrid {
namespace {

enum Job : int { initialise = -1, terminate = -2, analyse = 1, factorise = 2, substitute = 3 };

std::string message(const DMUMPS_STRUC_C& mumps) {
  const int code = mumps.infog[0], detail = mumps.infog[1];
  switch (code) {
    case -5:
    case -13:
      return fmt::format("MUMPS: out of memory ({} more required)", detail);
    case -6:
      return fmt::format("MUMPS: the matrix is structurally singular (rank {})", detail);
    case -8:
    case -9:
      return "MUMPS: the work space is too small even after enlarging it; raise ICNTL(14)";
    case -10:
      return fmt::format("MUMPS: the matrix is singular (after {} pivots)", detail);
    default:
      return fmt::format("MUMPS: error {} ({}), see its manual", code, detail);
  }
}

}  // namespace

Mumps::Mumps(const Teuchos::ParameterList& overrides, int max_ranks) : parameters_("MUMPS"), max_ranks_(max_ranks) {
  parameters_.set("ICNTL(7)", 7, "ordering: automatic");
  parameters_.set("ICNTL(14)", 40, "extra work space, percent");
  parameters_.setParameters(overrides);
  read_controls();
}

Mumps::~Mumps() { release(); }

std::string Mumps::factor(const RCP<const CrsMatrix>& A, bool symmetric) {
  matrix_ = A;
  if (!ready_ || (symmetric_ && !symmetric)) {  // no return to symmetric: an analysis costs more than symmetry saves
    release();
    start(symmetric);
  }
  failure_.clear();
  fill_values();
  if (!analysed_ && run(analyse) < 0) return failure_ = message(mumps_);
  analysed_ = true;
  int info = run(factorise);
  for (int enlarged = 0; (info == -8 || info == -9) && enlarged < 4; ++enlarged) {
    mumps_.icntl[13] *= 2;
    info = run(factorise);
  }
  count_operations();
  return failure_ = info < 0 ? message(mumps_) : "";
}

void Mumps::count_operations() {
  const int entries = mumps_.infog[8];  // if negative, in millions
  size_[0] = mumps_.rinfog[2];
  size_[1] = entries < 0 ? -1e6 * entries : Real(entries);
  Teuchos::broadcast(*comm_, 0, 2, size_);
}

std::string Mumps::substitute(const MultiVector& b, MultiVector& x) {
  if (!failure_.empty()) return failure_;
  if (at_root_->getNumVectors() != b.getNumVectors())
    at_root_ = rcp(new MultiVector(at_root_->getMap(), b.getNumVectors()));
  at_root_->doImport(b, *to_root_, Tpetra::INSERT);
  int info = 0;
  {
    const auto rhs = at_root_->getLocalViewHost(Tpetra::Access::ReadWrite);
    mumps_.rhs = rhs.data();
    mumps_.nrhs = static_cast<int>(rhs.extent(1));
    mumps_.lrhs = static_cast<int>(std::max<std::size_t>(1, rhs.stride(1)));
    info = run(Job::substitute);
  }
  x.doImport(*at_root_, *from_root_, Tpetra::INSERT);
  return info < 0 ? message(mumps_) : "";
}

int Mumps::run(int job) {
  mumps_.job = job;
  if (mpi_comm_ != MPI_COMM_NULL) dmumps_c(&mumps_);
  if (gathers_) Teuchos::broadcast(*comm_, 0, 2, mumps_.infog);
  return mumps_.infog[0];
}

MPI_Comm Mumps::all_ranks() const { return Tpetra::Details::extractMpiCommFromTeuchos(*comm_); }

/// Returns the rows of the matrix on rank 0. Its values are the positions of the gathered values. Collective.
RCP<const CrsMatrix> Mumps::places_on_root() {
  const auto places = rcp(new CrsMatrix(*matrix_, Teuchos::Copy));
  const auto values = places->getLocalMatrixHost().values;
  const int n_here = static_cast<int>(values.extent(0)), n_ranks = comm_->getSize();
  counts_.resize(n_ranks);
  starts_.assign(n_ranks + 1, 0);
  Teuchos::gatherAll(*comm_, 1, &n_here, n_ranks, counts_.data());
  std::partial_sum(counts_.begin(), counts_.end(), starts_.begin() + 1);
  gathered_.resize(comm_->getRank() == 0 ? starts_.back() : 0);
  std::iota(values.data(), values.data() + n_here, static_cast<Real>(starts_[comm_->getRank()]));
  return Tpetra::importAndFillCompleteCrsMatrix<CrsMatrix>(RCP<const CrsMatrix>(places), *to_root_);
}

/// Starts MUMPS on its own communicator and passes the graph. Collective.
void Mumps::start(bool symmetric) {
  const auto& map = *matrix_->getRowMap();
  const GlobalIndex n = map.getGlobalNumElements();
  SPREKK_CHECK(map.getMinAllGlobalIndex() == 0 && map.getMaxAllGlobalIndex() == n - 1 && n < 2147483647,
               "direct solve: {} unknowns, numbered {} to {}; they must be numbered from 0 without gaps, below 2^31", n,
               map.getMinAllGlobalIndex(), map.getMaxAllGlobalIndex());
  comm_ = map.getComm();
  const bool root = comm_->getRank() == 0;
  const auto root_map = rcp(new fields::Map(n, root ? n : 0, 0, comm_));
  to_root_ = rcp(new fields::Import(matrix_->getRowMap(), root_map));
  from_root_ = rcp(new fields::Import(root_map, matrix_->getRowMap()));
  at_root_ = rcp(new MultiVector(root_map, 1));
  gathers_ = max_ranks_ < comm_->getSize();
  const auto factored = gathers_ ? places_on_root() : matrix_;
  MPI_Comm_split(all_ranks(), comm_->getRank() < max_ranks_ ? 0 : MPI_UNDEFINED, comm_->getRank(), &mpi_comm_);
  symmetric_ = symmetric;
  mumps_ = {};
  if (mpi_comm_ != MPI_COMM_NULL) mumps_.comm_fortran = MPI_Comm_c2f(mpi_comm_);
  mumps_.par = 1;
  mumps_.sym = symmetric ? 2 : 0;
  run(initialise);
  for (int quiet : {1, 2, 3, 4}) mumps_.icntl[quiet - 1] = quiet < 4 ? -1 : 0;
  mumps_.icntl[17] = 3;  // distributed matrix: with a centralised one, the analysis would depend on values
  for (const auto& [i, value] : icntl_) mumps_.icntl[i] = value;
  for (const auto& [i, value] : cntl_) mumps_.cntl[i] = value;

  const auto local = factored->getLocalMatrixHost();
  const auto& graph = local.graph;
  const auto &rows = *factored->getRowMap(), &columns = *factored->getColMap();
  const bool chosen = symmetric || gathers_;
  const std::size_t n_entries = graph.entries.extent(0);
  const std::size_t n_handed =
      symmetric ? (n_entries + graph.numRows()) / 2 : n_entries;  // if the graph is symmetric, too
  for (auto* indices : {&rows_, &columns_}) {
    indices->clear();
    indices->reserve(std::max<std::size_t>(1, n_handed));  // MUMPS requires a pointer even without entries
  }
  positions_ = std::vector<std::size_t>();  // releases the memory of an earlier graph
  values_ = std::vector<double>();
  positions_.reserve(chosen ? n_handed : 0);
  for (LocalIndex row = 0, n_rows = graph.numRows(); row < n_rows; ++row)
    for (auto k = graph.row_map(row); k < graph.row_map(row + 1); ++k) {
      const GlobalIndex i = rows.getGlobalElement(row), j = columns.getGlobalElement(graph.entries(k));
      if (symmetric && j > i) continue;
      rows_.push_back(i + 1);
      columns_.push_back(j + 1);
      if (chosen) positions_.push_back(gathers_ ? static_cast<std::size_t>(local.values(k)) : k);
    }
  values_.resize(std::max<std::size_t>(1, positions_.size()));
  mumps_.n = n;
  mumps_.nnz_loc = rows_.size();
  mumps_.irn_loc = rows_.data();
  mumps_.jcn_loc = columns_.data();
  ready_ = true;
  analysed_ = false;
}

void Mumps::read_controls() {
  for (const auto& parameter : parameters_) {
    const std::string& name = parameter.first;
    const Teuchos::ParameterEntry& entry = parameter.second;
    int i = 0;
    if (std::sscanf(name.c_str(), "ICNTL(%d)", &i) == 1 && i >= 1 && i <= 60 && entry.isType<int>())
      icntl_[i - 1] = Teuchos::getValue<int>(entry);
    else if (std::sscanf(name.c_str(), "CNTL(%d)", &i) == 1 && i >= 1 && i <= 15 && entry.isType<double>())
      cntl_[i - 1] = Teuchos::getValue<double>(entry);
    else
      throw Error(
          fmt::format("Sprekk > Solver > Linear solver > MUMPS > \"{}\": is {}; there are ICNTL(1) to ICNTL(60), "
                      "integers, and CNTL(1) to CNTL(15), numbers with a point or an exponent",
                      name, base::describe(entry)));
  }
}

void Mumps::fill_values() {
  const auto values = matrix_->getLocalMatrixHost().values;
  const Real* from = values.data();
  if (gathers_) {
    MPI_Gatherv(from, static_cast<int>(values.extent(0)), MPI_DOUBLE, gathered_.data(), counts_.data(), starts_.data(),
                MPI_DOUBLE, 0, all_ranks());
    from = gathered_.data();
  }
  for (std::size_t k = 0; k < positions_.size(); ++k) values_[k] = from[positions_[k]];
  const bool all = positions_.empty() && !rows_.empty();
  mumps_.a_loc = all ? const_cast<Real*>(from) : values_.data();  // MUMPS does not change them
}

void Mumps::release() {
  if (!ready_) return;
  run(terminate);
  if (mpi_comm_ != MPI_COMM_NULL) MPI_Comm_free(&mpi_comm_);
  ready_ = false;
}

}  // namespace sprekk::multigrid
