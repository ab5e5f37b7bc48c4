// Prescribed displacements that jump at a fault on the boundary, compared with rigid blocks.
#include "verification/loads/block.hpp"

namespace sprekk::tests {
namespace {

/// Returns two blocks with a fault at half height; the upper block has a fracture from the west side that ends in the
/// rock. The boundaries of the blocks move along the fault by 1 and -1 mm, prescribed by the expression `step`.
model::Scene moved_blocks(const Discretisation& cells, Real degrees, const std::string& step) {
  const int dim = cells.cell == "triangle" || cells.cell == "quadrilateral" ? 2 : 3, up = dim - 1;
  auto scene = box_of_rock(cells, std::vector<Real>(dim, 2), std::vector<int>(dim, 4), "3e10");
  const auto add = [&](const std::string& name, Real height, Real end) {
    auto lower = std::vector<Real>(dim, 0), upper = std::vector<Real>(dim, 2);
    lower[up] = upper[up] = height;
    upper[0] = end;
    scene.mesh.fractures[name] = {lower, upper, {}, false};
    scene.fractures[name].material = "smooth";
  };
  add("fault", 1, 2);
  add("branch", 1.5, 1);
  scene.materials["smooth"].type = "joint";
  scene.materials["smooth"].friction_coefficient = base::Expression(0);
  const Vector3 axis = dim == 2 ? Vector3{0, 0, 1} : Vector3{1, 2, 2};
  scene.mesh.rotation = degrees;
  scene.mesh.rotation_axis = {axis[0], axis[1], axis[2]};
  const Matrix3 Q = rotation(degrees, axis);
  const auto height = fmt::format("({:.17g})*x+({:.17g})*y+({:.17g})*z", Q[0][up], Q[1][up], Q[2][up]);
  std::vector<std::string> u;
  for (int i = 0; i < dim; ++i)
    u.push_back(fmt::format("({:.17g})*({})", Q[i][0], fmt::format(fmt::runtime(step), height)));
  for (const std::string side : {"west", "east", "south", "north", "bottom", "top"})
    if (dim == 3 || (side != "bottom" && side != "top")) prescribe(scene, side, u);
  return scene;
}

TEST(SidesOfAFault, MoveApartAlongIt) {
  for (const int dim : {2, 3})
    for (const auto& cells : discretisations(dim))
      for (const auto& [degrees, step] : {std::pair{0.0, "{0} > 1 ? 1e-3 : -1e-3"},
                                          {0.0, "{0} < 1 ? -1e-3 : 1e-3"},
                                          {0.0, "{0} > 1+1e-7 ? 1e-3 : -1e-3"},  // tolerance as for nodes read from a
                                                                                 // file
                                          {0.0, "{0} > 1-1e-7 ? 1e-3 : -1e-3"},
                                          {30.0, "{0} > 1 ? 1e-3 : -1e-3"}}) {
        SCOPED_TRACE(fmt::format("{} {} {}", cells.name(), degrees, step));
        model::Model model(moved_blocks(cells, degrees, step), Tpetra::getDefaultComm());
        const auto report = model.step_to(1);
        ASSERT_TRUE(report.converged) << report.reason;
        const Matrix3 Q = rotation(degrees, dim == 2 ? Vector3{0, 0, 1} : Vector3{1, 2, 2});
        const Vector3 n = dim == 2 ? Vector3{0, 1, 0} : Vector3{0, 0, 1};
        expect_joint(model, {n, {}, {2e-3, 0, 0}, {}, 1e-12, 1e-3, "fault"}, Q);
        expect_joint(model, {n, {}, {}, {}, 1e-12, 1e-3, "branch"}, Q);
        for (const auto& reaction : model.system().reactions(model.state()))
          for (const Real force : reaction.force) EXPECT_NEAR(force, 0, 1e-3);
      }
}

}  // namespace
}  // namespace sprekk::tests
