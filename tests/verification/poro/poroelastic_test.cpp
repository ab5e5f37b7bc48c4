// Poroelastic rock and fractures, compared with exact solutions.
#include "../flow/boxes.hpp"

namespace sprekk::tests {
namespace {

constexpr Real G = 3, lambda = 2, biot = 0.7, growth = 0.4;

/// Returns the deformable box of the suites of flow with crossing fractures; with `tips`, with one fracture that ends
/// inside instead. The sides west, south and bottom have no normal displacement.
model::Scene deforming_box(const std::string& cell, bool tips = false) {
  auto scene = closed_box(cell);
  const bool flat = is_flat(cell);
  if (tips) {
    scene.mesh.fractures["a"].upper_corner[0] = 0.75;
    scene.mesh.fractures.erase("b");
    scene.fractures.erase("b");
  }
  scene.flow->rigid_rock = false;
  auto& rock = scene.materials.at("rock");
  rock.G = base::Expression(G);
  rock.lambda = base::Expression(lambda);
  rock.biot = biot;
  rock.compressibility = growth;
  auto& joint = scene.materials.at("joint");
  joint.friction_coefficient = base::Expression(0.6);
  joint.tangential_stiffness = base::Expression(10);
  const std::vector<std::string> sides = {"west", "south", "bottom"};
  for (int axis = 0; axis < (flat ? 2 : 3); ++axis) {
    auto& condition = scene.boundary_conditions[sides[axis] + " held"];
    condition.boundary = sides[axis];
    condition.displacement.assign(flat ? 2 : 3, base::Expression("free"));
    condition.displacement[axis] = base::Expression(0);
  }
  return scene;
}

/// Adds a pressure load on the sides east, north and top.
void press(model::Scene& scene, Real pressure) {
  const int dim = static_cast<int>(scene.mesh.lower_corner.size());
  const std::vector<std::string> sides = {"east", "north", "top"};
  for (int axis = 0; axis < dim; ++axis) {
    auto& condition = scene.boundary_conditions[sides[axis] + " pressed"];
    condition.boundary = sides[axis];
    condition.traction.assign(dim, base::Expression(0));
    condition.traction[axis] = base::Expression(-pressure);
  }
}

/// Checks strain, pressure and the traction on fractures of a state without gradients.
void expect_uniform(model::Model& model, Real strain, Real p, Real traction, Real tolerance) {
  const int dim = model.mesh().dim();
  const auto u = model.output("displacement");
  for (LocalIndex node = 0; node < model.mesh().n_nodes(); ++node)
    for (int i = 0; i < dim; ++i)
      EXPECT_NEAR(u.values[node * dim + i], strain * model.mesh().coordinates[node * dim + i], tolerance);
  const auto pressure = [&](const auto&, const auto&) { return Vector3{p}; };
  EXPECT_LT(error(model, "pressure", pressure), tolerance);
  EXPECT_LT(error(model, "fracture pressure", pressure), tolerance);
  EXPECT_LT(error(model, "traction local", [&](const auto&, const auto&) { return Vector3{traction}; }), tolerance);
}

/// Drained box under an all-round load P_0, with the pressure P on all sides. The strain follows from the effective
/// stress -P_0 + alpha P; the sides of fractures are in contact with the pressure P_0 - P.
TEST(Poroelasticity, ADrainedBoxFollowsTheEffectiveStress) {
  for (const std::string cell : all_cells)
    for (const bool tips : {false, true})
      for (const int order : {1, 2}) {
        SCOPED_TRACE(fmt::format("{}, {}, order {}", cell, tips ? "tips" : "crossing", order));
        auto scene = deforming_box(cell, tips);
        scene.mesh.order = order;
        const int dim = is_flat(cell) ? 2 : 3;
        press(scene, 3);
        for (const std::string side : {"west", "east", "south", "north", "bottom", "top"})
          if (dim == 3 || (side != "bottom" && side != "top")) constrain(scene, side, "1");
        model::Model model(scene, Tpetra::getDefaultComm());
        ASSERT_TRUE(model.step_to(1e9).converged);
        expect_uniform(model, (-3 + biot) / (2 * G + dim * lambda), 1, -2, 1e-8);
      }
}

/// Porosity and Biot's coefficient by expressions of the coordinates equal those by regions.
TEST(Poroelasticity, PropertiesMayDependOnThePlace) {
  for (const std::string cell : {"quadrilateral", "tetrahedron"}) {
    std::vector<std::vector<Real>> found;
    for (const bool by_regions : {false, true}) {
      auto scene = deforming_box(cell, true);
      press(scene, 3);
      constrain(scene, "west", "1");
      scene.flow->compressibility = 0.3;
      auto& rock = scene.materials.at("rock");
      rock.porosity = by_regions ? base::Expression(0.1) : base::Expression("x < 0.5 ? 0.1 : 0.4");
      rock.biot = by_regions ? base::Expression(0.5) : base::Expression("x < 0.5 ? 0.5 : 0.9");
      if (by_regions) {
        auto upper = scene.mesh.upper_corner, lower = scene.mesh.lower_corner;
        lower[0] = 0.5;
        scene.mesh.regions["east"] = {lower, upper};
        scene.materials["porous"] = rock;
        scene.materials["porous"].porosity = 0.4;
        scene.materials["porous"].biot = 0.9;
        scene.regions["east"].material = "porous";
      }
      model::Model model(scene, Tpetra::getDefaultComm());
      for (const Real t : {0.01, 0.03}) ASSERT_TRUE(model.step_to(t).converged) << cell;
      found.push_back(model.output("pressure").values);
    }
    for (std::size_t c = 0; c < found[0].size(); ++c) EXPECT_NEAR(found[0][c], found[1][c], 1e-11) << cell;
  }
}

/// In a closed box the fluid has the pressure of Skempton, p = P_0 alpha M/(K + alpha^2 M), with the storage 1/M at
/// constant strain. With constant time steps, or with a very short first step.
TEST(Poroelasticity, AClosedBoxIsUndrained) {
  for (const std::string cell : all_cells)
    for (const Real first : {1e-9, 1e3}) {
      SCOPED_TRACE(fmt::format("{}, {} s", cell, first));
      auto scene = deforming_box(cell, true);
      const int dim = is_flat(cell) ? 2 : 3;
      press(scene, 3);
      model::Model model(scene, Tpetra::getDefaultComm());
      if (first < 1) {
        ASSERT_TRUE(model.step_to(first).converged);
      }
      ASSERT_TRUE(model.step_to(1e3).converged);
      const Real K = lambda + 2 * G / dim, p = 3 * biot / growth / (K + biot * biot / growth);
      expect_uniform(model, (-3 + biot * p) / (2 * G + dim * lambda), p, -3 + p, 1e-8);
    }
}

/// 1/M = porosity c + growth of pores: the results are equal if M or the growth is given, with and without
/// compressibility and growth.
TEST(Poroelasticity, BiotModulusIsStorageAtConstantStrain) {
  for (const std::string cell : all_cells)
    for (const Real c : {0.0, 0.3})
      for (const Real grows : {growth, 0.0}) {
        if (c + grows == 0) continue;
        SCOPED_TRACE(fmt::format("{}, c = {}, growth = {}", cell, c, grows));
        std::vector<std::vector<Real>> found;
        for (const bool modulus : {false, true}) {
          auto scene = deforming_box(cell, true);
          press(scene, 3);
          constrain(scene, "west", "1");
          scene.flow->compressibility = c;
          auto& rock = scene.materials.at("rock");
          rock.porosity = 0.2;
          rock.compressibility.reset();
          if (modulus)
            rock.biot_modulus = 1 / (0.2 * c + grows);
          else
            rock.compressibility = grows;
          model::Model model(scene, Tpetra::getDefaultComm());
          for (const Real t : {0.01, 0.03}) ASSERT_TRUE(model.step_to(t).converged);
          const auto steady = [](const auto&, const auto&) { return Vector3{1}; };
          EXPECT_GT(error(model, "pressure", steady), 1e-3);
          found.push_back(model.output("pressure").values);
        }
        for (std::size_t cell = 0; cell < found[0].size(); ++cell) EXPECT_NEAR(found[1][cell], found[0][cell], 1e-9);
      }
}

/// Under gravity, with total stress and hydrostatic pressure in equilibrium at the start, nothing moves. Fractures
/// that cross or end inside have the effective contact pressure.
TEST(Poroelasticity, WhatIsInBalanceAtTheStartStaysAtRest) {
  for (const std::string cell : all_cells)
    for (const bool tips : {false, true}) {
      SCOPED_TRACE(fmt::format("{}, {}", cell, tips ? "tips" : "crossing"));
      auto scene = deforming_box(cell, tips);
      const int dim = is_flat(cell) ? 2 : 3;
      const std::string up = dim == 2 ? "y" : "z", along = fmt::format("1.5*({}-3)", up),
                        down = fmt::format("2*({}-3)", up);
      scene.bulk.gravity.assign(dim, 0);
      scene.bulk.gravity.back() = -1;
      scene.materials.at("rock").density = base::Expression(2);
      scene.flow->density = 1;
      scene.flow->initial_pressure = base::Expression("2-" + up);
      const auto zero = base::Expression(0), x = base::Expression(along), z = base::Expression(down);
      scene.bulk.initial_stress = dim == 2 ? std::vector{x, z, x, zero} : std::vector{x, x, z, zero, zero, zero};
      auto& joint = scene.materials.at("joint");
      joint.maximum_closure = base::Expression(0.1);
      joint.normal_stiffness = base::Expression(20);
      joint.initial_aperture = base::Expression(0.2);
      for (const std::string side : {"west", "east", "south", "north", "bottom", "top"}) {
        if (dim == 2 && (side == "bottom" || side == "top")) continue;
        constrain(scene, side, "2-" + up);
        scene.boundary_conditions[side].displacement.assign(dim, base::Expression(0));
      }
      for (const char* constrained : {"west held", "south held", "bottom held"})
        scene.boundary_conditions.erase(constrained);
      model::Model model(scene, Tpetra::getDefaultComm());
      for (const Real t : {1e-3, 1.0}) ASSERT_TRUE(model.step_to(t).converged);
      const auto pressure = [&](const Vector3& at, const auto&) { return Vector3{2 - at[dim - 1]}; };
      const auto still = [](const auto&, const auto&) { return Vector3{}; };
      EXPECT_LT(error(model, "pressure", pressure), 1e-9);
      EXPECT_LT(error(model, "fracture pressure", pressure), 1e-9);
      EXPECT_LT(error(model, "displacement", still), 1e-9);
      const auto traction = [&](const Vector3& at, const Vector3& normal) {
        const Real level = std::abs(normal[dim - 1]) > 0.5;
        return Vector3{(1.5 + 0.5 * level) * (at[dim - 1] - 3) + 2 - at[dim - 1]};
      };
      EXPECT_LT(error(model, "traction local", traction), 1e-8);
      const auto closure = model.output("aperture");
      for (LocalIndex f = 0; f < model.mesh().n_owned_fracture_faces; ++f) {
        const Real pressed =
            traction(model.mesh().fracture_faces[f].centre, model.mesh().fracture_faces[f].frame[0])[0];
        EXPECT_NEAR(closure.values[f], 0.2 + 0.1 * pressed / (0.1 * 20 - pressed), 1e-9);
      }
    }
}

/// The volume injected into a fracture of a closed box equals the change in pores and apertures. Cases: constant and
/// pressure-dependent density; the fracture opens.
TEST(Poroelasticity, NoFluidIsLost) {
  for (const std::string cell : all_cells)
    for (const Real compressibility : {0.0, 0.05}) {
      SCOPED_TRACE(fmt::format("{}, compressibility {}", cell, compressibility));
      auto scene = deforming_box(cell, true);
      const int dim = is_flat(cell) ? 2 : 3;
      scene.flow->compressibility = compressibility;
      scene.fractures.at("a").source = base::Expression(0.2);
      press(scene, 0.2);
      model::Model model(scene, Tpetra::getDefaultComm());
      for (const Real t : {0.1, 0.5, 1.0}) ASSERT_TRUE(model.step_to(t).converged);
      const auto& mesh = model.mesh();
      Real here = 0, all = 0;
      const auto pressure = model.output("pressure"), inside = model.output("fracture pressure"),
                 opening = model.output("opening");
      // Sum over cells and facets; stabilisation fluxes between them cancel.
      for (const char* what : {"volume", "exchange"}) {
        const auto saved = model.field(std::string("poroelastic coupling: ") + what).values;
        const auto content = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), saved);
        for (std::size_t k = 0; k < content.extent(0); ++k) here += content(k, 0);
      }
      mesh::for_shape(mesh.shape, [&](auto shape) {
        for (LocalIndex c = 0; c < mesh.n_owned_cells; ++c) {
          const Real p = pressure.values[c];
          assembly::for_each_cell_point<shape()>(mesh, c, [&](const auto&, Real volume, const auto&) {
            here += volume * growth * p * std::exp(compressibility * p);
          });
        }
      });
      Real wider = 0;
      for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) {
        const Real denser = std::exp(compressibility * inside.values[f]);
        here += mesh.fracture_faces[f].area * ((aperture + opening.values[f]) * denser - aperture);
        wider += opening.values[f];
      }
      Teuchos::reduceAll(*mesh.comm, Teuchos::REDUCE_SUM, 1, &here, &all);
      EXPECT_NEAR(all, 0.2 * 0.75, 1e-10);
      Real opened = 0;
      Teuchos::reduceAll(*mesh.comm, Teuchos::REDUCE_SUM, 1, &wider, &opened);
      EXPECT_GT(opened, 1e-3) << "it is to open, else this says little (dim " << dim << ")";
    }
}

