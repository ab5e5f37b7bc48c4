// What a traction that is constant per fracture face leaves out.
#pragma once

#include "fields/layout.hpp"
#include "mesh/mesh.hpp"
#include "physics/loads.hpp"

namespace sprekk::physics {

/// The blocks that a fracture's tractions push.
struct FractureLayouts {
  const fields::Layout &displacement, &bubble, &traction;
};

/// Adds to the forces on owned unknowns
///   - sum over faces of integral (t* - lambda) . [[v]]
/// for the shape functions v of displacement and side bubbles, N. On a face t* = lambda + G (x - centre), with the
/// gradient G fitted to the tractions of the face's neighbours in its fracture; open faces have none. Where there is
/// initial stress, t* is of the traction that exceeds it. `traction` is in the faces' frames [owned unknown], Pa.
/// Collective.
void add_unresolved_traction(const mesh::Mesh& mesh, const FractureLayouts& layouts, const InitialStress& initial,
                             const fields::Vector& traction, fields::Vector& displacement, fields::Vector& bubble);

}  // namespace sprekk::physics
