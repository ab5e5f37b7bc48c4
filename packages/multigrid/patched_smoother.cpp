#include "multigrid/patched_smoother.hpp"

#include <Teuchos_LAPACK.hpp>

#include <algorithm>

#include "base/check.hpp"
#include "base/over_ranks.hpp"
#include "multigrid/chebyshev.hpp"

namespace sprekk::multigrid {
namespace {

ConstView<Real*> column_of(const MultiVector& x) {
  return Kokkos::subview(x.getLocalViewDevice(Tpetra::Access::ReadOnly), Kokkos::ALL(), 0);
}

/// Copies the owned values of x [all] to the result.
void give(const View<Real*>& x, MultiVector& result) {
  const auto to = Kokkos::subview(result.getLocalViewDevice(Tpetra::Access::OverwriteAll), Kokkos::ALL(), 0);
  Kokkos::deep_copy(to, Kokkos::subview(x, std::pair<std::size_t, std::size_t>(0, to.extent(0))));
}

/// Exact inverses of the diagonal blocks of a matrix on sets of rows, by dense LU factors.
class Patches {
 public:
  explicit Patches(RowSets sets) : sets_(std::move(sets)), factors_(sets_.size()), pivots_(sets_.size()) {}

  /// Factorises the blocks of A. Throws an Error if one is singular. Local.
  void update(const NodeMatrix& A);

  /// Solves A_pp dx = (b - A x)_p for each set p and adds dx to x; b [owned], x [all]. Collective.
  void correct(const NodeMatrix& A, const ConstView<Real*>& b, const View<Real*>& x) const;

  bool empty() const { return sets_.empty(); }
  std::size_t bytes() const;

 private:
  RowSets sets_;
  std::vector<std::vector<Real>> factors_;  // [set] column by column
  std::vector<std::vector<int>> pivots_;
  mutable std::vector<Real> residual_;
};

void Patches::update(const NodeMatrix& A) {
  std::vector<LocalIndex> place(A.graph.columns->n_all(), -1);  // [column] number in its set
  for (std::size_t p = 0; p < sets_.size(); ++p) {
    const auto& rows = sets_[p];
    const int n = static_cast<int>(rows.size());
    for (int i = 0; i < n; ++i) place[rows[i]] = i;
    auto& factors = factors_[p];
    factors.assign(static_cast<std::size_t>(n) * n, 0);
    for (int i = 0; i < n; ++i)
      for (std::size_t k = A.graph.start(rows[i]); k < A.graph.start(rows[i] + 1); ++k)
        if (const LocalIndex j = place[A.graph.column(k)]; j >= 0)
          factors[static_cast<std::size_t>(j) * n + i] = A.value(k);
    pivots_[p].resize(n);
    int info = 0;
    Teuchos::LAPACK<int, Real>().GETRF(n, n, factors.data(), n, pivots_[p].data(), &info);
    SPREKK_CHECK(info == 0, "the smoother of multigrid: the matrix of a patch of {} unknowns is singular", n);
    for (const LocalIndex row : rows) place[row] = -1;
  }
}

void Patches::correct(const NodeMatrix& A, const ConstView<Real*>& b, const View<Real*>& x) const {
  A.graph.columns->exchange(x, 1);
  residual_.clear();
  for (const auto& rows : sets_)
    for (const LocalIndex row : rows) {
      Real r = b(row);
      for (std::size_t k = A.graph.start(row); k < A.graph.start(row + 1); ++k) r -= A.value(k) * x(A.graph.column(k));
      residual_.push_back(r);
    }
  auto* of_set = residual_.data();
  for (std::size_t p = 0; p < sets_.size(); ++p) {
    const int n = static_cast<int>(sets_[p].size());
    int info = 0;
    Teuchos::LAPACK<int, Real>().GETRS('N', n, 1, factors_[p].data(), n, pivots_[p].data(), of_set, n, &info);
    for (int i = 0; i < n; ++i) x(sets_[p][i]) += of_set[i];
    of_set += n;
  }
}

std::size_t Patches::bytes() const {
  std::size_t sum = 0;
  for (const auto& factors : factors_) sum += factors.size() * sizeof(Real);
  return sum;
}

}  // namespace

struct PatchedSmoother::Parts {
  NodeMatrix A;
  Chebyshev chebyshev;
  Patches patches;
  bool has_patches;  // on any rank
  View<Real*> x, r;  // [all], [owned]

  Parts(const RCP<const Matrix>& matrix, RowSets sets)
      : A(node_matrix(*matrix, 1)),
        chebyshev(A),
        patches(std::move(sets)),
        has_patches(base::on_any_rank(*matrix->row_map()->getComm(), !patches.empty())),
        x("x", A.graph.columns->n_all()),
        r("r", A.graph.n_rows()) {}
};

PatchedSmoother::PatchedSmoother(const RCP<const Matrix>& A, RowSets sets)
    : parts_(std::make_unique<Parts>(A, std::move(sets))) {}

PatchedSmoother::~PatchedSmoother() = default;

void PatchedSmoother::update(const RCP<const Matrix>& A, int degree) {
  auto& [matrix, chebyshev, patches, has_patches, x, r] = *parts_;
  matrix.value = node_matrix(*A, 1).value;
  chebyshev.update(matrix, degree);
  base::collectively(*A->row_map()->getComm(), [&] { parts_->patches.update(parts_->A); });
}

void PatchedSmoother::widen() { parts_->chebyshev.widen(); }

double PatchedSmoother::bytes() const {
  return static_cast<double>(parts_->chebyshev.bytes() + parts_->patches.bytes());
}

void PatchedSmoother::before(const MultiVector& b, MultiVector& result) const {
  const auto& [A, chebyshev, patches, has_patches, x, r] = *parts_;
  const auto from = column_of(b);
  chebyshev.apply(from, x, false);
  if (has_patches) patches.correct(A, from, x);
  give(x, result);
}

void PatchedSmoother::after(const MultiVector& b, MultiVector& result) const {
  const auto& [A, chebyshev, patches, has_patches, x, r] = *parts_;
  const auto from = column_of(b), start = column_of(result);
  Kokkos::deep_copy(Kokkos::subview(x, std::pair<std::size_t, std::size_t>(0, start.extent(0))), start);
  if (has_patches) patches.correct(A, from, x);
  residual(A, x, from, r);
  chebyshev.apply(r, x, true);
  give(x, result);
}

}  // namespace sprekk::multigrid
