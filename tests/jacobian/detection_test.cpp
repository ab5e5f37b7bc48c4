// The check of Jacobians detects wrong derivatives and undeclared dependencies.
#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>

#include "assembly/jacobian_check.hpp"
#include "unit/assembly/fake_modules.hpp"

namespace sprekk {
namespace {

constexpr mesh::Shape shape = mesh::Shape::quadrilateral;

std::vector<assembly::JacobianError> errors_with(Real wrong, bool reads_undeclared) {
  const auto mesh =
      mesh::make_distributed(mesh::make_box(mesh::testing::crossed("quadrilateral")), Tpetra::getDefaultComm());
  auto springs = std::make_unique<test::Springs<shape>>();
  springs->force = 3;
  auto glue = std::make_unique<test::Glue<shape>>();
  glue->wrong = wrong;
  glue->reads_undeclared = reads_undeclared;
  test::Modules modules;
  modules.push_back(std::move(springs));
  modules.push_back(std::move(glue));
  modules.push_back(std::make_unique<test::Hardening<shape>>());
  auto system = test::make_system(mesh, std::move(modules));
  system->set_time(1, 1);
  auto x = system->initial();
  test::randomize(x, 0.3, 1);
  return assembly::check_jacobian(*system, x);
}

bool is_glue_by_displacement(const assembly::JacobianError& e) {
  return e.module == "glue" && e.row == "glue" && e.column == "displacement";
}

TEST(CheckJacobian, AcceptsRightDerivatives) {
  const auto errors = errors_with(0, false);
  EXPECT_EQ(errors.size(), 3u * 2u * 2u);
  for (const auto& e : errors) EXPECT_LE(e.error, 1e-6) << e.module << ": " << e.row << ", " << e.column;
}

TEST(CheckJacobian, FindsAWrongDerivativeAndNamesItsPlace) {
  for (Real wrong : {1e-3, -0.5})
    for (const auto& e : errors_with(wrong, false)) {
      if (is_glue_by_displacement(e))
        EXPECT_GT(e.error, 0.03 * std::abs(wrong));
      else
        EXPECT_LE(e.error, 1e-6) << e.module << ": " << e.row << ", " << e.column;
    }
}

TEST(CheckJacobian, FindsADependencyThatIsNotDeclared) {
  for (const auto& e : errors_with(0, true)) {
    if (is_glue_by_displacement(e))
      EXPECT_GT(e.error, 1e-3);
    else
      EXPECT_LE(e.error, 1e-6) << e.module << ": " << e.row << ", " << e.column;
  }
}

}  // namespace
}  // namespace sprekk
