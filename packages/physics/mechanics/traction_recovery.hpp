// What a traction that is constant per fracture face leaves out.
#pragma once

#include "fields/layout.hpp"
#include "mesh/mesh.hpp"
#include "physics/mechanics/loads.hpp"
#include "physics/mechanics/stress_recovery.hpp"

namespace sprekk::physics {

/// Adds to the forces on owned unknowns
///   - sum over faces of integral (t* - lambda) . [[v]]
/// for the functions v of nodes, side bubbles and tips, N. On a face t* = lambda + G (x - c), with c the
/// mean of x over the face and the gradient G fitted to the tractions of the face's closed neighbours in its fracture;
/// open faces have none. Where there is initial stress, t* is of the traction that exceeds it. `traction` is in the
/// faces' frames [owned unknown], Pa. Collective.
void add_unresolved_traction(const mesh::Mesh& mesh, const ByField<const fields::Layout*>& layouts,
                             const fields::Layout& traction_layout, const InitialStress& initial,
                             const fields::Vector& traction, const ByField<RCP<fields::Vector>>& forces);

/// Adds integral t . [[v]] over faces, N, for a traction t that is constant on each.
void add_opposite_tractions(const mesh::Mesh& mesh, const ByField<const fields::Layout*>& layouts,
                            const fields::Layout& traction_layout, const fields::Vector& traction,
                            const ByField<RCP<fields::Vector>>& forces);

}  // namespace sprekk::physics
