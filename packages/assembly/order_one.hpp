// The displacement of order 1 within that of order 2: the level that multigrid starts from.
#pragma once

#include "fields/layout.hpp"

namespace sprekk::assembly {

/// Values at all nodes from those at corners, for a field on nodes of a mesh of order 2: rows are the field's unknowns,
/// columns those of corners, numbered on their own. Each node takes the values where it is between the corners, so that
/// fields that are linear in space, rigid motions among them, are met; nodes at quarter points too. Collective.
RCP<const fields::CrsMatrix> interpolation_from_corners(const mesh::Mesh& mesh, const fields::Layout& layout);

/// Rows of a multivector [owned node, dim] that belong to corners. Collective.
RCP<const fields::MultiVector> at_corners(const mesh::Mesh& mesh, const fields::MultiVector& of_nodes);

}  // namespace sprekk::assembly
