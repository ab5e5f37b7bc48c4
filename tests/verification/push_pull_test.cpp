// Block of Wollmann (2024) with a fracture through it, under push and pull: all cell shapes, rotations, renumbering,
// swapped sides.
#include "verification/scenes.hpp"

namespace sprekk::tests {
namespace {

constexpr Real K_t = 1e-5;                                 // Pa/m, in these scenes
constexpr Real G = 1e6, lambda = 1e3, P = 2 * G + lambda;  // Pa
const Real plane_strain = P - lambda * lambda / P;         // of a free side: stress per strain in 2D, Pa

/// Rotation, side order and numbering of the same problem.
struct Variant {
  std::string cell;
  Real degrees = 0;
  Vector3 axis = {0, 0, 1};
  bool swap = false;
  std::optional<int> seed = {};
};

std::vector<Variant> variants(int dim) {
  struct Turn {
    Real degrees;
    Vector3 axis;
  };
  const Vector3 z = {0, 0, 1};
  const std::vector<Turn> turns =
      dim == 2 ? std::vector<Turn>{{0, z}, {17, z}, {90, z}, {-61.3, z}, {203.7, z}}
               : std::vector<Turn>{{0, z}, {33, {1, 2, 3}}, {-118, {0.3, -1, 0.2}}, {90, {1, 0, 0}}};
  std::vector<Variant> all;
  for (const auto& cell : cells_of(dim))
    for (const auto& turn : turns)
      for (const bool swap : {false, true}) {
        all.push_back({cell, turn.degrees, turn.axis, swap, {}});
        all.push_back({cell, turn.degrees, turn.axis, swap, 5});
      }
  return all;
}

/// Calls visit(model, Q) after the step, for a scene in every variant with one of the cells.
template <class Visit>
void for_variants(const std::string& name, int dim, const std::vector<std::string>& cells,
                  const std::vector<std::string>& overrides, const Visit& visit) {
  for (const auto& v : variants(dim)) {
    if (std::find(cells.begin(), cells.end(), v.cell) == cells.end()) continue;
    SCOPED_TRACE(fmt::format("{} {} {} degrees about ({}) swapped {} renumbered {}", name, v.cell, v.degrees,
                             fmt::join(v.axis, ", "), v.swap, v.seed.has_value()));
    auto scene = read_scene(name, overrides);
    scene.solver.linear_solver.type = "direct";
    scene.mesh.cell = v.cell;
    scene.mesh.renumbering_seed = v.seed;
    for (auto& [key, fracture] : scene.mesh.fractures) fracture.swap_sides = v.swap;
    const auto Q = turn(scene, v.degrees, v.axis);
    model::Model model(scene, Tpetra::getDefaultComm());
    const auto report = model.step_to(1);
    ASSERT_TRUE(report.converged) << report.reason;
    EXPECT_LE(report.newton_iterations, 2);
    visit(model, Q);
  }
}

void run(const std::string& name, int dim, const std::vector<std::string>& cells,
         const std::vector<std::string>& overrides, const Expected& expected) {
  for_variants(name, dim, cells, overrides,
               [&](model::Model& model, const Matrix3& Q) { expect_joint(model, expected, Q); });
}

TEST(Push2D, JumpIsElastic) {
  // The sides are free, so the normal traction varies slightly between meshes. Tests below compare it accurately.
  run("seed/push_2d.xml", 2, cells_of(2), {},
      {{0, 1, 0}, {1, 0, 0}, {0, 0, 0}, {K_t, -2.001e6, 0}, 1e-9, 1e-6 * 2.001e6});
}

TEST(Push3D, JumpIsElastic) {
  run("seed/push_3d.xml", 3, {"hexahedron"}, {},
      {{0, 1, 0}, {2, 0, 3}, {0, 0, 0}, {2 * K_t, -2.001e6, 3 * K_t}, 1e-9, 1e-6 * 2.001e6});
}

/// The tetrahedra on both sides of the fracture are not symmetric. With Poisson's ratio above zero, the sides of the
/// fracture therefore deform differently. Without it, the state is uniform and exact.
TEST(Push3D, JumpIsElasticBetweenTetrahedra) {
  run("seed/push_3d.xml", 3, {"tetrahedron"}, {"Materials.rock.Lame's first parameter=0"},
      {{0, 1, 0}, {2, 0, 3}, {0, 0, 0}, {2 * K_t, -2e6, 3 * K_t}, 1e-9, 1e-9 * 2e6});
}

/// With Poisson's ratio above zero, all variants have the same solution in every face. The error of the jump vanishes
/// under refinement.
TEST(Push3D, TetrahedraDoNotSeeTheFrame) {
  std::vector<Vector3> centres, jumps, tractions;
  for_variants("seed/push_3d.xml", 3, {"tetrahedron"}, {}, [&](model::Model& model, const Matrix3& Q) {
    const auto faces = gathered_faces(model, Q, {0, 1, 0});
    if (centres.empty()) {
      centres = faces.centre;
      jumps = faces.jump;
      tractions = faces.traction;
    }
    ASSERT_EQ(faces.centre.size(), 8u);
    for (std::size_t f = 0; f < centres.size(); ++f) {
      std::size_t same = 0;
      while (same < centres.size() && norm(difference(centres[same], faces.centre[f])) > 1e-9) ++same;
      ASSERT_LT(same, centres.size());
      EXPECT_LT(norm(difference(faces.jump[f], jumps[same])), 1e-9);
      EXPECT_LT(norm(difference(faces.traction[f], tractions[same])), 1e-9 * 2e6);
    }
  });
  std::vector<Real> errors;
  for (const int n : {4, 8, 16}) {
    model::Model model(
        read_scene("seed/push_3d.xml", {"Mesh.cell=tetrahedron", fmt::format("Mesh.cells={{{0}, {0}, {0}}}", n)}),
        Tpetra::getDefaultComm());
    ASSERT_TRUE(model.step_to(1).converged);
    const Outputs out(model);
    errors.push_back(std::hypot(mean(model, out["elastic jump"], 0) - 2, mean(model, out["elastic jump"], 2) - 3));
  }
  EXPECT_LT(errors[0], 1e-4);
  EXPECT_LT(errors[1], 0.5 * errors[0]);
  EXPECT_LT(errors[2], 0.5 * errors[1]);
}

TEST(Pull2D, JumpIsPlasticAndTheFaceIsOpen) {
  run("seed/pull_2d.xml", 2, cells_of(2), {}, {{0, 1, 0}, {0, 0, 0}, {1, 1, 0}, {0, 0, 0}});
}

TEST(Pull3D, JumpIsPlasticAndTheFaceIsOpen) {
  run("seed/pull_3d.xml", 3, cells_of(3), {}, {{0, 1, 0}, {0, 0, 0}, {2, 1, 3}, {0, 0, 0}});
}

/// The shear traction is K_t u^e, to the accuracy of u^e. The normal traction is between the values of free and of
/// constrained sides. It agrees with two independent discretisations of the free sides: finite volumes on the same 2 x
/// 2 cells (-2000999.55 Pa; 3D -2000999.137 Pa) and quadratic elements (-2000999.65 Pa).
TEST(Push, Tractions) {
  for (const int dim : {2, 3}) {
    model::Model model(read_scene(dim == 2 ? "seed/push_2d.xml" : "seed/push_3d.xml"), Tpetra::getDefaultComm());
    ASSERT_TRUE(model.step_to(1).converged);
    const Outputs out(model);
    const auto& traction = out["traction"];
    EXPECT_NEAR(mean(model, traction, 0), dim == 2 ? K_t : 2 * K_t, 1e-9 * K_t);
    if (dim == 3) {
      EXPECT_NEAR(mean(model, traction, 2), 3 * K_t, 1e-9 * K_t);
    }
    const Real t_n = mean(model, traction, 1);
    for (const Real other :
         dim == 2 ? std::vector<Real>{-2000999.55, -2000999.65} : std::vector<Real>{-2000999.13711814})
      EXPECT_NEAR(t_n, other, 1e-6 * 2.001e6);
    EXPECT_GT(t_n, -P);
    if (dim == 2) {
      EXPECT_LT(t_n, -plane_strain);
    }
  }
}

}  // namespace
}  // namespace sprekk::tests
