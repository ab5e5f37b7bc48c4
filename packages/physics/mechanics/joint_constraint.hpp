// Contact constraint of a fracture face.
#pragma once

#include "contact/constraint.hpp"
#include "laws/contact.hpp"
#include "laws/joint_fwd.hpp"
#include "laws/joint_points.hpp"

#include <array>

namespace sprekk::physics {

/// Adds the constraint of a face. Closed faces keep their gap. Sticking faces, and faces with a `given` slip, resist in
/// all directions, sliding faces normal to their slip. `frame`: (n, t1[, t2]).
template <int dim>
void add_constraint(const laws::Joint& law, const std::array<mesh::Vector, 3>& frame,
                    const laws::JointPoint<dim>& point, const laws::History& history, bool given,
                    contact::Constraint& to);

}  // namespace sprekk::physics