/// The rounding level of a residual refers to the state at the beginning of a step, not to the end of a failed
/// attempt. Such an attempt may have extreme pressures and densities, so that every residual would count as round-off.
TEST(Poroelasticity, AFailedAttemptDoesNotHideTheResidual) {
  auto scene = deforming_box("triangle", true);
  scene.flow->compressibility = 1;
  scene.flow->initial_pressure = base::Expression(1);
  scene.fractures.at("a").source = base::Expression(0.2);
  press(scene, 0.2);
  model::Model model(scene, Tpetra::getDefaultComm());
  auto& system = model.system();
  const auto& x = model.state();
  auto r = fields::create_like(x), far = fields::create_like(x);
  const auto largest = [&] {
    system.set_time(0.1, 0.1);
    system.residual(x, r);
    Real value = 0;
    for (const auto& measure : system.measures(x, r))
      if (measure.name == "face pressure") value = std::max(value, measure.value);
    return value;
  };
  EXPECT_GT(largest(), 1e-3);
  system.jacobian(x);
  for (std::size_t b = 0; b < far.size(); ++b) far[b]->update(50, *x[b], 0);
  system.jacobian(far);
  // Diagonals of the far state do not change the upper limit of a row's scale.
  for (std::size_t b = 0; b < r.size(); ++b)
    if (const auto& block = system.blocks()[b]; block.name == "face pressure")
      EXPECT_GE(largest(), (1 - 1e-9) * r[b]->normInf() / block.residual_scale);
}

