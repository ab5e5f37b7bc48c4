// Where wells are connected to the rock and to fractures.
#pragma once

#include "mesh/facets.hpp"
#include "physics/flow/wells.hpp"

#include <string>
#include <vector>

namespace sprekk::physics {

/// Where fluid flows between a well and the rock or a fracture.
struct WellConnection {
  int well, fracture;  ///< -1: rock
  LocalIndex row;      ///< cell, or facet
  Real index;          ///< W, m^3/(Pa s); of a face over its transmissivity, -
  mesh::Vector x;      ///< the centre of the cell or the face, where its pressure is
  LocalIndex face;     ///< -1: rock
};

/// Those of this rank, and what is wrong with a well, empty: nothing; the same on every rank but for radii. The indices
/// W are as make_wells() has them. Collective.
struct WellConnections {
  std::vector<WellConnection> all;
  std::string failure;
};
WellConnections find_well_connections(const mesh::Mesh& mesh, const WellsParameters& parameters);

}  // namespace sprekk::physics
