// Elasticity with packages/multigrid only: conjugate gradients preconditioned by one cycle, on a cube of trilinear
// elements. The prescribed displacement of the sides is linear, so the discrete solution is this linear field.
#include "multigrid/multigrid.hpp"

#include <Tpetra_Core.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

using namespace sprekk;
using Point = std::array<int, 3>;

constexpr int n = 24;                                  // inner nodes along an edge; spacing 1
constexpr Real lambda = 1, mu = 1;                     // Lame's constants
constexpr Real S[] = {1, -1}, M[] = {2. / 6, 1. / 6};  // stiffness and mass of a linear 1D element

Point point(GlobalIndex node) { return {int(node % n), int(node / n % n), int(node / n / n)}; }
Real exact(const Point& p, int k) { return 0.1 * p[k] - 0.3 * p[(k + 1) % 3] + 0.2; }

/// Returns the integral of dN_a/dx_i dN_b/dx_j over an element, for its nodes a and b in {0, 1}^3.
Real integral(const Point& a, const Point& b, int i, int j) {
  Real product = 1;
  for (int k = 0; k < 3; ++k)
    product *= k == i && k == j ? S[a[k] != b[k]] : k == i ? a[k] - 0.5 : k == j ? b[k] - 0.5 : M[a[k] != b[k]];
  return product;
}

/// Adds the rows of a node from its eight elements. Prescribed displacements contribute to b.
void add_rows(GlobalIndex node, fields::CrsMatrix& A, fields::Vector& b) {
  const Point p = point(node);
  for (int k = 0; k < 64; ++k) {
    const Point own = {k & 1, k >> 1 & 1, k >> 2 & 1}, other = {k >> 3 & 1, k >> 4 & 1, k >> 5};
    const Point q = {p[0] + other[0] - own[0], p[1] + other[1] - own[1], p[2] + other[2] - own[2]};
    const bool prescribed = std::any_of(q.begin(), q.end(), [](int i) { return i < 0 || i >= n; });
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        Real value = lambda * integral(own, other, i, j) + mu * integral(own, other, j, i);
        for (int m = 0; m < 3 && i == j; ++m) value += mu * integral(own, other, m, m);
        const GlobalIndex row = 3 * node + i, column = 3 * (q[0] + n * (q[1] + GlobalIndex(n) * q[2])) + j;
        if (prescribed)
          b.sumIntoGlobalValue(row, -value * exact(q, j));
        else
          A.insertGlobalValues(row, 1, &value, &column);
      }
  }
}

/// Computes x = A^-1 b by conjugate gradients to a relative residual of 1e-10. Returns the number of iterations.
int solve(const fields::Operator& A, const fields::Operator& M, const fields::Vector& b, fields::Vector& x) {
  fields::Vector r(b, Teuchos::Copy), z(b.getMap()), p(b.getMap()), Ap(b.getMap());
  Real rz = 0;
  int iterations = 0;
  for (; r.norm2() > 1e-10 * b.norm2() && iterations < 100; ++iterations) {
    M.apply(r, z);
    const Real before = std::exchange(rz, r.dot(z));
    p.update(1, z, iterations > 0 ? rz / before : 0);
    A.apply(p, Ap);
    x.update(rz / p.dot(Ap), p, 1);
    r.update(-rz / p.dot(Ap), Ap, 1);
  }
  return iterations;
}

int main(int argc, char** argv) {
  const Tpetra::ScopeGuard guard(&argc, &argv);
  const auto comm = Tpetra::getDefaultComm();
  const fields::Map nodes(n * n * n, 0, comm);
  const auto map = rcp(new fields::Map(3 * n * n * n, 3 * base::n_local_elements(nodes), 0, comm));
  const auto A = rcp(new fields::CrsMatrix(map, 192));
  const auto rigid_motions = rcp(new fields::MultiVector(map, 6));
  fields::Vector b(map), x(map);
  for (const GlobalIndex node : base::local_elements(nodes)) {
    add_rows(node, *A, b);
    for (int k = 0; k < 3; ++k) {
      rigid_motions->replaceGlobalValue(3 * node + k, k, 1);
      rigid_motions->replaceGlobalValue(3 * node + k, 3 + (k + 1) % 3, -point(node)[(k + 2) % 3]);
      rigid_motions->replaceGlobalValue(3 * node + k, 3 + (k + 2) % 3, point(node)[(k + 1) % 3]);
    }
  }
  A->fillComplete();

  const auto matrix = fields::wrapped(A);
  multigrid::Multigrid cycle(matrix, *matrix, 3, rigid_motions);  // graphs of all levels
  cycle.setup(matrix, true);                                      // values
  const int iterations = solve(*matrix, cycle, b, x);

  for (const GlobalIndex node : base::local_elements(nodes))
    for (int k = 0; k < 3; ++k) x.sumIntoGlobalValue(3 * node + k, -exact(point(node), k));
  const Real error = x.normInf() / exact({n, 0, 0}, 0);
  if (comm->getRank() == 0)
    std::printf("%d unknowns: %d iterations, relative error %.1e\n", 3 * n * n * n, iterations, error);
  return iterations <= 10 && error < 1e-8 ? 0 : 1;  // 9 iterations; without rigid motions 11
}