/// A box with incompressible fluid is loaded in one short step: the inflow is the volume change, including the large
/// stabilisation flux. After take_back(), the rates of the rejected step are not used.
TEST(Poroelasticity, InflowsAreThoseOfTheStep) {
  for (const std::string cell : {"triangle", "hexahedron"}) {
    SCOPED_TRACE(cell);
    auto scene = deforming_box(cell, true);
    press(scene, 3);
    constrain(scene, "west", "0");
    constrain(scene, "east", "0");
    model::Model model(scene, Tpetra::getDefaultComm());
    auto& system = model.system();
    const auto inflow = [&](bool of_step) {
      Real sum = 0;
      for (const auto& one : of_step ? system.reactions_of_step(model.state()) : system.reactions(model.state()))
        if (one.called.name == "inflows") sum += one.force[0];
      return sum;
    };
    ASSERT_TRUE(model.step_to(1e-3).converged);
    const Real of_step = inflow(true), without_storage = inflow(false);
    EXPECT_GT(std::abs(of_step - without_storage), 1e-3 * std::abs(of_step));
    ASSERT_TRUE(model.step_to(2e-3).converged);
    model.take_back();
    EXPECT_NEAR(inflow(true), inflow(false), 1e-12 * std::abs(of_step));
  }
}

/// A prescribed pressure in all rock deforms the rock like a computed one. Under the load P on all sides, the strain
/// is that of the effective stress alpha p - P, and fractures have the traction p - P.
TEST(Poroelasticity, PressureOfARegion) {
  const Real P = 2, p = 1.2;
  for (const std::string cell : all_cells) {
    SCOPED_TRACE(cell);
    auto scene = deforming_box(cell);
    scene.regions["bulk"].pressure = base::Expression(p);
    press(scene, P);
    model::Model model(scene, Tpetra::getDefaultComm());
    ASSERT_TRUE(model.step_to(1).converged);
    const int dim = model.mesh().dim();
    expect_uniform(model, (biot * p - P) / (2 * G + dim * lambda), p, p - P, 1e-11);
  }
}

}  // namespace
}  // namespace sprekk::tests
