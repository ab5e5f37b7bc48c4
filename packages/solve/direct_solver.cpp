// MUMPS through its C interface.
#include <dmumps_c.h>
#include <mpi.h>

#include <Teuchos_CommHelpers.hpp>
#include <Tpetra_Details_extractMpiCommFromTeuchos.hpp>
#include <algorithm>
#include <cstdio>
#include <limits>
#include <map>
#include <numeric>

#include "base/check.hpp"
#include "solve/linear_solver.hpp"

namespace sprekk::solve {
namespace {

enum Job { initialise = -1, terminate = -2, analyse = 1, factorise = 2, substitute = 3 };

std::string message(const DMUMPS_STRUC_C& mumps) {
  const int code = mumps.infog[0], detail = mumps.infog[1];
  switch (code) {
    case -5:
    case -13:
      return fmt::format("MUMPS: out of memory (wanted {} more)", detail);
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

class DirectSolver : public LinearSolver {
 public:
  DirectSolver(const Teuchos::ParameterList& overrides, int most_ranks)
      : parameters_("MUMPS"), most_ranks_(most_ranks) {
    parameters_.set("ICNTL(7)", 7, "ordering: automatic");
    parameters_.set("ICNTL(14)", 40, "extra work space, percent");
    parameters_.setParameters(overrides);
    read_controls();
  }

  ~DirectSolver() override { release(); }
  DirectSolver(const DirectSolver&) = delete;
  DirectSolver& operator=(const DirectSolver&) = delete;

  bool reads_matrix() const override { return true; }

  std::string setup(const LinearSystem& system) override {
    if (!ready_ || (symmetric_ && !system.symmetric)) {  // not back again: an analysis costs more than symmetry saves
      release();
      start(system);
    }
    matrix_ = system.matrix;
    balances_ = std::any_of(system.diagonal.begin(), system.diagonal.end(),
                            [](const auto& part) { return part.block.balance; });
    failure_.clear();
    fill_values();
    if (!analysed_ && run(analyse) < 0) return failure_ = message(mumps_);
    analysed_ = true;
    int info = run(factorise);
    for (int enlarged = 0; (info == -8 || info == -9) && enlarged < 4; ++enlarged) {
      mumps_.icntl[13] *= 2;
      info = run(factorise);
    }
    return failure_ = info < 0 ? message(mumps_) : "";
  }

  LinearReport solve(const Vector& b, Vector& x, Real tolerance) override {
    LinearReport report;
    x.putScalar(0);
    if (!failure_.empty()) {
      report.reason = failure_;
      return report;
    }
    report.iterations = 1;
    if (tolerance >= 1) {  // no residual is asked for
      report.residual = std::numeric_limits<Real>::quiet_NaN();
      report.converged = substitute_rhs(b, x);
      if (!report.converged) report.reason = message(mumps_);
      return report;
    }
    Vector r(b, Teuchos::Copy), dx(x.getMap()), best(x, Teuchos::Copy);
    report.residual = 1;
    for (int refinement = 0; refinement <= 3 && report.residual > 1e-2 * tolerance; ++refinement) {
      if (!substitute_rhs(r, dx)) {
        report.reason = message(mumps_);
        return report;
      }
      x.update(1, dx, 1);
      const Real residual = relative_residual(*matrix_, b, x, r);
      if (refinement > 0 && !(residual < report.residual)) break;
      const bool slow = refinement > 0 && residual > 0.1 * report.residual;
      report.residual = residual;
      Tpetra::deep_copy(best, x);
      if (slow) break;
    }
    Tpetra::deep_copy(x, best);
    const Real acceptable = std::max(acceptable_linear_residual, noise(b, x));
    report.converged = report.residual <= acceptable;
    if (!report.converged)
      report.reason = fmt::format(
          "direct solve: relative residual {:.1e}, at most {:.0e} is acceptable: the matrix is "
          "singular or nearly so",
          report.residual, acceptable);
    return report;
  }

  const Teuchos::ParameterList& parameters() const override { return parameters_; }

 private:
  /// Relative residual that rounding leaves: each row is known to the rounding of its diagonal times the unknown, which
  /// may be large next to b, where bodies are all but free or balances of rates differ by many orders of magnitude.
  Real noise(const Vector& b, const Vector& x) const {
    Vector Dx(x.getMap());
    matrix_->getLocalDiagCopy(Dx);
    Dx.elementWiseMultiply(1, x, Dx, 0);
    return std::min(64 * std::numeric_limits<Real>::epsilon() * Dx.norm2() / b.norm2(),
                    balances_ ? most_noise_of_rates : most_noise);
  }

  int run(Job job) {
    mumps_.job = job;
    if (mpi_comm_ != MPI_COMM_NULL) dmumps_c(&mumps_);
    if (gathers_) Teuchos::broadcast(*comm_, 0, 2, mumps_.infog);
    return mumps_.infog[0];
  }

  MPI_Comm all_ranks() const { return Tpetra::Details::extractMpiCommFromTeuchos(*comm_); }

  /// All rows of the matrix on rank 0; their values are the places of the matrix' values once these are gathered.
  RCP<const CrsMatrix> places_on_root() {
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

  /// Starts MUMPS on its own communicator and tells it the graph.
  void start(const LinearSystem& system) {
    matrix_ = system.matrix;
    const bool symmetric = system.symmetric;
    const auto& map = *matrix_->getRowMap();
    const GlobalIndex n = map.getGlobalNumElements();
    SPREKK_CHECK(map.getMinAllGlobalIndex() == 0 && map.getMaxAllGlobalIndex() == n - 1 && n < 2147483647,
                 "direct solve: {} unknowns, numbered {} to {}; they must be numbered from 0 without gaps, below 2^31",
                 n, map.getMinAllGlobalIndex(), map.getMaxAllGlobalIndex());
    comm_ = map.getComm();
    const bool root = comm_->getRank() == 0;
    const auto root_map = rcp(new fields::Map(n, root ? n : 0, 0, comm_));
    to_root_ = rcp(new fields::Import(matrix_->getRowMap(), root_map));
    from_root_ = rcp(new fields::Import(root_map, matrix_->getRowMap()));
    at_root_ = rcp(new Vector(root_map));
    gathers_ = most_ranks_ < comm_->getSize();
    const auto factored = gathers_ ? places_on_root() : matrix_;
    MPI_Comm_split(all_ranks(), comm_->getRank() < most_ranks_ ? 0 : MPI_UNDEFINED, comm_->getRank(), &mpi_comm_);
    symmetric_ = symmetric;
    mumps_ = {};
    if (mpi_comm_ != MPI_COMM_NULL) mumps_.comm_fortran = MPI_Comm_c2f(mpi_comm_);
    mumps_.par = 1;
    mumps_.sym = symmetric ? 2 : 0;
    run(initialise);
    for (int quiet : {1, 2, 3, 4}) mumps_.icntl[quiet - 1] = quiet < 4 ? -1 : 0;
    mumps_.icntl[17] = 3;  // distributed matrix; with a centralised one the analysis would look at values
    for (const auto& [i, value] : icntl_) mumps_.icntl[i] = value;
    for (const auto& [i, value] : cntl_) mumps_.cntl[i] = value;

    const auto local = factored->getLocalMatrixHost();
    const auto& graph = local.graph;
    const auto &rows = *factored->getRowMap(), &columns = *factored->getColMap();
    const bool chosen = symmetric || gathers_;
    const std::size_t n_entries = graph.entries.extent(0);
    const std::size_t n_handed = symmetric ? (n_entries + graph.numRows()) / 2 : n_entries;  // if its graph is, too
    for (auto* indices : {&rows_, &columns_}) {
      indices->clear();
      indices->reserve(std::max<std::size_t>(1, n_handed));  // MUMPS wants a pointer also where nothing is
    }
    positions_ = std::vector<std::size_t>();  // with the memory that an earlier graph took
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

  void read_controls() {
    for (const auto& parameter : parameters_) {
      const std::string& name = parameter.first;
      const Teuchos::ParameterEntry& entry = parameter.second;
      int i = 0;
      if (std::sscanf(name.c_str(), "ICNTL(%d)", &i) == 1 && i >= 1 && i <= 60 && entry.isType<int>())
        icntl_[i - 1] = Teuchos::getValue<int>(entry);
      else if (std::sscanf(name.c_str(), "CNTL(%d)", &i) == 1 && i >= 1 && i <= 15 && entry.isType<double>())
        cntl_[i - 1] = Teuchos::getValue<double>(entry);
      else
        throw Error(fmt::format("MUMPS: parameter '{}'; allowed are ICNTL(1..60), int, and CNTL(1..15), double", name));
    }
  }

  void fill_values() {
    const auto values = matrix_->getLocalMatrixHost().values;
    const Real* from = values.data();
    if (gathers_) {
      MPI_Gatherv(from, static_cast<int>(values.extent(0)), MPI_DOUBLE, gathered_.data(), counts_.data(),
                  starts_.data(), MPI_DOUBLE, 0, all_ranks());
      from = gathered_.data();
    }
    for (std::size_t k = 0; k < positions_.size(); ++k) values_[k] = from[positions_[k]];
    const bool all = positions_.empty() && !rows_.empty();
    mumps_.a_loc = all ? const_cast<Real*>(from) : values_.data();  // MUMPS leaves them as they are
  }

  bool substitute_rhs(const Vector& b, Vector& x) {
    at_root_->doImport(b, *to_root_, Tpetra::INSERT);
    int info = 0;
    {
      const auto rhs = at_root_->getLocalViewHost(Tpetra::Access::ReadWrite);
      mumps_.rhs = rhs.data();
      info = run(substitute);
    }
    x.doImport(*at_root_, *from_root_, Tpetra::INSERT);
    return info >= 0;
  }

  void release() {
    if (!ready_) return;
    run(terminate);
    if (mpi_comm_ != MPI_COMM_NULL) MPI_Comm_free(&mpi_comm_);
    ready_ = false;
  }

  Teuchos::ParameterList parameters_;
  const int most_ranks_;  // that share the factors
  RCP<const Comm> comm_;
  std::map<int, int> icntl_;    // from 0
  std::map<int, double> cntl_;  // from 0
  DMUMPS_STRUC_C mumps_{};
  MPI_Comm mpi_comm_ = MPI_COMM_NULL;
  bool ready_ = false, analysed_ = false, symmetric_ = false, balances_ = false;
  bool gathers_ = false;  // rank 0 gets all of the matrix
  static constexpr Real most_noise = 1e-2, most_noise_of_rates = 0.5;
  std::string failure_ = "the matrix was not set up";
  RCP<const CrsMatrix> matrix_;
  std::vector<int> counts_, starts_;    // of the ranks' values
  std::vector<Real> gathered_;          // those of all ranks
  std::vector<int> rows_, columns_;     // 1-based
  std::vector<std::size_t> positions_;  // of the entries handed over, in the matrix' or all ranks' values; none: all
  std::vector<double> values_;          // of these
  RCP<fields::Import> to_root_, from_root_;
  RCP<Vector> at_root_;  // all of a vector on rank 0
};

}  // namespace

std::unique_ptr<LinearSolver> make_direct_solver(const Teuchos::ParameterList& mumps, int most_ranks) {
  return std::make_unique<DirectSolver>(mumps, most_ranks);
}

}  // namespace sprekk::solve
