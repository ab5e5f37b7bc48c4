// Several specimens in one scene: each has the same result as alone.
#include "point_scenes.hpp"

#include <sstream>

namespace sprekk::tests {
namespace {

laboratory::PointScene shear_tests(const std::vector<std::string>& overrides = {}) {
  return laboratory::read_point_scene(*Tpetra::getDefaultComm(), source_dir() + "/xml/point/shear_tests.xml",
                                      overrides);
}

TEST(Specimens, AreWhatTheyAreAlone) {
  const auto scene = shear_tests();
  const auto curves = laboratory::drive_points(scene);
  ASSERT_EQ(curves.size(), 5u);
  for (const auto& curve : curves) {
    auto alone = scene;
    alone.point = scene.specimens.at(curve.specimen);
    alone.specimens.clear();
    const auto states = laboratory::drive_point(alone);
    ASSERT_EQ(states.size(), curve.states.size());
    for (std::size_t k = 0; k < states.size(); ++k) {
      EXPECT_EQ(states[k].jump, curve.states[k].jump);
      EXPECT_EQ(states[k].traction, curve.states[k].traction);
    }
  }
}

/// Curves begin at the initial traction with its jump: 1 MPa over 50 GPa/m.
TEST(Specimens, BeginWithTheInitialState) {
  const auto curve = laboratory::drive_points(shear_tests())[1];
  EXPECT_EQ(curve.specimen, "1 MPa");
  EXPECT_EQ(curve.initial.t, 0);
  EXPECT_EQ(curve.initial.traction[0], -1e6);
  EXPECT_NEAR(curve.initial.jump[0], -1e6 / 50e9, 1e-18);
  EXPECT_EQ(curve.initial.jump[1], 0);
  EXPECT_EQ(curve.initial.contact, laws::ContactState::stick);
}

/// The strength is the friction bound, i.e. the shear traction of a slipping joint. The maximum is the peak strength.
TEST(Specimens, StrengthIsTheShearTractionOfSlip) {
  const auto curve = laboratory::drive_points(shear_tests({"Time.steps=1600"}))[1];
  Real largest = 0;
  for (const auto& s : curve.states) {
    if (s.contact == laws::ContactState::slip) EXPECT_NEAR(s.strength, s.traction[1], 1e-9 * 1e6) << s.t;
    largest = std::max(largest, s.strength);
  }
  EXPECT_NEAR(largest, 1.1917535926e6, 2e-3 * 1e6);  // up to rounding at the kink
}

/// A specimen that fails in a step keeps its earlier states. The other specimens are complete, and the file has the
/// rows of all.
TEST(Specimens, OneFailsAlone) {
  const auto curves = laboratory::drive_points(
      shear_tests({"Specimens.1 MPa.control={traction, traction}", "Specimens.1 MPa.path={-1e6, 2e4*t}"}));
  std::size_t rows = 1;
  for (const auto& curve : curves) {
    EXPECT_EQ(curve.failure.empty(), curve.specimen != "1 MPa");
    if (curve.failure.empty()) EXPECT_EQ(curve.states.size(), 160u);
    rows += 1 + curve.states.size();
  }
  EXPECT_GT(curves[1].states.size(), 50u);
  EXPECT_NE(curves[1].failure.find("shear_tests.xml: Sprekk > Specimens > 1 MPa: step "), std::string::npos)
      << curves[1].failure;
  std::stringstream csv;
  laboratory::write_csv(csv, curves);
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line.substr(0, 16), "specimen,t,state");
  for (--rows; std::getline(csv, line); --rows) EXPECT_EQ(line.substr(0, 1), "\"");
  EXPECT_EQ(rows, 0u);
}

TEST(Specimens, AreInsteadOfAPoint) {
  try {
    shear_tests({"Point.material=joint", "Point.control={jump, jump}", "Point.path={0, 0}"});
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("Specimens: given in addition to \"Point\""), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace sprekk::tests
