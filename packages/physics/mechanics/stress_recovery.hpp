// A stress better than that of the displacement, recovered patch by patch, and the error that it reveals.
#pragma once

#include "fields/layout.hpp"
#include "laws/elasticity.hpp"
#include "physics/properties.hpp"
#include "mesh/mesh.hpp"

#include <array>
#include <memory>
#include <vector>

namespace sprekk::physics {

/// Norms are those of the energy, |s|^2 = integral s : C^-1 s, in sqrt(J) (2D: sqrt(J/m)).
/// The fields that displace the rock: the nodes, the side bubbles (make_interface_traction_balance()), the functions
/// around tips (make_tip_enrichment()). Null or absent where a problem has none; it has the first.
enum DisplacementField { nodal, bubble, tip };
template <class T>
using ByField = std::array<T, 3>;

struct StressError {
  std::vector<Real> energy;    ///< [owned cell] |s* - s_h|^2 of the cell, J
  std::vector<Real> density;   ///< the same / its volume, J/m^3
  Real error = 0, stress = 0;  ///< |s* - s_h| and |s*| of the whole mesh
  /// r(v) = integral (s* - s_h - s_b) : C^-1 (s(v)* - s(v)) for the functions v of each field, N [owned unknown]; s_b
  /// is the stress of the bubbles, which the problem takes to be stiffer than they are: that adds (alpha - B) beta in
  /// their rows. The discrete problem's answer to these forces estimates by how much displacements and jumps are too
  /// small.
  ByField<RCP<fields::Vector>> forces;
};

/// s* after Zienkiewicz and Zhu (1992): around every corner node a polynomial of the displacement's order is fitted to
/// the stress s_h + s_b at those points of the cells around it where it is most accurate; in a cell the polynomials of
/// its corners are added up, each times the linear shape function of its corner. Cells across a fracture or in another
/// region are not around a node; nodes on these borders count only where a cell has no others. Around an enriched tip
/// (mesh::Mesh::tip) the modes of a crack (TipModes) are fitted with linear terms; cells with such tips are around
/// these alone. s_h is the stress of nodes and tips, s_b that of the bubbles; both are without initial stress. s(v)* is
/// recovered in the same way, all v at once.
class StressRecovery {
 public:
  virtual ~StressRecovery() = default;

  /// For values [field][owned unknown]. Collective.
  virtual StressError operator()(const ByField<RCP<const fields::Vector>>& displacement) const = 0;
};

/// Refers to the layouts. Collective.
std::unique_ptr<StressRecovery> make_stress_recovery(RCP<const mesh::Mesh> mesh,
                                                     const ByField<const fields::Layout*>& layouts,
                                                     Properties<laws::Elasticity> elasticity);

}  // namespace sprekk::physics
