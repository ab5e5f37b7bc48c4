// Momentum balance of the rock: rows of the displacement.
#pragma once

#include "assembly/module.hpp"
#include "base/expression.hpp"
#include "laws/elasticity.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace sprekk::physics {

/// Force per volume, N/m^3, in global components; shared by all rows that test momentum. Empty: none.
using BodyForce = std::vector<base::Expression>;

/// Traction on a boundary, Pa, in global components.
struct BoundaryTraction {
  int boundary;
  std::vector<base::Expression> value;
};

struct BulkMomentumParameters {
  std::vector<laws::Elasticity> elasticity;  ///< [region]
  BodyForce body_force;
  std::vector<BoundaryTraction> tractions;
};

/// Declares the unknown "displacement" (nodes, m) and adds to its rows, with test function v,
///   integral sigma(u) : grad v - F . v  -  boundary integral t . v                                 Wollmann (2024), (4), (5)
/// Outputs: displacement (nodes), stress of the nodal displacement at cell centres (XX, YY, ZZ, XY, YZ, XZ; Pa).
std::unique_ptr<assembly::Module> make_bulk_momentum(mesh::Shape shape, BulkMomentumParameters parameters);

}  // namespace sprekk::physics
