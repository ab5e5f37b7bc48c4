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
  bool along_normal = false;      ///< k_0 n n^T with the normal n of a face in place of the diagonal matrix of k
};

/// Creates springs between a boundary and rigid ground with the traction -K u on the rock. K is the diagonal matrix of
/// k, or k_0 n n^T. Adds to the displacement rows
///   boundary integral v . K u.
std::unique_ptr<assembly::Module> make_elastic_foundation(const mesh::Mesh& mesh,
                                                          const ElasticFoundationParameters& parameters);

}  // namespace sprekk::physics
