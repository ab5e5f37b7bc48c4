// Node fields of order 1 as a subspace of order 2, for multigrid.
#pragma once

#include "fields/layout.hpp"

namespace sprekk::assembly {

/// Returns the interpolation from corners to all nodes, for a node field on a mesh of order 2. Rows are the unknowns of
/// the field, columns those of corners with their own numbers. The interpolation reproduces linear fields, including
/// rigid motions, also with quarter-point nodes. Collective.
RCP<const fields::CrsMatrix> interpolation_from_corners(const mesh::Mesh& mesh, const fields::Layout& layout);

/// Returns the rows of a multivector [owned node, dim] that belong to corners. Collective.
RCP<const fields::MultiVector> at_corners(const mesh::Mesh& mesh, const fields::MultiVector& of_nodes);

}  // namespace sprekk::assembly
