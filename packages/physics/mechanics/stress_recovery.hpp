// Recovery of a more accurate stress on patches, and the resulting error estimate.
#pragma once

#include "fields/layout.hpp"
#include "fields/properties.hpp"
#include "laws/elasticity.hpp"
#include "mesh/mesh.hpp"

#include <array>
#include <memory>
#include <vector>

namespace sprekk::physics {

/// Displacement fields: nodes, face bubbles (make_interface_traction_balance()) and tip functions
/// (make_tip_enrichment()). Values are null or absent if a problem lacks a field; `nodal` always exists. Energy norms:
/// |s|^2 = integral s : C^-1 s, in sqrt(J) (2D: sqrt(J/m)).
enum DisplacementField { nodal, bubble, tip };
template <class T>
using ByField = std::array<T, 3>;

struct StressError {
  std::vector<Real> energy;    ///< [owned cell] |s* - s_h|^2 of the cell, J
  std::vector<Real> density;   ///< energy divided by the volume of the cell, J/m^3
  Real error = 0, stress = 0;  ///< |s* - s_h| and |s*| of the whole mesh
  /// Forces r(v) = integral (s* - s_h - s_b) : C^-1 (s(v)* - s(v)) for the functions v of each field, N [owned
  /// unknown]. s_b is the stress of the bubbles. The rows of bubbles also contain (alpha - B) beta, their excess
  /// stiffness. The solution of the discrete problem with these forces estimates the error of displacements and jumps.
  ByField<RCP<fields::Vector>> forces;
};

/// Recovered stress s* (Zienkiewicz and Zhu 1992). s_h is the stress of nodes and tips, s_b that of the bubbles; both
/// exclude the initial stress.
///
/// - Around every corner node, a polynomial of the order of the displacement is fitted to s_h + s_b at the most
///   accurate points of the surrounding cells.
/// - In a cell, s* is the sum of the polynomials of its corners times their linear shape functions.
/// - Patches end at fractures and region borders. Nodes there count only in cells without other nodes.
/// - Around an enriched tip (mesh::Mesh::tip), crack modes (TipModes) are fitted together with linear terms. Cells with
///   such tips belong to the patches of tips only.
///
/// s(v)* is recovered in the same way, for all v at once.
class StressRecovery {
 public:
  virtual ~StressRecovery() = default;

  /// Error estimate of displacements [field][owned unknown]. Collective.
  virtual StressError operator()(const ByField<RCP<const fields::Vector>>& displacement) const = 0;
};

/// Creates the recovery. The result holds references to the layouts. Collective.
std::unique_ptr<StressRecovery> make_stress_recovery(RCP<const mesh::Mesh> mesh,
                                                     const ByField<const fields::Layout*>& layouts,
                                                     fields::Properties<laws::Elasticity> elasticity);

}  // namespace sprekk::physics
