// Contact that begins or ends within a fracture face.
#pragma once

#include "base/expression.hpp"
#include "contact/grip.hpp"
#include "physics/mechanics/stress_recovery.hpp"

#include <vector>

namespace sprekk::physics {

/// What contact within a face depends on.
struct ContactAlongFaces {
  Properties<laws::Elasticity> elasticity;   ///< of local cells
  std::vector<const base::Expression*> gap;  ///< g0 of owned fracture faces, m; null where it is constant along a face
};

/// Faces are open or closed as a whole. Adds to bubbles, m, by how much closed ones should open along their normal
/// since they part somewhere, and to tractions, Pa, what should press on open ones since they touch somewhere [owned
/// unknown]; whether there are any. With the distance o(x) of the sides, of nodes and bubbles, and
///   C = h/(2 pi) sum of (1 - nu)/G over the sides, h^(d - 1) = |f|,
/// what rock gives in under a pressure that changes its sign within the face, a closed face parts where o > C
/// |lambda_n|, an open one touches where o < 0. Where it is undone over half of the face, the mean, which rock resists
/// half as much, moves by 2/3 of it: opening 4/3 mean(o - C |lambda_n|)_+, pressure 2/3 mean(-o)_+/C. Faces of cells
/// with a tip are left out. Collective.
bool add_edges_of_contact(const mesh::Mesh& mesh, const ByField<const fields::Layout*>& layouts,
                          const ByField<RCP<const fields::Vector>>& displacement, const ContactAlongFaces& along,
                          const std::vector<contact::Grip>& grips, fields::Vector& bubbles, fields::Vector& tractions);

}  // namespace sprekk::physics
