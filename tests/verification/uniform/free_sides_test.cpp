// Block with traction-free sides, hence without uniform stress. The joint sticks everywhere, so loads superpose.
// Reference: quadratic finite elements with double nodes on the fracture and a spring between them, on meshes graded
// towards the sides. The last digits, in brackets, are uncertain.
#include "verification/uniform/states.hpp"

namespace sprekk::tests {
namespace {

/// Compared quantities of a fracture of unit length.
struct Solution {
  Vector3 force;                    ///< resultant traction per width
  Vector3 jump_centre, jump_side;   ///< at the centre of the fracture and at its end x = 0; needs nodes there
  Vector3 above_centre, above_end;  ///< displacement of the side + at the centre and at x = 1
};

Solution operator-(const Solution& a, const Solution& b) {
  return {difference(a.force, b.force), difference(a.jump_centre, b.jump_centre), difference(a.jump_side, b.jump_side),
          difference(a.above_centre, b.above_centre), difference(a.above_end, b.above_end)};
}

/// Returns the mean displacement of the nodes on a side of the fracture at x. Bubbles vanish at nodes. Collective.
Vector3 displacement_at(model::Model& model, mesh::Side side, Real x) {
  const auto& mesh = model.mesh();
  const Outputs out(model);
  const int dim = mesh.dim();
  std::array<Real, 4> here{}, all;
  for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f)
    for (const LocalIndex node : mesh.fracture_faces[f].nodes[side])
      if (node >= 0 && std::abs(mesh.coordinates[node * dim] - x) < 1e-9) {
        for (int i = 0; i < dim; ++i) here[i] += out["displacement"].values[node * dim + i];
        ++here[3];
      }
  Teuchos::reduceAll(*mesh.comm, Teuchos::REDUCE_SUM, 4, here.data(), all.data());
  return {all[0] / all[3], all[1] / all[3], all[2] / all[3]};
}

Solution solution_of(model::Model& model) {
  const auto at = [&](mesh::Side side, Real x) { return displacement_at(model, side, x); };
  const Outputs out(model);
  Solution a;
  for (int i = 0; i < 3; ++i) a.force[i] = mean(model, out["traction"], i);
  a.jump_centre = difference(at(mesh::plus, 0.5), at(mesh::minus, 0.5));
  a.jump_side = difference(at(mesh::plus, 0), at(mesh::minus, 0));
  a.above_centre = at(mesh::plus, 0.5);
  a.above_end = at(mesh::plus, 1);
  return a;
}

/// Returns the scene with n cells along the fracture; in 3D the slab is one cell thick.
model::Scene block(int dim, const Discretisation& d, int n, std::vector<std::string> overrides = {}) {
  auto scene = read_scene(fmt::format("verification/free_sides_{}d.xml", dim), d.with(overrides));
  scene.mesh.cells = dim == 2 ? std::vector<int>{n, n} : std::vector<int>{n, 1, n};
  if (dim == 3) scene.mesh.upper_corner[1] = scene.mesh.fractures.at("fracture").upper_corner[1] = 1.0 / n;
  return scene;
}

/// Returns the scene on a Gmsh mesh, refined towards the ends of the fracture.
model::Scene graded_block(int dim, const Discretisation& d) {
  auto scene = read_scene(fmt::format("verification/free_sides_{}d.xml", dim));
  scene.mesh_file.emplace();
  scene.mesh_file->path = fmt::format("{}/tests/data/meshes/free_sides_{}.msh", source_dir(), d.cell);
  scene.mesh_file->order = d.order;
  scene.mesh_file->fractures["fracture"].reference_normal = std::vector<Real>(dim, 0);
  scene.mesh_file->fractures["fracture"].reference_normal->at(dim - 1) = 1;
  if (dim == 3) scene.mesh_file->periodic = {"front", "back"};
  return scene;
}

/// Errors under compression d = (0, -1) and shear d = (1, 0). Resultants T = 0.49003(2), N = 2.75091(2): relative
/// errors. Displacements, relative to d: tangential jump 0.2894(1) at the centre and 0.1647(2) at x = 0; u_x of side +
/// at x = 1 0.164837(2).
struct Errors {
  Real T, N, jump_centre, jump_side, above_end, jump_compressed;
};

Errors errors(int dim, const model::Scene& scene) {
  model::Model model(scene, Tpetra::getDefaultComm());
  EXPECT_TRUE(model.step_to(1).converged);
  const Solution compressed = solution_of(model);
  EXPECT_TRUE(model.step_to(2).converged);
  const Solution sheared = solution_of(model) - compressed;
  return {std::abs(sheared.force[0] / 0.49003 - 1),
          std::abs(compressed.force[dim - 1] / 2.75091 + 1),
          std::abs(sheared.jump_centre[0] - 0.2894),
          std::abs(sheared.jump_side[0] - 0.1647),
          std::abs(compressed.above_end[0] - 0.164837),
          std::max(std::abs(compressed.jump_centre[0]), std::abs(compressed.jump_side[0]))};
}

/// Order 2 needs at least 16 cells along the fracture for errors of 1e-3. The jump at the free end converges with
/// order one. In compression the jump vanishes by symmetry, except for tetrahedra, which are not symmetric about the
/// fracture.
TEST(FreeSides, CompressedAndSheared) {
  for (const int dim : {2, 3})
    for (const auto& d : discretisations(dim)) {
      SCOPED_TRACE(d.name());
      const Errors coarse = errors(dim, block(dim, d, 8)), fine = errors(dim, block(dim, d, 16));
      const bool linear = d.order == 1;
      EXPECT_LT(fine.T, linear ? 2e-2 : 1e-3);
      EXPECT_LT(fine.N, linear ? 3e-3 : 1e-3);
      EXPECT_LT(fine.jump_centre, 1e-3);
      EXPECT_LT(fine.above_end, linear ? 2e-3 : 1e-3);
      EXPECT_LT(fine.jump_side, linear ? 3e-2 : 6e-3);
      EXPECT_LT(fine.T, coarse.T / 2.4);
      EXPECT_LT(fine.N, coarse.N / 2.4);
      EXPECT_LT(fine.jump_side, coarse.jump_side / 1.5);
      EXPECT_LT(fine.jump_compressed, d.cell != "tetrahedron" ? 1e-12 : linear ? 2e-3 : 2e-4);
    }
}

/// With order 2, all quantities have errors of 1e-3, also at the free ends.
TEST(FreeSides, GradedMesh) {
  for (const int dim : {2, 3})
    for (const auto& d : discretisations(dim)) {
      SCOPED_TRACE(d.name());
      const Errors e = errors(dim, graded_block(dim, d));
      if (Tpetra::getDefaultComm()->getRank() == 0)
        fmt::print("{}: T {:.1e}, N {:.1e}, jump at the centre {:.1e}, at the free end {:.1e}, u_x {:.1e}\n", d.name(),
                   e.T, e.N, e.jump_centre, e.jump_side, e.above_end);
      const bool linear = d.order == 1, mirrored = d.cell == "quadrilateral" || d.cell == "hexahedron";
      EXPECT_LT(e.T, linear ? 1.5e-2 : 1e-3);
      EXPECT_LT(e.N, linear ? 2.5e-3 : 1e-3);
      EXPECT_LT(e.jump_centre, linear ? 2e-3 : 1e-3);
      EXPECT_LT(e.jump_side, linear ? 2e-2 : 1e-3);
      EXPECT_LT(e.above_end, linear ? 2e-3 : 1e-3);
      EXPECT_LT(e.jump_compressed, mirrored ? 1e-12 : linear ? 2e-3 : 1e-4);
    }
}

/// Push test of Wollmann (2024): jump 0.999999999984 at the centre, u_x of side + from 1 at the centre to 1.000234676
/// at the end, N = 2000999.654 Pa. The joint is 1e11 times softer than the rock. A direct solver gives more digits of
/// such jumps than Newton's tolerance requires.
TEST(FreeSides, Push) {
  for (const int dim : {2, 3})
    for (const auto& d : discretisations(dim)) {
      SCOPED_TRACE(d.name());
      model::Model model(block(dim, d, 16,
                               {"Materials.rock.shear modulus=1e6", "Materials.rock.Lame's first parameter=1e3",
                                "Materials.joint.tangential stiffness=1e-5", "Materials.joint.friction coefficient=1",
                                "Solver.Linear solver.type=direct"}),
                         Tpetra::getDefaultComm());
      ASSERT_TRUE(model.step_to(2).converged);
      const Solution a = solution_of(model);
      const Real symmetric = d.cell != "tetrahedron" ? 1e-12 : d.order == 1 ? 5e-6 : 1e-7;
      EXPECT_NEAR(a.jump_centre[0], 0.999999999984, symmetric);
      EXPECT_NEAR(a.above_centre[0], 0.999999999992, symmetric);
      EXPECT_NEAR(a.above_end[0], 1.000234676, 2e-6);
      EXPECT_NEAR(a.force[dim - 1], -2000999.654, 0.02);
    }
}

}  // namespace
}  // namespace sprekk::tests
