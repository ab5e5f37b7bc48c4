// Bonded parts of fractures, which open by their bond law.
#pragma once

#include "laws/elasticity.hpp"
#include "laws/joint_parameters.hpp"
#include "physics/physics.hpp"

#include <string>
#include <vector>

namespace sprekk::physics {

/// Returns whether a fracture face is bonded at the start: the entry "unbroken" of its fracture is above 0 at its
/// centre.
bool is_unbroken(const Scene& scene, const mesh::Mesh& mesh, const mesh::Mesh::FractureFace& face);

/// Changes the joint of a face in a fracture with the entry "unbroken". Bonded faces have no jump before they open:
/// rigid closure and shear, no gap and no aperture. Other faces have no bond.
void set_bond(laws::JointParameters& joint, bool unbroken);

/// Returns the bond on an owned face, with the smaller E' of its sides, see laws::on_face().
laws::Bond bond_of(const laws::Bond& bond, const mesh::Mesh& mesh, const mesh::Mesh::FractureFace& face,
                   const fields::Properties<laws::Elasticity>& rock);

/// Reports unbroken parts that are not available with other entries.
void compare_unbroken(Comparison& comparison);

/// Warns about an incompressible fluid in a fracture with bonded faces in impermeable rock; empty: none.
std::string notch_doubt(const Scene& scene);

/// Warns about bonded faces longer than a third of the process zone. Only faces up to 1.1 times the shortest bonded
/// face of their fracture count. Collective.
std::vector<std::string> process_zone_warnings(const Setting& setting);

}  // namespace sprekk::physics
