// Contact that begins or ends within a fracture face.
#pragma once

#include "base/expression.hpp"
#include "contact/constraint.hpp"
#include "physics/mechanics/stress_recovery.hpp"

#include <vector>

namespace sprekk::physics {

/// Data for contact within faces.
struct ContactAlongFaces {
  fields::Properties<laws::Elasticity> elasticity;  ///< of local cells
  std::vector<const base::Expression*> gap;         ///< g0 of owned fracture faces, m; null: constant on the face
};

/// Estimates the error due to one contact state per face. Adds to `bubbles`, m, the normal opening of closed faces that
/// partly open, and to `tractions`, Pa, the compression of open faces that partly close, [owned unknown]. Returns
/// whether there are any. Excludes faces of cells with a tip. Collective.
///
/// o(x) is the distance of the sides from nodes and bubbles. The compliance of the rock to a pressure that changes its
/// sign within the face is
///   C = h/(2 pi) sum of (1 - nu)/G over the sides, h^(d - 1) = |f|.
/// A closed face opens where o > C |lambda_n|; an open face closes where o < 0. The factors assume that this applies to
/// half of the face. The rock then resists half as much, and the mean changes by 2/3 of the excess:
///   opening 4/3 mean(o - C |lambda_n|)_+, pressure 2/3 mean(-o)_+/C.
bool add_edges_of_contact(const mesh::Mesh& mesh, const ByField<const fields::Layout*>& layouts,
                          const ByField<RCP<const fields::Vector>>& displacement, const ContactAlongFaces& along,
                          const std::vector<contact::Constraint>& constraints, fields::Vector& bubbles,
                          fields::Vector& tractions);

}  // namespace sprekk::physics
