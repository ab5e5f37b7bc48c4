// Factors of safety of blocks on one and two planes, compared with limit equilibrium.
#include "model/factor_of_safety.hpp"
#include "verification/loads/block.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace sprekk::tests {
namespace {

constexpr Real default_tolerance = 1e-6, tolerance = default_tolerance, rounding = 1e-8;

model::FactorOfSafety safety(const std::string& scene, const std::vector<std::string>& overrides = {},
                             Real tolerance = default_tolerance) {
  return model::factor_of_safety({source_dir() + "/xml/slopes/" + scene, overrides, tolerance},
                                 Tpetra::getDefaultComm());
}

void expect_between(const model::FactorOfSafety& found, Real exact) {
  ASSERT_TRUE(found.lost);
  EXPECT_LE(found.stable, exact * (1 + rounding));
  EXPECT_GE(*found.lost, exact * (1 - rounding));
  EXPECT_LE(*found.lost, found.stable * (1 + tolerance));
  for (const auto& reduction : found.reductions) {
    EXPECT_EQ(reduction.stands, reduction.factor <= found.stable) << reduction.factor;
    EXPECT_EQ(reduction.stands, reduction.reason.empty()) << reduction.reason;
  }
}

/// The exact factor of a sliding block does not depend on the mesh.
const std::string coarse = "Mesh.cells={5, 2}";

Real tan_of(Real degrees) { return std::tan(degrees * M_PI / 180); }

/// Returns overrides for a coarse mesh on several ranks; none on one rank (mesh of the scene).
std::vector<std::string> mesh_of_ranks(const std::string& coarse) {
  return Tpetra::getDefaultComm()->getSize() == 1 ? std::vector<std::string>{} : std::vector{coarse};
}

TEST(FactorOfSafety, OfABlockOnAPlane) {
  expect_between(safety("plane_2d.xml", mesh_of_ranks(coarse)), tan_of(40) / tan_of(30));
  expect_between(safety("plane_2d.xml", {coarse, "Mesh.cell=triangle", "Materials.joint.friction angle=32"}),
                 tan_of(32) / tan_of(30));
}

/// Exact factor: (c A + W cos(30) tan(phi)) / (W sin(30)).
TEST(FactorOfSafety, OfABlockWithCohesion) {
  const Real cohesion = 10e3, weight = 2700 * 9.81 * 10 * 2;
  expect_between(
      safety("plane_2d.xml", {coarse, "Materials.joint.bond=constant cohesion", "Materials.joint.cohesion=10 kPa"}),
      (cohesion * 10 + weight * std::cos(M_PI / 6) * tan_of(40)) / (weight / 2));
}

/// Wedge behind a slope of 45 degrees. Its crest opens and loses some cohesion there. In proportion to an opening of 1
/// mm this loss is small: the factor is about 1e-4 below limit equilibrium. On several ranks only the coarsest mesh is
/// used.
TEST(FactorOfSafety, OfASlopeWhoseCrestOpens) {
  const auto scene = model::read_scene(*Tpetra::getDefaultComm(), source_dir() + "/xml/slopes/slope_2d.xml", {});
  const Real weight = scene.material_of("bulk").density_at({}) * 9.81 * 32, length = std::hypot(8, 8);
  const Real exact = 50e3 * length / (weight * std::sqrt(0.5)) + tan_of(40);
  std::vector<std::string> meshes = {"slope1", "slope2", "slope3"};
  if (Tpetra::getDefaultComm()->getSize() > 1) meshes.resize(1);
  for (const auto& mesh : meshes) {
    const auto found =
        safety("slope_2d.xml", {fmt::format("Mesh file.path={}/tests/data/meshes/{}.msh", source_dir(), mesh)}, 1e-4);
    ASSERT_TRUE(found.lost) << mesh;
    EXPECT_LE(found.stable, exact * (1 + rounding)) << mesh;
    EXPECT_GE(*found.lost, exact * (1 - 1e-3)) << mesh;
    EXPECT_THAT(found.states, testing::Contains(testing::StartsWith("slip on 1 of 1 fractures"))) << mesh;
  }
}

/// A block that is unstable with its own strength is stable with twice its strength.
TEST(FactorOfSafety, BelowOne) {
  const std::string path = source_dir() + "/xml/slopes/plane_2d.xml";
  expect_between(model::factor_of_safety({.scene = path,
                                          .overrides = {coarse, "Materials.joint.friction angle=20"},
                                          .tolerance = tolerance,
                                          .first = 0.5},
                                         Tpetra::getDefaultComm()),
                 tan_of(20) / tan_of(30));
}

/// Factor for the joint after a stage.
TEST(FactorOfSafety, AfterStages) {
  expect_between(safety("plane_2d.xml", {coarse, "Stages.s.time=0.5", "Stages.s.Materials.joint.friction angle=50",
                                         "Time.end=1", "Time.steps=1"}),
                 tan_of(50) / tan_of(30));
}

TEST(FactorOfSafety, OfAWedgeOnTwoPlanes) {
  expect_between(safety("wedge_3d.xml", mesh_of_ranks("Mesh.cells={3, 3, 3}")),
                 (7.7 * tan_of(35) + 4 * tan_of(25)) / 4);
}

TEST(FactorOfSafety, WhereNothingSlides) {
  const auto found = safety("plane_2d.xml", {"Bulk.gravity={0, -9.81}", "Mesh.cells={4, 4}"});
  EXPECT_FALSE(found.lost);
  EXPECT_EQ(found.stable, 100);
}

TEST(FactorOfSafety, Refuses) {
  const auto message = [](const std::vector<std::string>& overrides) -> std::string {
    try {
      safety("plane_2d.xml", overrides);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(message({"Materials.joint.friction angle=20", "Mesh.cells={4, 4}"}),
              testing::HasSubstr("found no equilibrium with its own strength"));
  EXPECT_THAT(message({"Stages.s.time=0.5", "Stages.s.Materials.joint.strength reduction factor=2", "Time.end=1"}),
              testing::HasSubstr("is the result of the search; leave it out"));
  EXPECT_THAT(message({"Materials.joint.strength reduction factor=0"}), testing::HasSubstr("must be positive"));
}

}  // namespace
}  // namespace sprekk::tests
