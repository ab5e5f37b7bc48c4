#include "physics/mechanics/crossing.hpp"

#include "base/over_ranks.hpp"
#include "laws/crossing.hpp"
#include "laws/joint_start.hpp"
#include "mesh/ahead.hpp"
#include "physics/mechanics/mechanics.hpp"
#include "physics/mechanics/unbroken.hpp"
#include "physics/scene.hpp"

#include <cmath>

namespace sprekk::physics::front {

Real margin_of_crossing(const Setting& setting, const mesh::FrontPoint& front, const std::array<Real, 3>& K,
                        const Vector& ahead, const std::vector<Real>& traction,
                        const std::function<InCell(LocalIndex)>& in_cell) {
  const auto& [scene, mesh, start] = setting;
  const auto met = mesh::first_face_ahead(mesh, front.x, ahead, front.single);
  if (!met) return std::nan("");
  const auto of_tip = [&](const Vector& x, const Vector& n) {  // stress of the crack fields times n
    const auto fields = virtual_fields(front, front.at(x));
    return K[0] * times(fields[0].stress, n) + K[1] * times(fields[1].stress, n);
  };
  const Vector t = met->along, n{-t[1], t[0], 0};
  std::array<Real, 2> beyond{};  // strength, stress along the face
  base::collectively(*mesh.comm, [&] {
    if (met->cell < 0) return;
    const auto cell = in_cell(met->cell);
    beyond = {cell.strength, mesh::dot(t, times(cell.stress, t) + Real(-1) * of_tip(cell.x, t))};
  });
  beyond = base::sum_over_ranks(*mesh.comm, beyond);
  Real margin = 0;
  base::collectively(*mesh.comm, [&] {
    if (met->face < 0) return;
    const auto& face = mesh.fracture_faces[met->face];
    const Vector contact{traction[met->face * 2], traction[met->face * 2 + 1], 0},
        far = (mesh::dot(face.frame[0], n) > 0 ? 1 : -1) * contact + Real(-1) * of_tip(face.centre, n);
    const laws::Interface at{std::acos(mesh::dot(ahead, t)), mesh::dot(n, far), mesh::dot(t, far), beyond[1]};
    auto joint = joint_of(scene, mesh, met->single).joint(face.centre);
    joint.law.bond = bond_of(joint.law.bond, mesh, face, elasticity(scene, mesh));
    margin = laws::margin_of_crossing(at, beyond[0], [&](Real normal, Real shear) {
      const auto state = laws::start_of(joint, {normal, shear, 0}, 2);
      return normal > state.strength ? 0 : state.bound;
    });
  });
  return base::sum_over_ranks(*mesh.comm, margin);
}

}  // namespace sprekk::physics::front
