// Which rank owns which cell.
#pragma once

#include <vector>

#include "mesh/mesh.hpp"

namespace sprekk::mesh {

/// The part [0, n_parts) of each cell, by METIS with fixed seeds. The graph has an edge between cells that share a
/// face, and a heavier one across every fracture face, so that its two cells tend to stay together. Balanced are the
/// number of cells, which comes first, and as far as that permits the number of fracture faces, each counted at its
/// minus cell. No part is empty unless there are fewer cells than parts. Throws an Error if METIS fails.
std::vector<int> partition(const GlobalMesh& mesh, int n_parts);

/// How good a partition is. `part` is in [0, n_parts) for each cell.
PartitionReport report(const GlobalMesh& mesh, const std::vector<int>& part, int n_parts);

}  // namespace sprekk::mesh
