// Error due to the constant traction per fracture face.
#pragma once

#include "fields/layout.hpp"
#include "mesh/mesh.hpp"
#include "physics/mechanics/loads.hpp"
#include "physics/mechanics/stress_recovery.hpp"

namespace sprekk::physics {

/// Adds the forces
///   - sum over faces of integral (t* - lambda) . [[v]],
/// N, to owned unknowns, for the functions v of nodes, face bubbles and tips. On a face t* = lambda + G (x - c), with
/// the mean c of x over the face. The gradient G is fitted to the tractions of the closed neighbours of the face in its
/// fracture; it is zero on open faces. With initial stress, t* contains only the traction in excess of it. `traction`:
/// in the face frames [owned unknown], Pa. Collective.
void add_unresolved_traction(const mesh::Mesh& mesh, const ByField<const fields::Layout*>& layouts,
                             const fields::Layout& traction_layout, const InitialStress& initial,
                             const fields::Vector& traction, const ByField<RCP<fields::Vector>>& forces);

/// Adds integral t . [[v]] over faces, N, for a traction t that is constant on each face. Collective.
void add_opposite_tractions(const mesh::Mesh& mesh, const ByField<const fields::Layout*>& layouts,
                            const fields::Layout& traction_layout, const fields::Vector& traction,
                            const ByField<RCP<fields::Vector>>& forces);

}  // namespace sprekk::physics
