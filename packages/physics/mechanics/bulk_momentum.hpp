// Momentum balance of the rock: rows of the displacement.
#pragma once

#include "assembly/module.hpp"
#include "fields/properties.hpp"
#include "laws/elasticity.hpp"
#include "physics/mechanics/loads.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace sprekk::physics {

/// Traction on a boundary, Pa: t - p n, with the outward normal n.
struct BoundaryTraction {
  int boundary;
  std::vector<base::Expression> value = {};       ///< t, in global components; empty: none
  std::optional<base::Expression> pressure = {};  ///< p
  int region = -1;                                ///< only faces of cells of this region; -1: all

  bool applies_to(const mesh::Mesh& mesh, const mesh::Mesh::BoundaryFace& face) const {
    return face.boundary == boundary && (region < 0 || mesh.cell_region[face.cell] == region);
  }
  bool constant_in_time() const;
  /// Returns a function at(i, x, t) with component i of the traction at points x of a face.
  auto on(const mesh::Mesh& mesh, const mesh::Mesh::BoundaryFace& face) const {
    auto n = mesh::area_vector(mesh::face_corners(mesh, face.cell, face.local_face));
    const Real area = mesh::norm(n);
    for (Real& component : n) component /= area;
    return [this, n](int i, const std::array<Real, 3>& x, Real t) {
      return (value.empty() ? 0 : value[i](x, t)) - (pressure ? (*pressure)(x, t) * n[i] : 0);
    };
  }
};

struct BulkMomentumParameters {
  fields::Properties<laws::Elasticity> elasticity = {};  ///< of cells
  BodyForce body_force = {};
  std::vector<BoundaryTraction> tractions = {};
  InitialStress initial_stress = {};
  bool keeps_stress = false;  ///< see make_bulk_momentum()
};

/// Creates the module that declares the unknown "displacement" (nodes, m). With the test function v its rows are,
/// Wollmann (2024), (4), (5),
///   integral (sigma_0 + sigma(u)) : grad v - F . v  -  boundary integral t . v.
/// With `keeps_stress` the stress of cells is continuous when a system takes over a state with other elastic constants,
/// or without these cells. Two history variables store the difference between this stress and that of the present
/// constants: "carried forces" [cell, node dim] on the nodes of a cell, N, and "carried stress" [cell, 6] at its
/// centre, Pa.
///
/// Outputs: displacement (nodes), and stress of the nodal displacement including sigma_0 at cell centres (XX, YY, ZZ,
/// XY, YZ, XZ; Pa).
std::unique_ptr<assembly::Module> make_bulk_momentum(mesh::Shape shape, BulkMomentumParameters parameters);

}  // namespace sprekk::physics
