#include "solve/updated_factors.hpp"

#include <Teuchos_LAPACK.hpp>
#include <algorithm>

#include "base/over_ranks.hpp"

namespace sprekk::solve {
namespace {

constexpr Real min_residual = 1e-9, max_residual = 1e-4;  // required relative residual
constexpr Real max_numbers = 1e9;                         // of G and of I - Q G on all ranks
constexpr int max_refinements = 3, max_failures = 3;
constexpr int columns_together = 32;  // of G in a substitution

}  // namespace

void UpdatedFactors::restart(const LinearSolver& solver) {
  solver_ = &solver;
  n_factorisations_ = active_ ? 1 : n_factorisations_ + 1;
  active_ = false;
  change_.set_reference();
}

void UpdatedFactors::give_up() {
  active_ = false;
  n_factorisations_ = 0;
  ++n_failures_;
  G_ = {};
}

bool UpdatedFactors::follow() {
  const bool unexpected = base::on_any_rank(*comm_, change_.mark_changes());
  if (active_ && unexpected) {
    active_ = false;
    n_factorisations_ = 0;
  }
  if (!active_ && pays()) compute_responses();
  if (active_ && !factor()) give_up();
  return active_;
}

/// Returns whether the factorisations so far cost more than G and its use. Solves cost about twice the time of a
/// factorisation with as many operations, the columns of G, which are substituted together, a quarter of a solve.
bool UpdatedFactors::pays() const {
  if (solver_ == nullptr || n_failures_ >= max_failures) return false;
  const auto work = solver_->work();
  const Real n = base::sum_over_ranks(*comm_, change_.n_marked()), ranks = comm_->getSize();
  const Real dense = ranks * (2 * n * n * n / 3 + 40 * n * n);  // on every rank
  const Real numbers = n * (ranks * n + change_.map()->getGlobalNumElements());
  if (numbers > std::min(work.solve / 2, max_numbers)) return false;  // more memory than the factors
  return n > 0 && n_factorisations_ * (work.setup - 2 * work.solve - dense) > n * work.solve / 2;
}

void UpdatedFactors::compute_responses() {
  change_.choose();
  const int n = change_.n_chosen();
  import_ = rcp(new fields::Import(J_->row_map(), change_.map()));
  const std::size_t n_rows = base::n_local_elements(*change_.map());
  G_.assign(n_rows * n, 0);
  std::vector<Real> s(change_.n_here());
  for (int j = 0; j < n; j += columns_together) {
    const int n_columns = std::min(columns_together, n - j);
    fields::MultiVector U(J_->row_map(), n_columns), columns(J_->row_map(), n_columns),
        needed(change_.map(), n_columns);
    for (int k = 0; k < n_columns; ++k) {
      const int here = j + k - change_.first();
      const bool owned = here >= 0 && here < change_.n_here();
      if (owned) s[here] = 1;
      change_.expand(s, *U.getVectorNonConst(k));
      if (owned) s[here] = 0;
    }
    solver_->preconditioner()->apply(U, columns);
    needed.doImport(columns, *import_, Tpetra::INSERT);
    const auto values = needed.getLocalViewHost(Tpetra::Access::ReadOnly);
    for (std::size_t i = 0; i < n_rows; ++i)
      for (int k = 0; k < n_columns; ++k) G_[i * n + j + k] = values(i, k);
  }
  active_ = true;
}

/// Factorises the transpose of I - Q G, which has the rows of I - Q G as its columns. Returns false if it is singular.
bool UpdatedFactors::factor() {
  change_.update();
  const int n = change_.n_chosen(), n_here = change_.n_here();
  std::vector<Real> rows(static_cast<std::size_t>(n) * n_here);
  change_.add_product(G_, rows);
  for (auto& value : rows) value = -value;
  for (int i = 0; i < n_here; ++i) rows[static_cast<std::size_t>(i) * n + change_.first() + i] += 1;
  lu_ = comm_->getSize() == 1 ? std::move(rows) : base::gather_over_ranks(*comm_, std::move(rows));
  pivot_.resize(n);
  int info = 0;
  Teuchos::LAPACK<int, Real>().GETRF(n, n, lu_.data(), n, pivot_.data(), &info);
  return base::on_all_ranks(*comm_, info == 0);
}

/// Returns s = (I - Q G)^-1 Q y on this rank, [chosen row here], for Q y [chosen row here].
std::vector<Real> UpdatedFactors::solve_rows(std::vector<Real> Qy) const {
  auto s = base::gather_over_ranks(*comm_, std::move(Qy));
  const int n = change_.n_chosen();
  int info = 0;
  Teuchos::LAPACK<int, Real>().GETRS('T', n, 1, lu_.data(), n, pivot_.data(), s.data(), n, &info);
  return {s.begin() + change_.first(), s.begin() + change_.first() + change_.n_here()};
}

/// Computes x = J^-1 b: x = y + J_0^-1 U s with y = J_0^-1 b.
void UpdatedFactors::apply_inverse(const Vector& b, Vector& x) const {
  const auto inverse = solver_->preconditioner();
  inverse->apply(b, x);
  Vector needed(change_.map());
  needed.doImport(x, *import_, Tpetra::INSERT);
  const auto s = solve_rows(change_.product(needed.getLocalViewHost(Tpetra::Access::ReadOnly).data()));
  Vector U(b.getMap()), more(b.getMap());
  change_.expand(s, U);
  inverse->apply(U, more);
  x.update(1, more, 1);
}

/// Computes x = J_0^-1 U (s - c) if b = -U c except for `accuracy` |b|, as after the first of Newton's iterations,
/// which solves all linear rows. G then replaces the first solve with J_0. Otherwise returns false.
bool UpdatedFactors::apply_to_rows(const Vector& b, Vector& x, Real accuracy) const {
  auto c = change_.coefficients();
  Vector U(b.getMap());
  change_.expand(c, U);
  U.update(1, b, 1);
  if (!(U.norm2() <= accuracy * b.norm2())) return false;
  const auto all = base::gather_over_ranks(*comm_, c);
  std::vector<Real> y(base::n_local_elements(*change_.map()), 0);
  for (std::size_t i = 0; i < y.size(); ++i)
    for (std::size_t j = 0; j < all.size(); ++j) y[i] -= G_[i * all.size() + j] * all[j];
  const auto s = solve_rows(change_.product(y.data()));
  for (std::size_t k = 0; k < c.size(); ++k) c[k] = s[k] - c[k];
  change_.expand(c, U);
  solver_->preconditioner()->apply(U, x);
  return true;
}

LinearReport UpdatedFactors::solve(const Vector& b, Vector& x, Real accuracy) {
  const Real enough = std::clamp(accuracy, min_residual, max_residual);
  LinearReport report;
  Vector r(b, Teuchos::Copy), dx(x.getMap());
  x.putScalar(0);
  report.residual = 1;
  for (int k = 0; k <= max_refinements && !(report.residual <= enough); report.iterations = ++k) {
    if (k > 0 || !apply_to_rows(b, dx, enough / 2)) apply_inverse(r, dx);
    x.update(1, dx, 1);
    report.residual = relative_residual(*J_, b, x, r);
  }
  report.converged = report.residual <= enough;
  return report;
}

}  // namespace sprekk::solve
