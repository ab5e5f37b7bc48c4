// Growth by injection of a nearly inviscid fluid, from the exact solution of a pressurised crack at its toughness.
#include "injected_notch.hpp"

#include "assembly/geometry.hpp"
#include "model/change.hpp"

#include <Teuchos_DefaultMpiComm.hpp>

namespace sprekk::tests {
namespace injection {

/// Results of xml/growth/injection_2d.xml with a strength, at t = 45 s.
struct End {
  Real length, exact, zone;
};

End end_of(Real strength) {
  constexpr Real rate = 2e-5, half = 12;
  const auto scene =
      read_scene("growth/injection_2d.xml", {fmt::format("Materials.bonded joint.tensile strength={} Pa", strength)});
  model::Model model(scene, Tpetra::getDefaultComm());
  for (const auto& one : model.warnings()) EXPECT_EQ(one.find("process zone"), std::string::npos) << one;
  Opened sums;
  Real work = 0, volume = 0, pressure = 0;
  for (Real t = 0.5; t < 45.1; t += t < 1 ? 1 : 1.5) {
    const auto report = model.step_to(t);
    EXPECT_TRUE(report.converged) << t << ": " << report.reason;
    EXPECT_NEAR(stored(model) / (rate * t), 1, 1e-10) << t;
    sums = opened(model, true, compression, notch);
    EXPECT_EQ(sums.wet_bonded, 0) << t;
    EXPECT_GT(sums.negative, -1e-12) << t;
    const auto values = model.output("fracture pressure").values;
    Real here = values.empty() ? 0 : *std::max_element(values.begin(), values.end()), p = 0;
    Teuchos::reduceAll(*model.mesh().comm, Teuchos::REDUCE_MAX, 1, &here, &p);
    work += (pressure + p - compression) / 2 * (sums.volume - volume);
    pressure = p - compression;
    volume = sums.volume;
  }
  // work of the fluid beyond the compression = elastic + fracture energy, and a third of it is elastic if the work of
  // the notch is added, closed form; both with the time error of the work
  const Real broken = energy * sums.broken;
  EXPECT_NEAR((sums.elastic + broken) / work, 1, 0.01) << strength;
  EXPECT_NEAR(sums.elastic / (work + energy * notch), 1 / 3.0, 0.015) << strength;
  return {notch + sums.broken, exact_length(sums.volume, half), 0.8 * modulus * energy / (strength * strength)};
}

/// The length from the dissipated energy is shorter than that of a sharp crack by a part of the process zone. The error
/// is of first order in the zone.
TEST(Injection, ConvergesToLinearFractureMechanicsWithTheZone) {
  const auto long_zone = end_of(1.556e6), short_zone = end_of(2.2e6);
  for (const auto& end : {long_zone, short_zone}) EXPECT_NEAR((end.exact - end.length) / end.zone, 0.15, 0.06);
  EXPECT_LT(short_zone.exact - short_zone.length, 0.7 * (long_zone.exact - long_zone.length));
}

/// Volume, broken length and elastic energy per width.
std::array<Real, 3> sums_of(model::Model& model, Real width) {
  const auto sums = opened(model, true, compression);
  return {sums.volume / width, sums.broken / width, sums.elastic / width};
}

/// A layer of hexahedra in plane strain gives nearly the result of quadrilaterals, with other face bubbles. All ranks
/// find that of a single rank, and a restored model continues with the same steps.
TEST(Injection, IsTheSameInThreeDimensionsOnAllRanksAndAfterARestart) {
  const std::vector<Real> times = {0.5, 2, 4, 6, 8};
  std::vector<std::array<Real, 3>> all;
  for (const std::string cell : {"quadrilateral", "hexahedron"}) {
    const auto scene = small_body(cell);
    const Real width = cell == "quadrilateral" ? 1 : 0.25;
    model::Model model(scene, Tpetra::getDefaultComm()), again(scene, Tpetra::getDefaultComm()),
        alone(scene, rcp(new Teuchos::MpiComm<int>(MPI_COMM_SELF)));
    for (const Real t : times) {
      const auto report = model.step_to(t);
      ASSERT_TRUE(report.converged) << cell << t << report.reason;
      EXPECT_NEAR(stored(model) / (2e-5 * width * t), 1, 1e-10) << cell << t;
      if (t == 4) again.restore(model.save());
      if (t > 4) {
        ASSERT_TRUE(again.step_to(t).converged);
      }
      ASSERT_TRUE(alone.step_to(t).converged);
    }
    all.push_back(sums_of(model, width));
    EXPECT_GT(all.back()[1], 0.1);  // m, broken
    const auto restarted = sums_of(again, width), serial = sums_of(alone, width);
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(restarted[k] / all.back()[k], 1, 1e-10) << cell << k;
      EXPECT_NEAR(serial[k] / all.back()[k], 1, 1e-7) << cell << k;
    }
  }
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(all[1][k] / all[0][k], 1, 1e-2) << k;
}

/// In porous rock fluid leaks through opened faces. Injected volume = volume between the sides + storage of the rock;
/// without Biot coefficient and compressibility of the fluid the latter is the sum of V c (p - p_0).
TEST(Injection, LeaksIntoPorousRockWithoutLossOfFluid) {
  constexpr Real storage = 1e-10;
  for (const std::string cell : {"quadrilateral", "tetrahedron"}) {
    auto scene = small_body(cell, {"Flow.compressibility=0", "Flow.viscosity=1e-4", "Flow.initial pressure=1e7"});
    auto& rock = scene.materials.at("granite");
    rock.permeability = {base::Expression(2e-17)};
    rock.compressibility = storage;
    rock.biot = 0;
    const Real width = cell == "quadrilateral" ? 1 : 0.25;
    model::Model model(scene, Tpetra::getDefaultComm());
    for (const Real t : {0.5, 2.0, 4.0, 6.0, 8.0}) {
      const auto report = model.step_to(t);
      ASSERT_TRUE(report.converged) << cell << t << report.reason;
      const auto& mesh = model.mesh();
      const auto pressure = model.output("pressure").values;
      Real here = 0, in_rock = 0;
      for (LocalIndex c = 0; c < mesh.n_owned_cells; ++c)
        here += assembly::cell_mean(mesh, c, [](const auto&) { return Real(0); })[0] * storage *
                (pressure[c] - compression);
      Teuchos::reduceAll(*mesh.comm, Teuchos::REDUCE_SUM, 1, &here, &in_rock);
      const auto sums = opened(model, true, compression, notch);
      const auto opening = model.output("opening").values;
      Real asperities = 0, of_notch = 0;  // volume of the notch at the start, beyond its opening
      for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f)
        if (mesh.fracture_faces[f].centre[0] < notch)
          asperities += mesh.fracture_faces[f].area * (std::max(residual, opening[f]) - residual - opening[f]);
      Teuchos::reduceAll(*mesh.comm, Teuchos::REDUCE_SUM, 1, &asperities, &of_notch);
      EXPECT_NEAR((sums.volume + of_notch + in_rock) / (2e-5 * width * t), 1, 1e-10) << cell << t;
      if (t == 8) {
        EXPECT_GT(in_rock, 0.05 * sums.volume);
      }
      EXPECT_EQ(sums.wet_bonded, 0);
    }
    EXPECT_GT(opened(model, true).broken / width, 0.05) << cell;
  }
}

