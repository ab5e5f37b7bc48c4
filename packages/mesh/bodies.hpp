// Sets of connected cells.
#pragma once

#include <vector>

#include "mesh/mesh.hpp"

namespace sprekk::mesh {

/// Sets of cells connected through common faces. A common edge or corner, or nodes tied by periodicity, do not connect
/// cells.
struct Bodies {
  std::vector<int> of_cell;          ///< [cell] number of its body
  std::vector<GlobalIndex> n_cells;  ///< [body], ordered by the lowest cell

  int n() const { return static_cast<int>(n_cells.size()); }
};

/// Returns the bodies of a split mesh, connected also across fractures, so a body can be held together by contact.
/// Throws an Error if more than two cells share a face. Not collective.
Bodies find_bodies(const GlobalMesh& mesh);

/// Returns the pieces of rock separated by fractures. Throws like find_bodies(). Not collective.
Bodies find_pieces(const GlobalMesh& mesh);

}  // namespace sprekk::mesh
