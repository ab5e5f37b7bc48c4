// Springs under a boundary (Winkler foundation).
#pragma once

#include "assembly/module.hpp"

#include <array>
#include <memory>

namespace sprekk::physics {

struct ElasticFoundationParameters {
  int boundary;                   ///< index in boundary_names of the mesh
  std::array<Real, 3> stiffness;  ///< k, Pa/m, per direction
  int region = -1;                ///< only at cells of this region; -1: all
};

/// Creates springs between a boundary and rigid ground with the traction -k_i u_i on the rock. Adds to the displacement
/// rows
///   boundary integral sum_i k_i u_i v_i.
std::unique_ptr<assembly::Module> make_elastic_foundation(const mesh::Mesh& mesh,
                                                          const ElasticFoundationParameters& parameters);

}  // namespace sprekk::physics
