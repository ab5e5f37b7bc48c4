// Which cells move together.
#pragma once

#include <vector>

#include "mesh/mesh.hpp"

namespace sprekk::mesh {

/// Sets of cells that are connected through common faces, and no others. Cells that share but an edge or a corner, or
/// nodes tied by periodicity, are not connected by these.
struct Bodies {
  std::vector<int> of_cell;          ///< [cell] number of its body
  std::vector<GlobalIndex> n_cells;  ///< [body], in the order of their lowest cells

  int n() const { return static_cast<int>(n_cells.size()); }
};

/// The bodies of a split mesh, joined across fractures too: what contact can hold together. Throws an Error if more
/// than two cells share a face. Not collective.
Bodies find_bodies(const GlobalMesh& mesh);

/// The pieces of rock that fractures separate from each other. Throws like find_bodies(). Not collective.
Bodies find_pieces(const GlobalMesh& mesh);

}  // namespace sprekk::mesh
