// Materials, loads and conditions that depend on position, compared with exact states.
#include "verification/loads/block.hpp"

namespace sprekk::tests {
namespace {

/// Layer of a column under its weight, on a floor, Poisson's ratio 0: u = -integral from 0 to z of W(s)/E(s) ds, with
/// the weight W above s. Each layer has constant modulus and density, so displacements are quadratic in a layer.
struct Layer {
  Real top, modulus, density;
};

Real settlement(const std::vector<Layer>& layers, Real gravity, Real z) {
  Real u = 0, bottom = 0, weight = 0;
  for (const auto& layer : layers) {
    weight += layer.density * gravity * (layer.top - bottom);
    bottom = layer.top;
  }
  bottom = 0;
  for (const auto& layer : layers) {
    const Real h = std::clamp(z - bottom, 0.0, layer.top - bottom);
    u -= (weight * h - layer.density * gravity * h * h / 2) / layer.modulus;
    weight -= layer.density * gravity * (layer.top - bottom);
    bottom = layer.top;
  }
  return u;
}

void expect_column(const Discretisation& cells, int dim, int n_layers, const std::string& modulus,
                   const std::string& density, const std::vector<Layer>& layers) {
  SCOPED_TRACE(cells.name());
  std::vector<Real> size(dim, 1);
  std::vector<int> n(dim - 1, 2);
  size.back() = 3;
  n.push_back(n_layers);
  const std::string up = dim == 2 ? "y" : "z";
  const auto along = [&](std::string text) {
    for (auto& c : text)
      if (c == 'h') c = up[0];
    return expression(text);
  };
  auto scene = box_of_rock(cells, size, n, "1");
  scene.materials["rock"].E = along(modulus);
  scene.materials["rock"].density = along(density);
  scene.bulk.gravity.assign(dim, 0);
  scene.bulk.gravity.back() = -10;
  prescribe(scene, dim == 2 ? "south" : "bottom", std::vector<std::string>(dim, "0"));
  model::Model model(scene, Tpetra::getDefaultComm());
  const Real largest = std::abs(settlement(layers, 10, 3));
  expect_displacement(model, 1e-10 * largest, [&](const Vector3& x, const std::string&) {
    Vector3 u{};
    u[dim - 1] = settlement(layers, 10, x[dim - 1]);
    return u;
  });
}

TEST(Column, LayersUnderGravity) {
  const std::vector<Layer> layers{{1, 2e6, 3000}, {2, 1e6, 2000}, {3, 4e6, 1000}};
  for (int dim : {2, 3})
    for (const auto& cell : cells_of(dim))
      expect_column({cell, 2}, dim, 3, "1e6*(h < 1 ? 2 : h < 2 ? 1 : 4)", "h < 1 ? 3000 : h < 2 ? 2000 : 1000", layers);
}

/// Cells of order 1 in horizontal layers give exact nodal values; the material is evaluated at the centres of cells.
TEST(Column, GradedUnderGravity) {
  const auto modulus = [](Real h) { return 1e6 * (1 + h * h); };
  const auto density = [](Real h) { return 2000 - 300 * h; };
  std::vector<Layer> layers;
  for (int k = 0; k < 6; ++k) layers.push_back({(k + 1) / 2.0, modulus(k / 2.0 + 0.25), density(k / 2.0 + 0.25)});
  for (int dim : {2, 3})
    for (int order : {1, 2})
      expect_column({dim == 2 ? "quadrilateral" : "hexahedron", order}, dim, 6, "1e6*(1 + h^2)", "2000 - 300*h",
                    layers);
}

/// Two rocks on both sides of a fracture y = 1/2 without friction, under compression. Each has its own traction in x.
TEST(Regions, EachHasItsOwnTraction) {
  const Real E[] = {2e6, 1e6}, pull[] = {3e3, -1e3}, push = 1e-3, pressure = push / (0.5 / E[0] + 0.5 / E[1]);
  for (int dim : {2, 3})
    for (const auto& cells : discretisations(dim)) {
      SCOPED_TRACE(cells.name());
      auto scene = box_of_rock(cells, first<Real>(dim, {2, 1, 1}), first<int>(dim, {4, 2, 2}), "1e6");
      scene.materials["hard rock"] = scene.materials["rock"];
      scene.materials["hard rock"].E = base::Expression(2e6);
      scene.mesh.regions["lower"] = {first<Real>(dim, {0, 0, 0}), first<Real>(dim, {2, 0.5, 1})};
      scene.regions["lower"].material = "hard rock";
      scene.mesh.fractures["f"] = {first<Real>(dim, {0, 0.5, 0}), first<Real>(dim, {2, 0.5, 1}),
                                   first<Real>(dim, {0, 1, 0}), false};
      auto& joint = scene.materials["joint"];
      joint.type = "joint";
      joint.friction_coefficient = base::Expression(0);
      scene.fractures["f"].material = "joint";
      prescribe(scene, "west", first<std::string>(dim, {"0", "free", "free"}), "lower");
      prescribe(scene, "west", first<std::string>(dim, {"1e-4", "free", "free"}), "bulk");
      prescribe(scene, "south", first<std::string>(dim, {"free", "0", "free"}));
      prescribe(scene, "north", first<std::string>(dim, {"free", fmt::format("-{:.17g}", push), "free"}));
      if (dim == 3) prescribe(scene, "bottom", {"free", "free", "0"});
      load(scene, "east", first<std::string>(dim, {fmt::format("{:.17g}", pull[0]), "0", "0"}), "lower");
      load(scene, "east", first<std::string>(dim, {fmt::format("{:.17g}", pull[1]), "0", "0"}), "bulk");
      model::Model model(scene, Tpetra::getDefaultComm());
      expect_displacement(model, 1e-13, [&](const Vector3& x, const std::string& region) {
        const int r = region == "lower" ? 0 : 1;
        const Real below = pressure * std::min(x[1], 0.5) / E[0], above = pressure * std::max(x[1] - 0.5, 0.0) / E[1];
        return Vector3{pull[r] * x[0] / E[r] + (r == 1 ? 1e-4 : 0), -below - above, 0};
      });
      const Outputs out(model);
      for (LocalIndex f = 0; f < model.mesh().n_owned_fracture_faces; ++f) {
        const Real slip = 1e-4 + (pull[1] / E[1] - pull[0] / E[0]) * model.mesh().fracture_faces[f].centre[0];
        const auto traction = out.vector("traction", f), jump = out.vector("jump", f);
        EXPECT_NEAR(jump[0], slip, 1e-13);
        EXPECT_NEAR(out.scalar("slip", f), std::abs(slip), 1e-13);
        EXPECT_NEAR(traction[1], -pressure, 1e-9 * pressure);
        EXPECT_NEAR(norm({traction[0], 0, traction[2]}), 0, 1e-9 * pressure);
      }
    }
}

/// A joint with stiffness K_t = tau/(a + b x) under uniform shear traction tau has the elastic jump a + b x, which
/// stretches the upper rock by b. The upper rock is supported by the joint only; its other sides have prescribed
/// tractions.
TEST(Joint, StiffnessVariesUnderUniformTraction) {
  const Real tau = 200, pressure = 1000, E = 1e6, a = 2e-4, b = 3e-4;
  const auto number = [](Real x) { return fmt::format("({:.17g})", x); };
  for (int dim : {2, 3})
    for (const auto& cells : discretisations(dim)) {
      SCOPED_TRACE(cells.name());
      auto scene = box_of_rock(cells, first<Real>(dim, {1, 1, 1}), first<int>(dim, {4, 2, 2}), number(E));
      scene.mesh.regions["lower"] = {first<Real>(dim, {0, 0, 0}), first<Real>(dim, {1, 0.5, 1})};
      scene.mesh.fractures["f"] = {first<Real>(dim, {0, 0.5, 0}), first<Real>(dim, {1, 0.5, 1}),
                                   first<Real>(dim, {0, 1, 0}), false};
      auto& joint = scene.materials["joint"];
      joint.type = "joint";
      joint.friction_coefficient = expression("0.5 + 0.1*x");
      joint.tangential_stiffness = expression(number(tau) + "/(" + number(a) + "+" + number(b) + "*x)");
      scene.fractures["f"].material = "joint";
      const std::string shear = number(2 * tau / E) + "*y", shorten = "-" + number(pressure / E) + "*y";
      prescribe(scene, "south", first<std::string>(dim, {shear, shorten, "0"}));
      prescribe(scene, "west", first<std::string>(dim, {shear, shorten, "free"}), "lower");
      if (dim == 3) prescribe(scene, "bottom", {"free", "free", "0"});
      load(scene, "north", first<std::string>(dim, {number(tau), number(-pressure), "0"}));
      load(scene, "west", first<std::string>(dim, {number(-E * b), number(-tau), "0"}), "bulk");
      load(scene, "east", first<std::string>(dim, {"0", number(tau), "0"}), "lower");
      load(scene, "east", first<std::string>(dim, {number(E * b), number(tau), "0"}), "bulk");
      model::Model model(scene, Tpetra::getDefaultComm());
      expect_displacement(model, 1e-12, [&](const Vector3& x, const std::string& region) {
        return Vector3{2 * tau / E * x[1] + (region == "bulk" ? a + b * x[0] : 0), -pressure / E * x[1], 0};
      });
      const Outputs out(model);
      for (LocalIndex f = 0; f < model.mesh().n_owned_fracture_faces; ++f) {
        const auto elastic = out.vector("elastic jump", f), traction = out.vector("traction", f);
        EXPECT_NEAR(elastic[0], a + b * model.mesh().fracture_faces[f].centre[0], 1e-12);
        EXPECT_NEAR(traction[0], tau, 1e-8 * pressure);
        EXPECT_NEAR(traction[1], -pressure, 1e-8 * pressure);
        EXPECT_EQ(out.scalar("state", f), 1);
      }
    }
}

}  // namespace
}  // namespace sprekk::tests
