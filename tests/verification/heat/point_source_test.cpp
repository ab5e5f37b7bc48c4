// Point heat source in rock whose fluid drains slowly, compared with the exact solution.
#include "base/over_ranks.hpp"
#include "warm_boxes.hpp"

namespace sprekk::tests {
namespace {

/// Booker and Savvidou (1985): Q = 100 W from t = 0 at the origin of an infinite body. With g = Q/(4 pi k r), a =
/// sqrt(4 kappa t), b = sqrt(4 c t), without advection,
///   T = g erfc(r/a),   p = P g (erfc(r/a) - erfc(r/b)),   P = X/(1 - c/kappa).
/// The displacement has no curl, hence M div u = alpha p + beta T, beta = 3 K alpha_T:
///   u_r = Q/(4 pi k M r^2) ((alpha P + beta) I(a) - alpha P I(b)),
///   I(a) = integral of r erfc(r/a) from 0 to r = r^2/2 erfc(r/a) + a^2/4 erf(r/a) - a r/(2 sqrt(pi)) exp(-r^2/a^2).
namespace source {

constexpr Real Q = 100, k = 2, capacity = 2.4e6, kappa = k / capacity, t = 1e6;
constexpr Real alpha = 0.8, phi = 0.1, K = 20e9, G = 12e9, M = K + 4 * G / 3, beta_s = 3e-5, beta_f = 3e-4;
constexpr Real c_fluid = 1 / 2.2e9, c_pores = (alpha - phi) / 100e9, stored = c_pores + phi * c_fluid;
constexpr Real c = 1e-5, mobility = c * (stored + alpha * alpha / M);
constexpr Real X = (phi * beta_f + (alpha - phi) * beta_s - alpha * K * beta_s / M) / (stored + alpha * alpha / M);
constexpr Real P = X / (1 - c / kappa);

Real T(Real r) { return Q / (4 * M_PI * k * r) * std::erfc(r / std::sqrt(4 * kappa * t)); }
Real p(Real r) { return P * (T(r) - Q / (4 * M_PI * k * r) * std::erfc(r / std::sqrt(4 * c * t))); }
Real u(Real r) {
  const auto I = [&](Real a) {
    return r * r / 2 * std::erfc(r / a) + a * a / 4 * std::erf(r / a) -
           a * r / (2 * std::sqrt(M_PI)) * std::exp(-r * r / a / a);
  };
  return Q / (4 * M_PI * k * M * r * r) *
         ((alpha * P + K * beta_s) * I(std::sqrt(4 * kappa * t)) - alpha * P * I(std::sqrt(4 * c * t)));
}

/// Same solution as expressions of x, y, z, t.
const std::string r = "sqrt(x^2+y^2+z^2)";
std::string width(Real diffusivity) { return fmt::format("sqrt({:.17g}*max(t,1))", 4 * diffusivity); }
std::string falls(Real diffusivity) { return fmt::format("erfc({}/{})", r, width(diffusivity)); }
std::string integral(Real diffusivity) {
  const auto a = width(diffusivity), e = falls(diffusivity);
  return fmt::format("({0}^2/2*{2}+{1}^2/4*(1-{2})-{1}*{0}/(2*sqrt(pi))*exp(-({0}/{1})^2))", r, a, e);
}
const std::string temperature = fmt::format("{:.17g}/{}*{}", Q / (4 * M_PI * k), r, falls(kappa));
const std::string pressure = fmt::format("{:.17g}/{}*({}-{})", P* Q / (4 * M_PI * k), r, falls(kappa), falls(c));
std::string displacement(const std::string& x) {
  return fmt::format("{}/{}^3*({:.17g}*{}-({:.17g})*{})", x, r, Q / (4 * M_PI * k * M) * (alpha * P + K * beta_s),
                     integral(kappa), Q / (4 * M_PI * k * M) * alpha * P, integral(c));
}

}  // namespace source

/// Returns a cube next to the point, with exact values on its sides.
model::Scene beside_the_source(const std::string& cell, int n) {
  auto scene = closed_box(cell, false, n);
  scene.mesh.fractures.clear();
  scene.fractures.clear();
  scene.mesh.lower_corner = {0.8, -0.5, -0.4};
  scene.mesh.upper_corner = {1.8, 0.5, 0.6};
  scene.flow->rigid_rock = false;
  scene.flow->compressibility = source::c_fluid;
  scene.flow->viscosity = 1e-3;
  auto& rock = scene.materials.at("rock");
  rock.K = Expression(source::K);
  rock.G = Expression(source::G);
  rock.biot = source::alpha;
  rock.porosity = source::phi;
  rock.compressibility = source::c_pores;
  rock.permeability = {Expression(1e-3 * source::mobility)};
  rock.thermal_expansion = Expression(source::beta_s / 3);
  warm(scene, 0, source::k, source::capacity, 0);
  scene.heat->fluid_expansion = source::beta_f;
  scene.time.scheme = "BDF2";
  for (const std::string side : {"west", "east", "south", "north", "bottom", "top"}) {
    auto& condition = scene.boundary_conditions[side];
    condition.boundary = side;
    condition.temperature = Expression(source::temperature);
    condition.pressure = Expression(source::pressure);
    for (const std::string x : {"x", "y", "z"}) condition.displacement.emplace_back(source::displacement(x));
  }
  return scene;
}

/// Returns root mean square errors relative to the exact values: T and p over cells, u over nodes. Collective.
std::array<Real, 3> errors(model::Model& model) {
  const auto& mesh = model.mesh();
  std::vector<Real> sums(6, 0);
  const auto add = [&](int k, Real off, Real exact) {
    sums[k] += off * off;
    sums[3 + k] += exact * exact;
  };
  const auto T = model.output("temperature").values, p = model.output("pressure").values,
             u = model.output("displacement").values;
  for (LocalIndex e = 0; e < mesh.n_owned_cells; ++e) {
    const Real r = norm(mesh::cell_centre(mesh, e));
    add(0, T[e] - source::T(r), source::T(r));
    add(1, p[e] - source::p(r), source::p(r));
  }
  for (LocalIndex node = 0; node < mesh.n_owned_nodes; ++node) {
    const Real* x = &mesh.coordinates[3 * node];
    const Real r = norm({x[0], x[1], x[2]}), exact = source::u(r);
    for (int i = 0; i < 3; ++i) add(2, u[3 * node + i] - exact * x[i] / r, exact * x[i] / r);
  }
  sums = base::sum_over_ranks(*mesh.comm, sums);
  std::array<Real, 3> found{};
  for (int k = 0; k < 3; ++k) found[k] = std::sqrt(sums[k] / sums[3 + k]);
  return found;
}

TEST(ThermoPoroelasticity, APointGivesOffHeat) {
  EXPECT_NEAR(source::X, 536315.259600, 1e-6);
  EXPECT_NEAR(source::T(1), 1.745046520, 1e-9);
  EXPECT_NEAR(source::p(1), 74587.712840, 1e-4);
  EXPECT_NEAR(source::p(2), 51736.720566, 1e-4);
  EXPECT_NEAR(source::p(5), 10221.332340, 1e-4);
  EXPECT_NEAR(source::u(1), 2.084839315e-5, 1e-14);
  EXPECT_NEAR(source::u(2), 1.195531283e-5, 1e-14);
  for (const std::string cell : {"hexahedron", "tetrahedron"}) {
    std::vector<std::array<Real, 3>> found;
    for (const int n : {4, 8}) {
      model::Model model(beside_the_source(cell, n), Tpetra::getDefaultComm());
      const int steps = 2 * n;
      for (int k = 1; k <= steps; ++k) ASSERT_TRUE(model.step_to(source::t * k / steps).converged) << cell << n << k;
      found.push_back(errors(model));
    }
    const char* const names[] = {"temperature", "pressure", "displacement"};
    for (int k = 0; k < 3; ++k) {
      EXPECT_LT(found[1][k], 0.005) << cell << " " << names[k];
      EXPECT_GT(std::log2(found[0][k] / found[1][k]), 1.4)
          << cell << " " << names[k] << ": " << found[0][k] << ", " << found[1][k];
    }
  }
}

}  // namespace
}  // namespace sprekk::tests
