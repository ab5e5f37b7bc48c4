// Momentum balance of the rock: rows of the displacement.
#pragma once

#include "assembly/module.hpp"
#include "laws/elasticity.hpp"
#include "physics/mechanics/loads.hpp"
#include "physics/properties.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace sprekk::physics {

/// Traction on a boundary, Pa, in global components.
struct BoundaryTraction {
  int boundary;
  std::vector<base::Expression> value;
  int region = -1;  ///< only on faces of cells of this region; -1: all
};

struct BulkMomentumParameters {
  Properties<laws::Elasticity> elasticity = {};  ///< of cells
  BodyForce body_force = {};
  std::vector<BoundaryTraction> tractions = {};
  InitialStress initial_stress = {};
};

/// Declares the unknown "displacement" (nodes, m) and adds to its rows, with test function v,
///   integral (sigma_0 + sigma(u)) : grad v - F . v  -  boundary integral t . v                     Wollmann (2024),
///   (4), (5)
/// Outputs: displacement (nodes), stress of the nodal displacement, with sigma_0, at cell centres (XX, YY, ZZ, XY, YZ,
/// XZ; Pa).
std::unique_ptr<assembly::Module> make_bulk_momentum(mesh::Shape shape, BulkMomentumParameters parameters);

}  // namespace sprekk::physics
