// Partition of the cells among the ranks.
#pragma once

#include <vector>

#include "mesh/mesh.hpp"

namespace sprekk::mesh {

/// Returns the part in [0, n_parts) of each cell, from METIS with fixed seeds. Graph edges connect cells with a common
/// face. Edges across fracture faces have a larger weight, so their cells tend to remain together. The partition
/// balances the number of cells and, with lower priority, the number of fracture faces, counted at their minus cells.
/// No part is empty, unless there are fewer cells than parts. Throws an Error if METIS fails. Not collective.
std::vector<int> partition(const GlobalMesh& mesh, int n_parts);

/// Evaluates a partition. `part` contains for each cell a number in [0, n_parts).
PartitionReport report(const GlobalMesh& mesh, const std::vector<int>& part, int n_parts);

}  // namespace sprekk::mesh
