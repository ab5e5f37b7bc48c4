// Sparse matrices of dense blocks, one for each coupled pair of nodes.
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

/// Graph of coupled nodes: row i has the columns column(start(i)) ... column(start(i + 1) - 1), local numbers in
/// `columns`.
struct NodeGraph {
  std::shared_ptr<const Halo> columns;
  View<std::size_t*> start;
  View<LocalIndex*> column;

  LocalIndex n_rows() const { return static_cast<LocalIndex>(start.extent(0)) - 1; }
  std::size_t n_entries() const { return column.extent(0); }
};

/// Blocks [height, width] on a graph of nodes. The blocks of row i form `height` adjacent rows of values, beginning at
/// value(height * width * start(i)). Tpetra stores values in the same order if the unknowns of a node are adjacent.
template <class Number>
struct NodeMatrixOf {
  int height = 0, width = 0;
  NodeGraph graph;
  View<Number*> value;
};
using NodeMatrix = NodeMatrixOf<Real>;
using ShortNodeMatrix = NodeMatrixOf<float>;  ///< half of the bytes; products are computed in double precision

/// Returns A as a node matrix. If A has blocks of this size, the values are shared; else see below. Collective.
NodeMatrix node_matrix(const Matrix& A, int size);
/// Returns A with blocks size x size. The unknowns size * n ... size * n + size - 1 belong to node n. The values are
/// shared if the local rows and columns of A permit it. Throws an Error for another numbering. Collective.
NodeMatrix node_matrix(const CrsMatrix& A, int size);

/// Returns a square matrix with single entries, with the unknowns of node n as above. Collective.
RCP<CrsMatrix> crs_matrix(const NodeMatrix& A);

/// Computes y = A x, x [all columns], y [rows]. Exchanges the ghosts of x first. Collective.
template <class Number>
void product(const NodeMatrixOf<Number>& A, const View<Real*>& x, const View<Real*>& y);
/// Computes y += A x. Exchanges the ghosts of x first. Collective.
template <class Number>
void add_product(const NodeMatrixOf<Number>& A, const View<Real*>& x, const View<Real*>& y);
/// Computes r = b - A x. Exchanges the ghosts of x first. Collective.
void residual(const NodeMatrix& A, const View<Real*>& x, const ConstView<Real*>& b, const View<Real*>& r);

}  // namespace sprekk::multigrid
