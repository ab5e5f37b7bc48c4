// Exact states of blocks under one uniform stress, for any mesh: how to prescribe them in a scene and compare them.
#pragma once

#include "verification/scenes.hpp"

#include <map>
#include <memory>

namespace sprekk::tests {

constexpr Real G = 1, lame_lambda = 1;  // of the rock in all patch tests

inline Vector3 scaled(Real factor, const Vector3& v) { return {factor * v[0], factor * v[1], factor * v[2]}; }

/// Round-off (1e-16) times the condition number of the matrix; moduli, sides, displacements and stresses have
/// magnitude 1. A slipping joint is exactly at its friction bound, with a finite slip. Thus rounding of mu changes its
/// traction only by the rounding of mu N.
inline constexpr Real tolerance = 1e-11;

/// Law of a joint, and its exact state for sides ordered along n.
struct PatchJoint {
  Real K_t, dilation_tangent, g0, Du, K_n;
  Vector3 n{}, traction{}, elastic{}, plastic{};
  Real N = 0;  ///< normal force per area

  Vector3 tangential(const Vector3& v) const { return difference(v, scaled(dot(v, n), n)); }
  Vector3 tangential_traction() const { return tangential(traction); }
  Vector3 jump() const { return {elastic[0] + plastic[0], elastic[1] + plastic[1], elastic[2] + plastic[2]}; }
};

/// Returns the state under a stress with a plastic tangential jump u_p:
/// [[u]] = u_p + lambda_t/K_t + (g0 + tan(theta)|u_p| - Du N/(Du K_n + N)) n.
inline PatchJoint at_stress(PatchJoint joint, const Vector3& n, const Matrix3& stress, const Vector3& u_p) {
  joint.n = n;
  joint.traction = times(stress, n);
  joint.N = -dot(joint.traction, n);
  const Real closure = joint.Du * joint.N / (joint.Du * joint.K_n + joint.N);
  const auto t = joint.tangential_traction();
  for (int i = 0; i < 3; ++i) {
    joint.elastic[i] = t[i] / joint.K_t - closure * n[i];
    joint.plastic[i] = u_p[i] + (joint.g0 + joint.dilation_tangent * norm(u_p)) * n[i];
  }
  return joint;
}

/// Exact state with the displacement strain (x - origin) + offset of the block; blocks by names of regions, joints by
/// names of fractures.
struct Patch {
  int dim;
  Matrix3 stress{}, strain{};
  Vector3 origin{};
  std::map<std::string, Vector3> offset = {};
  std::map<std::string, PatchJoint> joints = {};

