// Sparse matrices of dense blocks, one for each pair of nodes that couple.
#pragma once

#include <memory>

#include "fields/halo.hpp"
#include "fields/matrix.hpp"

namespace sprekk::multigrid {

using fields::CrsMatrix;
using fields::Halo;
using fields::Map;
using fields::Matrix;
using fields::MultiVector;
using fields::Vector;

/// Which nodes couple: row i has the columns column(start(i)) ... column(start(i + 1) - 1), local numbers of `columns`.
struct NodeGraph {
  std::shared_ptr<const Halo> columns;
  View<std::size_t*> start;
  View<LocalIndex*> column;

  LocalIndex n_rows() const { return static_cast<LocalIndex>(start.extent(0)) - 1; }
  std::size_t n_entries() const { return column.extent(0); }
};

/// Blocks [height, width] on a graph of nodes. Those of row i make `height` rows of numbers, one after another, from
/// value(height * width * start(i)) on: as Tpetra stores them where the unknowns of a node follow one another.
template <class Number>
struct NodeMatrixOf {
  int height = 0, width = 0;
  NodeGraph graph;
  View<Number*> value;
};
using NodeMatrix = NodeMatrixOf<Real>;
using ShortNodeMatrix = NodeMatrixOf<float>;  ///< in half of the bytes; products with it are in double precision

/// A matrix that is stored in blocks of this size, with its numbers; of another one, see below. Collective.
NodeMatrix node_matrix(const Matrix& A, int size);
/// A as blocks of size x size, in which the unknowns size * n ... size * n + size - 1 are those of node n. It shares
/// the values of A where A's rows and columns on this rank allow that. Throws where unknowns are numbered otherwise.
/// Collective.
NodeMatrix node_matrix(const CrsMatrix& A, int size);

/// A square matrix number by number, the unknowns of node n as above. Collective.
RCP<CrsMatrix> crs_matrix(const NodeMatrix& A);

/// y <- A x with x [all columns], whose ghosts it exchanges first; y [rows]. Collective.
template <class Number>
void product(const NodeMatrixOf<Number>& A, const View<Real*>& x, const View<Real*>& y);
/// y += A x. Collective.
template <class Number>
void add_product(const NodeMatrixOf<Number>& A, const View<Real*>& x, const View<Real*>& y);
/// r <- b - A x. Collective.
void residual(const NodeMatrix& A, const View<Real*>& x, const ConstView<Real*>& b, const View<Real*>& r);

}  // namespace sprekk::multigrid
