// Blocks with a horizontal fracture under uniform stress: their scenes, and what is expected of the joint.
#pragma once

#include "verification/scenes.hpp"

namespace sprekk::tests {

/// "Tables.TABLE.values={...}", an override of a scene.
inline std::string values(const std::string& table, const std::vector<Real>& v) {
  return fmt::format("Tables.{}.values={{{:.17g}}}", table, fmt::join(v, ", "));
}

/// Sides of a block that let the stress be uniform: loaded with its traction, as the scene has it, or tied to each
/// other.
enum class Sides { loaded, tied };

/// Replaces the tractions on the sides of a block by periodicity.
inline void tie_sides(model::Scene& scene) {
  scene.mesh.periodic = {"x", "y"};
  scene.mesh.periodic.resize(scene.mesh.lower_corner.size() - 1);
  auto& conditions = scene.boundary_conditions;
  for (auto c = conditions.begin(); c != conditions.end();)
    c = c->second.traction.empty() ? std::next(c) : conditions.erase(c);
}

/// Solvers stop at 1e-11, relative to the loads, which are of order one here.
constexpr Real tolerance = 1e-11;

/// A joint with traction l_t m + l_n n, plastic jump u_p m, opening, closure B(l_n) and tangential stiffness K_t.
struct UniformJoint {
  Real l_t, l_n, u_p, opening, closure, K_t;

  Expected along(const Vector3& m, int dim) const {
    Expected e;
    e.n = dim == 2 ? Vector3{0, 1, 0} : Vector3{0, 0, 1};
    for (int i = 0; i < 3; ++i) {
      e.traction[i] = l_t * m[i] + l_n * e.n[i];
      e.elastic[i] = l_t / K_t * m[i] + closure * e.n[i];
      e.plastic[i] = u_p * m[i] + (opening - closure) * e.n[i];
    }
    e.tolerance = e.traction_tolerance = tests::tolerance;
    return e;
  }
};

}  // namespace sprekk::tests
