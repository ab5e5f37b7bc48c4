// Blocks with a horizontal fracture under uniform stress: scenes and expected states of the joint.
#pragma once

#include "verification/scenes.hpp"

namespace sprekk::tests {

/// Returns the override "Tables.TABLE.values={...}".
inline std::string values(const std::string& table, const std::vector<Real>& v) {
  return fmt::format("Tables.{}.values={{{:.17g}}}", table, fmt::join(v, ", "));
}

/// Sides of a block that permit uniform stress: loaded by its traction (as in the scene), or tied to each other.
enum class Sides { loaded, tied };

/// Replaces the tractions on the sides of a block by periodic conditions.
inline void tie_sides(model::Scene& scene) {
  scene.mesh.periodic = {"x", "y"};
  scene.mesh.periodic.resize(scene.mesh.lower_corner.size() - 1);
  auto& conditions = scene.boundary_conditions;
  for (auto c = conditions.begin(); c != conditions.end();)
    c = c->second.traction.empty() ? std::next(c) : conditions.erase(c);
}

/// Solvers stop at 1e-11, relative to the loads; these have magnitude one here.
constexpr Real tolerance = 1e-11;

/// State of a joint: traction l_t m + l_n n, plastic jump u_p m, opening, closure B(l_n), tangential stiffness K_t.
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
