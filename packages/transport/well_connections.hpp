// Connections of wells with rock and fractures.
#pragma once

#include "mesh/facets.hpp"
#include "transport/wells.hpp"

#include <string>
#include <vector>

namespace sprekk::transport {

/// Connection of a well with a cell or a fracture face.
struct WellConnection {
  int well, fracture;  ///< -1: rock
  LocalIndex row;      ///< cell, or facet
  Real index;          ///< W, m^3/(Pa s); for faces W divided by the transmissivity, -
  mesh::Vector x;      ///< centre of the cell or face, where its pressure is defined
  LocalIndex face;     ///< -1: rock
};

/// Connections of this rank, and the error message of an invalid well (empty: none). Messages are the same on every
/// rank, except those about radii. The indices W are defined at make_wells().
struct WellConnections {
  std::vector<WellConnection> all;
  std::string failure;
};
/// Finds the connections. Collective.
WellConnections find_well_connections(const mesh::Mesh& mesh, const WellsParameters& parameters);

/// Well in 2D at a distance of less than half a fracture face from a fracture, but not on a fracture.
struct WellNearFracture {
  int well, single;  ///< single: the nearest fracture
  Real distance;     ///< m
};
std::vector<WellNearFracture> wells_near_fractures(const mesh::Mesh& mesh, const std::vector<Well>& wells);

}  // namespace sprekk::transport
