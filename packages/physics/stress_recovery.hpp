// A stress better than that of the displacement, recovered patch by patch, and the error that it reveals.
#pragma once

#include "fields/layout.hpp"
#include "laws/elasticity.hpp"
#include "mesh/mesh.hpp"

#include <memory>
#include <vector>

namespace sprekk::physics {

/// Norms are those of the energy, |s|^2 = integral s : C^-1 s, in sqrt(J) (2D: sqrt(J/m)).
struct StressError {
  std::vector<Real> density;   ///< [owned cell] |s* - s_h|^2 of the cell / its volume, J/m^3
  Real error = 0, stress = 0;  ///< |s* - s_h| and |s*| of the whole mesh
  /// [owned unknown of the displacement] r(v) = integral (s* - s_h) : C^-1 (s(v)* - s(v)) for its shape function v, N.
  /// The discrete problem's answer to these forces estimates by how much displacements and jumps are too small.
  RCP<fields::Vector> forces;
};

/// s* of Zienkiewicz and Zhu (1992): around every corner node a polynomial of the displacement's order is fitted to the
/// stress s_h at those points of the cells around it where it is most accurate; in a cell the polynomials of its
/// corners are added up, each times the linear shape function of its corner. Cells across a fracture or in another
/// region are not around a node, nor are cells with an enriched tip (mesh::Mesh::tip): their stress is taken as it is.
/// The fit also keeps its terms of highest order small, without which the error at crack tips is estimated too low. s_h
/// is the stress of the nodal displacement: without bubbles, without initial stress. s(v)* is recovered in the same
/// way, all v at once.
class StressRecovery {
 public:
  virtual ~StressRecovery() = default;

  /// For a displacement [owned unknown]. Collective.
  virtual StressError operator()(const fields::Vector& displacement) const = 0;
};

/// `elasticity_of_cell` as in BulkMomentumParameters. Refers to the layout. Collective.
std::unique_ptr<StressRecovery> make_stress_recovery(RCP<const mesh::Mesh> mesh, const fields::Layout& displacement,
                                                     std::vector<laws::Elasticity> elasticity,
                                                     std::vector<int> elasticity_of_cell);

}  // namespace sprekk::physics