/// A sealed surface conducts 1.25e-4 of one with the residual aperture. Strength and compression prevent its opening.
TEST(Injection, AFilmConductsItsShareOfAnOpenedFace) {
  for (const std::string cell : {"quadrilateral", "hexahedron"}) {
    auto scene = small_body(cell, {"Fractures.growing.unbroken=1"});
    scene.fractures.at("growing").source = base::Expression(0);
    for (const std::string side : {"west", "east"}) {
      auto& condition = scene.boundary_conditions["fluid " + side];
      condition.boundary = side;
      condition.fracture = "growing";
      condition.pressure = base::Expression(side == "west" ? 1e5 : 0);
      condition.pressure->compile();
    }
    model::Model model(scene, Tpetra::getDefaultComm());
    ASSERT_TRUE(model.step_to(1e9).converged);
    const auto& mesh = model.mesh();
    const auto flux = model.output("fluid flux").values, aperture = model.output("hydraulic aperture").values;
    const Real exact = share_of_film * std::pow(residual, 3) / 12 / scene.flow->viscosity * 1e5 / 4;
    for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) {
      EXPECT_EQ(aperture[f], 0) << cell << f;
      EXPECT_NEAR(flux[3 * f] / exact, 1, 1e-3) << cell << f;
    }
  }
}

/// Faces longer than a third of the process zone cause a warning. Bonds without fracture energy, and permeabilities
/// that a bonded face cannot have, are errors, as are jumps of bonded faces and bonds without shear strength.
TEST(Injection, ImplausibleBondsAreReported) {
  const auto warns = [](const std::string& strength) {
    const auto scene = read_scene("growth/injection_2d.xml", {"Materials.bonded joint.tensile strength=" + strength});
    const auto all = model::Model(scene, Tpetra::getDefaultComm()).warnings();
    return std::any_of(all.begin(), all.end(),
                       [](const auto& one) { return one.find("process zone") != std::string::npos; });
  };
  EXPECT_TRUE(warns("2.4 MPa"));   // 0.56 m, 2.8 faces
  EXPECT_FALSE(warns("2.2 MPa"));  // 0.66 m, 3.3 faces
  for (const std::string entry :
       {"tensile strength=0", "cohesion=0", "residual aperture=0", "normal permeability=1e-15"})
    EXPECT_THROW(read_scene("growth/injection_2d.xml", {"Materials.bonded joint." + entry}), Error) << entry;
  for (const std::string entry : {"plastic jump={1e-3}", "prescribed slip.slip={1e-3*t}"})
    EXPECT_THROW(read_scene("growth/injection_2d.xml", {"Fractures.growing." + entry}), Error) << entry;
}

/// The bond of a face does not follow a change of the entry "unbroken", which a stage therefore refuses.
TEST(Injection, AStageDoesNotChangeTheBondedPart) {
  const auto scene = [](const std::string& unbroken) {
    return read_scene("growth/injection_2d.xml", {"Fractures.growing.unbroken=" + unbroken});
  };
  EXPECT_TRUE(model::refused_changes(scene("x > 1"), scene("x > 1")).empty());
  EXPECT_EQ(model::refused_changes(scene("x > 1"), scene("x > 2")).size(), 1u);
}

/// Warns about a notch that an incompressible fluid fills in impermeable rock.
TEST(Injection, AnIncompressibleFluidInANotchIsReported) {
  const auto warns = [](const std::string& compressibility) {
    const auto all = model::Model(read_scene("growth/injection_2d.xml", {"Flow.compressibility=" + compressibility}),
                                  Tpetra::getDefaultComm())
                         .warnings();
    return std::any_of(all.begin(), all.end(),
                       [](const auto& one) { return one.find("closed notch") != std::string::npos; });
  };
  EXPECT_TRUE(warns("0"));
  EXPECT_FALSE(warns("4.5e-10"));
}

}  // namespace injection
}  // namespace sprekk::tests
