// Fractures that cross inside or on the boundary, under uniform stress, on Gmsh meshes.
#include "verification/patch/patch.hpp"

namespace sprekk::tests {
namespace {

struct Line {
  Real degrees, K_t, zeta;  ///< its slip is zeta lambda_t
};

/// Lines through the meshes cut_lines6 to 8, and the blocks between them.
struct Lines {
  int mesh;
  std::vector<Line> lines;
  std::vector<std::string> blocks;
};

const Lines two = {6, {{0, 2, 0}, {60, 3, 0.8}}, {"--", "-+", "+-", "++"}};
const Lines three = {7, {{10, 2, 0}, {75, 3, 0.8}, {130, 1, 0.3}}, {"---", "--+", "-++", "+--", "+-+", "++-", "+++"}};
const Lines on_boundary = {8, {{75, 3, 0.8}, {130, 1, 0.3}}, {"--", "+-", "++"}};

Patch crossing_patch(int dim, const Lines& lines, Real lambda = lame_lambda) {
  auto patch = uniform_patch(2, {{{-0.8, 0.15, 0}, {0.15, -0.5, 0}, {0, 0, 0}}}, lambda);
  patch.dim = dim;  // plane strain in 3D
  for (std::size_t k = 0; k < lines.lines.size(); ++k) {
    const auto& line = lines.lines[k];
    const Real angle = line.degrees * M_PI / 180;
    PatchJoint joint{line.K_t, std::tan(0.1), 0.01, 0.1, 5};
    const Vector3 n = {-std::sin(angle), std::cos(angle), 0};
    auto u_p = at_stress(joint, n, patch.stress, {}).tangential_traction();
    for (Real& c : u_p) c *= line.zeta;
    patch.joints[fmt::format("f{}", k + 1)] = at_stress(joint, n, patch.stress, u_p);
  }
  add_blocks(patch);
  return patch;
}

/// Returns the scene of three or two lines, with the given mesh, joints and blocks.
model::Scene crossing_scene(int dim, const std::string& cell, int order, const Lines& lines, const Patch& patch) {
  std::vector<std::string> overrides = {
      fmt::format("Mesh file.path=../../tests/data/meshes/cut_lines{}_{}.msh", lines.mesh, cell),
      fmt::format("Mesh file.order={}", order)};
  for (std::size_t k = 0; k < lines.lines.size(); ++k) {
    const auto& joint = patch.joints.at(fmt::format("f{}", k + 1));
    const Real mu = lines.lines[k].zeta == 0 ? 0.6 : norm(joint.tangential_traction()) / joint.N;
    overrides.push_back(fmt::format("Materials.joint {}.tangential stiffness={:.17g}", k + 1, joint.K_t));
    overrides.push_back(fmt::format("Materials.joint {}.friction coefficient={:.17g}", k + 1, mu));
  }
  auto scene = read_scene("verification/crossing_patch_2d.xml", overrides);
  for (std::size_t k = lines.lines.size(); k < 3; ++k) {
    scene.mesh_file->fractures.erase(fmt::format("f{}", k + 1));
    scene.fractures.erase(fmt::format("f{}", k + 1));
  }
  scene.boundary_conditions.clear();
  for (const auto& block : lines.blocks) {
    scene.boundary_conditions[block].boundary = "boundary";
    scene.boundary_conditions[block].region = block;
  }
  prescribe(scene, patch);
  return scene;
}

/// Independent values of the formulas.
TEST(CrossingPatch, Formulas) {
  struct Example {
    Lines lines;
    int line;
    Real N, shear, j_x, j_y;
  };
  const Example examples[] = {
      {two, 1, 0.5, 0.15, 0.075, -0.04},
      {two, 2, 0.854903810568, 0.054903810568, 0.073278941986, 0.029542837356},
      {three, 1, 0.560349128381, 0.192256914617, 0.102108131192, -0.025502265525},
      {three, 2, 0.854903810568, 0.054903810568, 0.030926096167, -0.072705977427},
      {three, 3, 0.528326063698, 0.173768389602, 0.172895067020, -0.149813892206},
  };
  for (const auto& e : examples) {
    const auto patch = crossing_patch(2, e.lines);
    EXPECT_NEAR(patch.strain[0][0], -0.2375, 1e-15);
    EXPECT_NEAR(patch.strain[0][1], 0.075, 1e-15);
    EXPECT_NEAR(patch.strain[1][1], -0.0875, 1e-15);
    const auto& joint = patch.joints.at(fmt::format("f{}", e.line));
    EXPECT_NEAR(joint.N, e.N, 1e-12);
    EXPECT_NEAR(norm(joint.tangential_traction()), e.shear, 1e-12);
    EXPECT_NEAR(joint.jump()[0], e.j_x, 1e-12);
    EXPECT_NEAR(joint.jump()[1], e.j_y, 1e-12);
  }
}

TEST(CrossingPatch, Scenes) {
  for (const int order : {1, 2}) {
    const auto set_order = fmt::format("Mesh file.order={}", order);
    expect_solves(read_scene("verification/crossing_patch_2d.xml", {set_order}), crossing_patch(2, three), tolerance);
    expect_solves(read_scene("verification/crossing_patch_3d.xml", {set_order}), crossing_patch(3, two), tolerance);
  }
}

TEST(CrossingPatch, EveryCell) {
  for (const int dim : {2, 3})
    for (const auto& cell : cells_of(dim))
      for (const auto& lines : dim == 2 ? std::vector<Lines>{two, three, on_boundary} : std::vector<Lines>{two, three})
        for (const int order : {1, 2}) {
          if (dim == 3 && order == 2 && lines.mesh == three.mesh) continue;  // saves much time
          SCOPED_TRACE(fmt::format("{}, mesh {}, order {}", cell, lines.mesh, order));
          const auto patch = crossing_patch(dim, lines);
          expect_solves(crossing_scene(dim, cell, order, lines, patch), patch, tolerance);
        }
}

/// Poisson's ratio 0.49995, with a pressure unknown of the rock. Round-off of displacements is amplified by lambda/G
/// in stresses.
TEST(CrossingPatch, OfNearlyIncompressibleRock) {
  constexpr Real lambda = 1e4;
  for (const int dim : {2, 3})
    for (const auto& cell : cells_of(dim))
      for (const int order : {1, 2}) {
        if (dim == 3 && order == 2) continue;  // saves much time
        SCOPED_TRACE(fmt::format("{}, order {}", cell, order));
        const auto patch = crossing_patch(dim, two, lambda);
        auto scene = crossing_scene(dim, cell, order, two, patch);
        scene.materials.at("rock").lambda = base::Expression(lambda);
        expect_solves(scene, patch, 1e4 * tolerance);
      }
}

}  // namespace
}  // namespace sprekk::tests
