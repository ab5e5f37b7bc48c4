#include "multigrid/multigrid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.hpp"
#include "base/over_ranks.hpp"
#include "multigrid/block_sizes.hpp"
#include "multigrid/coarse_graphs.hpp"

namespace sprekk::multigrid {
namespace {

using Policy = Kokkos::RangePolicy<Execution>;

constexpr Real max_growth = 5;  // largest growth of the residual in a cycle
constexpr int max_widenings = 4;
constexpr int max_degree = 200, max_finest_degree = 24;

/// Largest ratio of coarse to fine nodes. Above it, coarsening ends: nodes are isolated, or there is one per rank.
constexpr Real min_coarsening = 0.8;

/// Smallest average number of nodes per rank; below it, a level moves to fewer ranks.
constexpr int min_nodes = 30;

/// Returns the minimum number of nodes per aggregate on the finest level. In 3D a coarse node has six unknowns. Small
/// aggregates, as in tetrahedra, would make the coarser levels half as expensive as the finest, in memory and time. In
/// hexahedra, rows have 27 nodes inside the rock, and larger aggregates would only reduce the convergence rate. In
/// small parts, where most nodes have neighbours on other ranks, the choice may differ. Collective.
std::size_t enough_for(const Nodes& nodes, const Comm& comm) {
  constexpr int modes_in_space = 6;
  constexpr std::size_t long_row = 27, enough = 36;
  constexpr GlobalIndex share = 20;
  if (nodes.n_modes != modes_in_space) return 0;
  const auto& start = nodes.neighbours.start;
  std::array<GlobalIndex, 2> here{};
  for (std::size_t i = 0; i < nodes.free.size(); ++i) {
    here[0] += start[i + 1] - start[i] + 1 >= long_row;
    here[1] += nodes.free[i];
  }
  const auto all = base::sum_over_ranks(comm, here);
  return share * all[0] < all[1] ? enough : 0;
}

/// Returns the degree of the smoother. Differences of both sides that alternate along long edges of fractures do no
/// work on contact. Its stiffness is similar to that of the short edges of flat cells. The diagonal is therefore too
/// large for them, by up to the square of the aspect ratio. Coarse nodes represent them while cells are coarsened
/// across short edges. On the level where this ends, only the smoother reduces them.
int degree_for(Real flatness, int degree) {
  return std::max(degree, static_cast<int>(std::lround(std::min<Real>(2 * flatness, max_degree))));
}

GlobalIndex n_nodes(const NodeMatrix& A) { return A.graph.columns->owned()->getGlobalNumElements(); }

void raise_diagonal(CrsMatrix& matrix, Real raise) {
  const auto local = matrix.getLocalMatrixHost();
  const auto rows = matrix.getRowMap()->getLocalMap(), columns = matrix.getColMap()->getLocalMap();
  for (LocalIndex row = 0, n = local.numRows(); row < n; ++row)
    for (auto k = local.graph.row_map(row); k < local.graph.row_map(row + 1); ++k)
      if (columns.getGlobalElement(local.graph.entries(k)) == rows.getGlobalElement(row)) local.values(k) *= 1 + raise;
}

}  // namespace

bool Multigrid::can_solve(int n_components, int n_modes) {
  const auto nothing = [](auto, auto) {};
  return try_sizes(n_components, n_components, nothing) && try_sizes(n_components, n_modes, nothing) &&
         try_sizes(n_modes, n_modes, nothing);
}

Multigrid::Multigrid(const RCP<const Matrix>& matrix, Nodes nodes, int n_components,
                     const RCP<const MultiVector>& modes, const Options& options)
    : map_(matrix->row_map()), finest_(matrix), size_(n_components), options_(options) {
  add_level(node_matrix(*matrix, size_), nullptr);
  shares_ = base::on_all_ranks(*map_->getComm(), levels_.front().A.value.data() == matrix->numbers().value.data());
  levels_.front().degree = std::max(options.degree, options_.finest_degree);
  Real strong = options.strong;
  while (n_nodes(levels_.back().A) * levels_.back().A.height > options.direct_limit(levels_.size() - 1)) {
    const auto& A = levels_.back().A;
    if (!modes.is_null())
      levels_.back().degree = degree_for(leave_out_far_contact(A.graph, nodes), levels_.back().degree);
    const auto aggregates = aggregate(nodes, levels_.size() == 1 ? enough_for(nodes, *map_->getComm()) : 0);
    Nodes coarse;
    const auto tentative = tentative_prolongator(nodes, aggregates, coarse);
    auto galerkin = std::make_unique<Galerkin>(A, nodes, aggregates, tentative);
    if (n_nodes(galerkin->coarse()) > min_coarsening * n_nodes(A)) break;
    coarsen_beyond(A.graph, nodes, galerkin->aggregate(), *galerkin->coarse().graph.columns->all(), coarse);
    auto moved = on_fewer_ranks(*galerkin, coarse);
    levels_.back().smoother = std::make_unique<Chebyshev>(A);
    if (modes.is_null()) {  // the matrix of the next level determines its weak couplings
      levels_.back().smoother->update(A);
      galerkin->update(A, levels_.back().smoother->damped_inverse_diagonal(), true);
      if (moved) moved->update(galerkin->coarse());
      strong /= 2;
      nodes = nodes_of(moved ? moved->matrix() : galerkin->coarse(), modes, Teuchos::null, strong);
      nodes.motion = std::move(coarse.motion);
      nodes.place = std::move(coarse.place);
      nodes.nearest = std::move(coarse.nearest);
    } else {
      nodes = std::move(coarse);
    }
    const auto next = moved ? moved->matrix() : galerkin->coarse();
    levels_.back().to_coarse = std::move(galerkin);
    add_level(next, std::move(moved));
  }
  for (const auto& level : levels_)
    levels_.front().degree = std::max(levels_.front().degree, std::min(level.degree, max_finest_degree));
  std::array<double, 2> here{static_cast<double>(levels_.front().A.value.extent(0)), 0};
  for (const auto& level : levels_) here[1] += level.A.value.extent(0);
  const auto all = base::sum_over_ranks(*map_->getComm(), here);
  operator_complexity_ = all[1] / all[0];
}

/// Returns the coarse level on fewer ranks if ranks have small matrices or few nodes, which limits aggregates; else
/// null. Collective.
std::unique_ptr<FewerRanks> Multigrid::on_fewer_ranks(const Galerkin& galerkin, Nodes& nodes) const {
  const auto& coarse = galerkin.coarse();
  const auto numbers = base::sum_over_ranks(*map_->getComm(), static_cast<double>(coarse.value.extent(0)));
  const bool is_last = n_nodes(coarse) * coarse.height <= options_.direct_limit(levels_.size());
  const double n_ranks = n_ranks_of(coarse.graph), maximum = std::min(numbers / options_.minimum_per_rank,
                                                                      static_cast<double>(n_nodes(coarse)) / min_nodes);
  const double wanted = is_last ? 1 : maximum / 2;
  if (n_ranks <= 1 || 2 * wanted > n_ranks) return nullptr;
  return std::make_unique<FewerRanks>(coarse, galerkin.prolongation(), nodes,
                                      std::max(1, static_cast<int>(std::lround(wanted))));
}

void Multigrid::add_level(const NodeMatrix& A, std::unique_ptr<FewerRanks> moved) {
  const auto vector = [&](LocalIndex n) { return View<Real*>("level", static_cast<std::size_t>(n) * A.height); };
  const LocalIndex n = A.graph.columns->n_all(), n_above = moved ? moved->prolongation().graph.columns->n_all() : n,
                   n_given = moved ? moved->gathered().columns->n_all() : A.graph.n_rows();
  n_ranks_.push_back(n_ranks_of(A.graph));
  levels_.push_back({A,
                     {},
                     std::move(moved),
                     {},
                     vector(levels_.empty() ? 0 : n_given),
                     vector(std::max(n, n_above)),
                     vector(n),
                     options_.degree});
}

/// Returns the prolongator from the next level.
const ShortNodeMatrix& Multigrid::prolongation(std::size_t level) const {
  const auto& moved = levels_[level + 1].moved;
  return moved ? moved->prolongation() : levels_[level].to_coarse->prolongation();
}

void Multigrid::setup(const RCP<const Matrix>& matrix, bool symmetric, bool careful) {
  if (matrix != finest_ || !shares_) {
    const auto values = node_matrix(*matrix, size_).value;
    base::collectively(*map_->getComm(), [&] {
      SPREKK_CHECK(values.extent(0) == levels_.front().A.value.extent(0),
                   "multigrid: the graph of the matrix has changed");
    });
    levels_.front().A.value = values;
  }
  finest_ = matrix;
  const NodeMatrix* above = nullptr;
  for (auto& level : levels_) {
    if (level.moved) level.moved->update(*above);
    if (!level.to_coarse) continue;
    const int minimum = &level == &levels_.front() ? options_.finest_degree : 0;
    level.smoother->update(level.A, symmetric ? level.degree : std::max(options_.degree, minimum));
    level.to_coarse->update(level.A, level.smoother->damped_inverse_diagonal(), symmetric);
    above = &level.to_coarse->coarse();
  }
  base::collectively(*map_->getComm(), [&] { factor_last(symmetric); });
  for (int widenings = 0; careful && !symmetric && !(growth() <= max_growth) && widenings < max_widenings; ++widenings)
    for (auto& level : levels_)
      if (level.smoother) level.smoother->widen();
}

void Multigrid::factor_last(bool symmetric) {
  const auto& A = levels_.back().A;
  const bool on_one = n_ranks_.back() == 1;
  if (n_nodes(A) == 0 || (on_one && A.graph.n_rows() == 0)) return;  // no coupled nodes: smoothing only
  const auto last = crs_matrix(on_one ? alone(A) : A);
  raise_diagonal(*last, options_.raise);
  if (last_.is_null()) {
    last_matrix_ = last;
    last_ = rcp(new DirectInverse(last_matrix_, "the coarsest level of multigrid"));
  } else {
    Kokkos::deep_copy(last_matrix_->getLocalMatrixDevice().values, last->getLocalMatrixDevice().values);
  }
  last_->setup(symmetric);
}

/// Returns |b - A M b| / |b| for a vector b that does not depend on the number of ranks. It is large if eigenvalues of
/// a nonsymmetric matrix are so far from the real axis that the smoother amplifies their components. Collective.
Real Multigrid::growth() const {
  Vector b(map_), Mb(map_), r(map_);
  for (std::size_t i = 0; i < b.getLocalLength(); ++i)
    b.replaceLocalValue(i, std::cos(static_cast<Real>(map_->getGlobalElement(i))));
  apply(b, Mb, Teuchos::NO_TRANS, 1, 0);
  finest_->apply(Mb, r);
  r.update(1, b, -1);
  return r.norm2() / b.norm2();
}

void Multigrid::apply(const MultiVector& b, MultiVector& y, Teuchos::ETransp, Real alpha, Real beta) const {
  const auto given = b.getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto result = y.getLocalViewDevice(Tpetra::Access::ReadWrite);
  const auto to = levels_.front().x;
  const Policy rows(0, given.extent(0));
  for (std::size_t v = 0; v < b.getNumVectors(); ++v) {
    cycle(0, Kokkos::subview(given, Kokkos::ALL(), v));
    Kokkos::parallel_for(
        "give", rows, KOKKOS_LAMBDA(LocalIndex i) {
          result(i, v) = beta == 0 ? alpha * to(i) : alpha * to(i) + beta * result(i, v);
        });
  }
}

void Multigrid::cycle(std::size_t level, const ConstView<Real*>& b) const {
  const auto& [A, smoother, moved, to_coarse, _, x, r, degree] = levels_[level];
  if (moved) moved->gathered().columns->exchange(levels_[level].b, A.height);
  if (!to_coarse) return solve_last(b);
  smoother->apply(b, x, false);
  residual(A, x, b, r);
  product(to_coarse->restriction(), r, levels_[level + 1].b);
  cycle(level + 1, levels_[level + 1].b);
  add_product(prolongation(level), levels_[level + 1].x, x);
  residual(A, x, b, r);
  smoother->apply(r, x, true);
}

void Multigrid::solve_last(const ConstView<Real*>& from) const {
  if (last_.is_null()) return;
  const auto to = levels_.back().x;
  MultiVector b(last_->getDomainMap(), 1), x(last_->getRangeMap(), 1);
  const Policy rows(0, b.getLocalLength());
  {
    const auto values = b.getLocalViewDevice(Tpetra::Access::OverwriteAll);
    Kokkos::parallel_for(
        "take", rows, KOKKOS_LAMBDA(LocalIndex i) { values(i, 0) = from(i); });
  }
  try {
    last_->apply(b, x, Teuchos::NO_TRANS, 1, 0);
  } catch (const Error&) {
    if (n_ranks_.back() > 1) throw;                       // thrown on all of them
    x.putScalar(std::numeric_limits<Real>::quiet_NaN());  // only this rank knows; NaN reaches the others through norms
  }
  const auto values = x.getLocalViewDevice(Tpetra::Access::ReadOnly);
  Kokkos::parallel_for(
      "give", rows, KOKKOS_LAMBDA(LocalIndex i) { to(i) = values(i, 0); });
}

double Multigrid::bytes() const {
  double sum = 0;
  for (const auto& level : levels_) {
    if (level.smoother) sum += level.smoother->bytes();
    if (level.to_coarse) sum += level.to_coarse->bytes();
    if (level.moved) sum += level.moved->bytes();
  }
  return sum;
}

/// Returns the messages of each level: exchanges for two residuals, products of the smoother, restriction, prolongation
/// from the next level, and transfer to fewer ranks.
Multigrid::Traffic Multigrid::traffic() const {
  Traffic all;
  const auto add = [&](int times, const NodeGraph& graph, int width) {
    const auto& halo = *graph.columns;
    all.messages += times * static_cast<double>(halo.n_messages());
    all.bytes += times * width * sizeof(Real) * static_cast<double>(halo.n_all() - halo.n_owned());
  };
  for (std::size_t k = 0; k < levels_.size(); ++k) {
    const auto& level = levels_[k];
    if (level.moved) add(1, level.moved->gathered(), level.A.height);
    if (!level.to_coarse) continue;
    add(2 * level.smoother->degree() + 1, level.A.graph, level.A.width);
    add(1, prolongation(k).graph, prolongation(k).width);
  }
  return all;
}

std::vector<GlobalIndex> Multigrid::n_unknowns() const {
  std::vector<GlobalIndex> n;
  for (const auto& level : levels_) n.push_back(n_nodes(level.A) * level.A.height);
  return n;
}

/// Returns the bytes of each level: the matrix twice for residuals, its rounded copy, prolongator and restriction.
double Multigrid::cycle_bytes() const {
  double sum = 0;
  for (const auto& level : levels_) {
    if (!level.to_coarse) continue;
    const auto matrix = [](const auto& A, std::size_t number) {
      return static_cast<double>(A.value.extent(0) * number + A.graph.n_entries() * sizeof(LocalIndex));
    };
    sum += 2 * matrix(level.A, sizeof(Real)) +
           2 * (level.smoother->degree() - 1) * matrix(level.A, sizeof(RoundedMatrix::Number));
    sum +=
        matrix(level.to_coarse->prolongation(), sizeof(float)) + matrix(level.to_coarse->restriction(), sizeof(float));
  }
  return sum;
}

}  // namespace sprekk::multigrid