  Vector3 displacement(const std::string& block, const Vector3& x) const {
    auto u = times(strain, difference(x, origin));
    for (int i = 0; i < 3; ++i) u[i] += offset.at(block)[i];
    return u;
  }
};

/// Returns the state by Hooke's law; in 2D plane strain, which determines stress_zz.
inline Patch uniform_patch(int dim, Matrix3 stress, Real lambda = lame_lambda) {
  if (dim == 2) stress[2][2] = lambda / (2 * (lambda + G)) * (stress[0][0] + stress[1][1]);
  Patch patch{dim, stress};
  const Real trace = stress[0][0] + stress[1][1] + stress[2][2];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      patch.strain[i][j] = (stress[i][j] - (i == j ? lambda / (3 * lambda + 2 * G) * trace : 0)) / (2 * G);
  return patch;
}

/// Adds the blocks between the joints. The name of a block has a '+' or '-' for each joint (ordered by name), for its
/// side of the joint. Its offset is the sum of the jumps of joints with '+'.
inline void add_blocks(Patch& patch) {
  patch.offset = {{"", {}}};
  for (const auto& [name, joint] : patch.joints) {
    std::map<std::string, Vector3> more;
    for (auto [block, u] : patch.offset) {
      more[block + "-"] = u;
      for (int i = 0; i < 3; ++i) u[i] += joint.jump()[i];
      more[block + "+"] = u;
    }
    patch.offset = more;
  }
}

/// Returns the exact displacement in a block as expressions of x, y, z.
inline std::vector<base::Expression> displacement_expressions(const Patch& patch, const std::string& block) {
  std::vector<base::Expression> u;
  for (int i = 0; i < patch.dim; ++i) {
    std::string text = fmt::format("{:.17g}", patch.offset.at(block)[i]);
    for (int j = 0; j < patch.dim; ++j)
      text += fmt::format(" + ({:.17g})*({}-({:.17g}))", patch.strain[i][j], "xyz"[j], patch.origin[j]);
    u.emplace_back(text);
    u.back().compile();
  }
  return u;
}

/// Prescribes the exact displacement of its block in every condition of a scene; each condition must have a region.
inline void prescribe(model::Scene& scene, const Patch& patch) {
  for (auto& [name, condition] : scene.boundary_conditions)
    condition.displacement = displacement_expressions(patch, condition.region.value());
}

/// Compares displacements at all nodes, stresses in all cells, and for every joint the global vectors and invariants.
/// A joint with a tangential plastic jump must slip, others stick.
inline void expect_patch(model::Model& model, const Patch& patch, Real tolerance) {
  const Outputs out(model);
  const auto& mesh = model.mesh();
  constexpr int of_stress[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}};
  const auto& u = out["displacement"].values;
  const auto& stress = out["stress"].values;
  for (LocalIndex cell = 0; cell < mesh.n_owned_cells; ++cell) {
    const auto& block = mesh.region_names[mesh.cell_region[cell]];
    for (int k = 0; k < mesh.nodes_per_cell(); ++k) {
      const LocalIndex node = mesh.cells[cell * mesh.nodes_per_cell() + k];
      Vector3 x{};
      std::copy_n(&mesh.coordinates[node * patch.dim], patch.dim, x.begin());
      const auto exact = patch.displacement(block, x);
      for (int i = 0; i < patch.dim; ++i)
        ASSERT_NEAR(u[node * patch.dim + i], exact[i], tolerance) << "node " << node << " of block " << block;
    }
    for (int i = 0; i < 6; ++i)
      ASSERT_NEAR(stress[6 * cell + i], patch.stress[of_stress[i][0]][of_stress[i][1]], tolerance)
          << "stress " << i << " of cell " << cell;
  }
  for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) {
    const auto& face = mesh.fracture_faces[f];
    const auto& name = mesh.fracture_names[face.fracture];
    const auto& joint = patch.joints.at(name);
    const Real sign = dot(face.frame[0], joint.n);
    SCOPED_TRACE(fmt::format("face {} of {}, sign {}", f, name, sign));
    ASSERT_NEAR(std::abs(sign), 1, tolerance);
    const auto expect = [&](const char* field, const Vector3& exact) {
      const auto v = out.vector(field, f);
      for (int i = 0; i < 3; ++i) ASSERT_NEAR(sign * v[i], exact[i], tolerance) << field << " " << i;
    };
    expect("traction", joint.traction);
    expect("jump", joint.jump());
    expect("elastic jump", joint.elastic);
    expect("plastic jump", joint.plastic);
    const auto jump = out.vector("jump local", f), traction = out.vector("traction local", f);
    const Real j_n = dot(joint.jump(), joint.n), slip = norm(joint.tangential(joint.plastic));
    EXPECT_NEAR(jump[0], j_n, tolerance);
    EXPECT_NEAR(std::hypot(jump[1], jump[2]), norm(joint.tangential(joint.jump())), tolerance);
    EXPECT_NEAR(traction[0], -joint.N, tolerance);
    EXPECT_NEAR(std::hypot(traction[1], traction[2]), norm(joint.tangential_traction()), tolerance);
    EXPECT_NEAR(out.scalar("opening", f), j_n, tolerance);
    EXPECT_NEAR(out.scalar("slip", f), slip, tolerance);
    EXPECT_EQ(out.scalar("state", f), slip > 1e-6 ? 2 : 1);
  }
}

/// Runs the single step of a scene and compares. Newton's tolerance is at round-off, so that iteration errors do not
/// count.
inline void expect_solves(model::Scene scene, const Patch& patch, Real tolerance) {
  scene.solver.tolerance = 1e-13;
  model::Model model(scene, Tpetra::getDefaultComm());
  const auto report = model.step_to(1);
  ASSERT_TRUE(report.converged) << report.reason;
  EXPECT_EQ(report.cuts, 0);
  expect_patch(model, patch, tolerance);
}

}  // namespace sprekk::tests
