// Which rank owns which cell.
#pragma once

#include <vector>

#include "mesh/mesh.hpp"

namespace sprekk::mesh {

/// The part [0, n_parts) of each cell, by METIS with a fixed seed. The graph has an edge between cells that share a
/// face and across every fracture face. With fewer cells than parts some parts are empty. Throws an Error if METIS
/// fails.
std::vector<int> partition(const GlobalMesh& mesh, int n_parts);

}  // namespace sprekk::mesh
