// Error estimates of stress and jump, compared with known errors.
#include "assembly/geometry.hpp"
#include "base/over_ranks.hpp"
#include "model/error_estimates.hpp"
#include "model/results.hpp"
#include "verification/scenes.hpp"

#include <Teuchos_DefaultMpiComm.hpp>

namespace sprekk::tests {
namespace {

using Function = std::function<Vector3(const Vector3& x, bool above)>;

struct Errors {
  estimate::StateError stress;
  estimate::OutputError jump;
  std::vector<assembly::OutputField> fields;
  nlohmann::json summary;
};

Errors estimate_of(model::Model& model) {
  auto estimator = model::make_error_estimator(model, 0);
  const auto outputs = Outputs(model).all();
  const auto all = estimator(model::present_state(model, outputs));
  return {all.norms.at(0), all.of_outputs[0].value_or(estimate::OutputError{}), all.fields,
          model::summary(estimator, all)};
}

/// Returns s : C^-1 s of rock with the constants of `law`.
template <int dim>
Real energy(const laws::Elasticity& law, const Real (&s)[dim][dim]) {
  Real trace = 0, square = 0;
  for (int i = 0; i < dim; ++i) trace += s[i][i];
  for (const auto& row : s)
    for (const Real component : row) square += component * component;
  return (square - law.lambda / (dim * law.lambda + 2 * law.G) * trace * trace) / (2 * law.G);
}

/// Returns the energy norm of the stress error of a model, for uniform rock. The exact stress is from central
/// differences of the displacement u on both sides of y (z) = middle. Collective.
Real stress_error(model::Model& model, const Function& u, Real middle) {
  const auto& mesh = model.mesh();
  const Outputs out(model);
  const auto& values = out["displacement"].values;
  const auto law = model.scene().materials.at("rock").elasticity({});
  Real square = 0;
  mesh::for_shape(mesh.shape, [&](auto s) {
    constexpr auto shape = s();
    constexpr int dim = mesh::dimension(shape), n = mesh::n_nodes(shape);
    for (LocalIndex c = 0; c < mesh.n_owned_cells; ++c) {
      Real X[n][dim], dN[n][dim], g[dim], sigma[dim][dim], centre = 0;
      assembly::gather_host<shape>(mesh, c, X);
      for (const auto& node : X) centre += node[dim - 1] / n;
      assembly::for_each_cell_point<shape>(mesh, c, [&](const Real(&xi)[dim], Real volume, const Vector3& x) {
        Real H[dim][dim] = {};
        assembly::ReferenceCell<shape>::gradients(xi, dN);
        const assembly::CellPoint<shape> point(X, dN);
        for (int a = 0; a < n; ++a) {
          point.gradient(dN[a], g);
          for (int i = 0; i < dim; ++i)
            for (int j = 0; j < dim; ++j) H[i][j] += values[mesh.cells[c * n + a] * dim + i] * g[j];
        }
        for (int j = 0; j < dim; ++j) {
          Vector3 ahead = x, behind = x;
          ahead[j] += 1e-6;
          behind[j] -= 1e-6;
          const auto difference = tests::difference(u(ahead, centre > middle), u(behind, centre > middle));
          for (int i = 0; i < dim; ++i) H[i][j] -= difference[i] / 2e-6;
        }
        law.stress(H, sigma);
        square += volume * energy(law, sigma);
      });
    }
  });
  return std::sqrt(base::sum_over_ranks(*mesh.comm, square));
}

/// Returns the norm of the error of the mean jumps of faces. Collective.
Real jump_error(model::Model& model, const Function& u) {
  const auto& mesh = model.mesh();
  const Outputs out(model);
  Real square = 0;
  mesh::for_shape(mesh.shape, [&](auto s) {
    for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) {
      const auto& face = mesh.fracture_faces[f];
      Vector3 error = out.vector("jump", f);
      assembly::for_each_face_point(mesh, face.cell[mesh::minus], face.local_face[mesh::minus],
                                    [&](const auto&, Real area, const Vector3& x) {
                                      const auto jump = difference(u(x, true), u(x, false));
                                      for (int i = 0; i < 3; ++i) error[i] -= area / face.area * jump[i];
                                    });
      square += face.area * dot(error, error);
    }
  });
  return std::sqrt(base::sum_over_ranks(*mesh.comm, square));
}

/// Returns the exact displacement that a manufactured scene prescribes on the boundaries of its regions "below" and
/// "above".
Function manufactured(const model::Scene& scene) {
  const auto* sides = &scene.boundary_conditions;
  return [sides](const Vector3& x, bool above) {
    const auto& value = sides->at(above ? "above west" : "below west").displacement;
    Vector3 u{};
    for (std::size_t i = 0; i < value.size(); ++i) u[i] = value[i](x, 1);
    return u;
  };
}

void expect_between(Real ratio, Real minimum, Real maximum, const char* what) {
  EXPECT_GE(ratio, minimum) << what;
  EXPECT_LE(ratio, maximum) << what;
  if (Tpetra::getDefaultComm()->getRank() == 0) fmt::print("  {} {:.2f}", what, ratio);
}

/// Smooth solutions: estimates of both errors within a factor of two, except on the coarsest meshes.
TEST(ErrorEstimate, ManufacturedSolutions) {
  for (const int dim : {2, 3})
    for (const std::string regime : {"stick", "slip", "mixed"})
      for (const auto& d : discretisations(dim)) {
        const int n = dim == 2 ? 16 : d.order == 1 ? 8 : d.cell == "hexahedron" ? 6 : 4;
        if (dim == 3 && regime != "mixed" && (regime != "slip" || d.order == 2)) continue;
        SCOPED_TRACE(regime + " " + d.name());
        const auto cells =
            dim == 2 ? fmt::format("Mesh.cells={{{0}, {0}}}", n) : fmt::format("Mesh.cells={{{0}, {0}, {0}}}", n);
        model::Model model(
            read_scene(fmt::format("verification/manufactured_{}_{}d.xml", regime, dim), d.with({cells})),
            Tpetra::getDefaultComm());
        ASSERT_TRUE(model.step_to(1).converged);
        const auto u = manufactured(model.scene());
        const auto e = estimate_of(model);
        expect_between(e.stress.error / stress_error(model, u, 0.5), 0.5, 2, "stress");
        expect_between(e.jump.norm / jump_error(model, u), 0.5, 2, "jump");
        if (Tpetra::getDefaultComm()->getRank() == 0) fmt::print("  {} {}\n", regime, d.name());
      }
}

/// Cracks whose error is dominated by the tips. For plain tips the estimate has no tip modes and may be slightly below
/// half of the error. The jump is 2 (1 - nu) s/G sqrt(1 - x^2) along x (mode II) or y (mode I).
TEST(ErrorEstimate, Cracks) {
  for (const std::string name : {"sneddon", "sneddon_shear"})
    for (const auto& [order, tips] : {std::pair{1, "plain"}, {1, "enriched"}, {2, "plain"}, {2, "enriched"}}) {
      SCOPED_TRACE(fmt::format("{} of order {}, {} tips", name, order, tips));
      model::Model model(read_scene("verification/" + name + ".xml",
                                    {fmt::format("Mesh file.order={}", order), fmt::format("Mesh file.tips={}", tips)}),
                         Tpetra::getDefaultComm());
      ASSERT_TRUE(model.step_to(1).converged);
      const int component = name == "sneddon" ? 1 : 0;
      const Real factor = 2 * (1 - 0.25) * 1e-3;
      const auto primitive = [](Real x) { return (x * std::sqrt(std::max(1 - x * x, 0.0)) + std::asin(x)) / 2; };
      const auto& mesh = model.mesh();
      const Outputs out(model);
      Real square = 0;
      for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) {
        const auto& face = mesh.fracture_faces[f];
        const Real a = std::max(face.centre[0] - face.area / 2, -1.0),
                   b = std::min(face.centre[0] + face.area / 2, 1.0);
        Vector3 error = out.vector("jump", f);
        error[component] -= factor * (primitive(b) - primitive(a)) / face.area;
        square += face.area * dot(error, error);
      }
      const auto e = estimate_of(model);
      const Real minimum = tips == std::string("plain") ? 0.4 : 0.5;
      expect_between(e.jump.norm / std::sqrt(base::sum_over_ranks(*mesh.comm, square)), minimum, 2, "jump");
      if (mesh.comm->getRank() == 0) fmt::print("  {} of order {}, {} tips\n", name, order, tips);
      // the error is largest in cells at the tips
      const auto& density = e.fields[0].values;
      const Real largest = *std::max_element(density.begin(), density.end());
      Real global = 0;
      Teuchos::reduceAll(*mesh.comm, Teuchos::REDUCE_MAX, 1, &largest, &global);
      for (LocalIndex c = 0; c < mesh.n_owned_cells; ++c) {
        if (density[c] != global) continue;
        Real nearest = 10;
        for (int k = 0; k < mesh.nodes_per_cell(); ++k) {
          const Real* x = &mesh.coordinates[mesh.cells[c * mesh.nodes_per_cell() + k] * 2];
          nearest = std::min(nearest, std::hypot(std::abs(x[0]) - 1, x[1]));
        }
        EXPECT_LT(nearest, 1e-9);
      }
    }
}

/// Partial contact that ends within a face, while the face is open or closed as a whole: half a wave of a compressed
/// fracture (Westergaard 1939), see perf/verification/exact.py. For a mean pressure below p* and Fourier coefficients
/// p_k of the pressure, the mean opening is -2 sum p_k/(k G/(1 - nu)).
TEST(ErrorEstimate, ContactThatEndsWithinAFace) {
  constexpr Real modulus = 1 / 0.75, load = 0.4, full = M_PI * modulus * 0.01;
  constexpr int n = 2048;
  Real exact = 0;
  for (int k = 1; k < n / 2; ++k) {
    Real wave = 0;
    for (int i = 0; i < n; ++i) {
      const Real x = (i + 0.5) / n, s = std::sin(M_PI * x), c = std::abs(std::cos(M_PI * x));
      wave += 2.0 / n * 2 * full * c * std::sqrt(std::max(load - s * s, 0.0)) * std::cos(2 * M_PI * k * x);
    }
    exact -= 2 * wave / (2 * M_PI * k * modulus);
  }
  for (const int order : {1, 2}) {
    SCOPED_TRACE(fmt::format("order {}", order));
    model::Model model(read_scene("verification/wavy.xml", {fmt::format("Mesh file.order={}", order)}),
                       Tpetra::getDefaultComm());
    ASSERT_TRUE(model.step_to(1).converged);
    const auto& mesh = model.mesh();
    const auto e = estimate_of(model);
    const auto& field = e.fields.back();
    ASSERT_EQ(field.name, "jump error");
    const Outputs out(model);
    Real mean = 0, estimated = 0;
    for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) {
      mean += 2 * mesh.fracture_faces[f].area * out.vector("jump", f)[1];
      estimated += 2 * mesh.fracture_faces[f].area * field.values[2 * f + 1];
    }
    expect_between(base::sum_over_ranks(*mesh.comm, estimated) / (exact - base::sum_over_ranks(*mesh.comm, mean)), 0.5,
                   2, "mean jump");
    if (mesh.comm->getRank() == 0) fmt::print("  wavy of order {}\n", order);
  }
}

/// Solutions in the discrete space have no error.
TEST(ErrorEstimate, NoneWhereThereIsNone) {
  for (const int dim : {2, 3})
    for (const auto& d : discretisations(dim)) {
      SCOPED_TRACE(d.name());
      model::Model model(read_scene(fmt::format("verification/regimes_{}d.xml", dim), d.with()),
                         Tpetra::getDefaultComm());
      ASSERT_TRUE(model.step_to(model.scene().time.times().front()).converged);
      const auto e = estimate_of(model);
      EXPECT_LT(e.stress.relative, 1e-9);
      EXPECT_LT(e.jump.relative, 1e-9);
    }
}

/// Checks that all ranks together give the estimates of each rank alone. Collective.
void expect_same_on_ranks(const model::Scene& scene, Real tolerance) {
  const RCP<const Comm> alone = rcp(new Teuchos::MpiComm<int>(MPI_COMM_SELF));
  model::Model together(scene, Tpetra::getDefaultComm()), single(scene, alone);
  ASSERT_TRUE(together.step_to(1).converged);
  ASSERT_TRUE(single.step_to(1).converged);
  const auto a = estimate_of(together), b = estimate_of(single);
  EXPECT_NEAR(a.stress.relative, b.stress.relative, tolerance * b.stress.relative);
  EXPECT_NEAR(a.jump.relative, b.jump.relative, tolerance * b.jump.relative);
}

TEST(ErrorEstimate, SameOnAnyNumberOfRanks) {
  for (const int dim : {2, 3})
    for (const auto& d : discretisations(dim)) {
      SCOPED_TRACE(d.name());
      expect_same_on_ranks(read_scene(fmt::format("verification/manufactured_mixed_{}d.xml", dim), d.with()), 1e-10);
    }
}

TEST(ErrorEstimate, OfCracksTheSameOnAnyNumberOfRanks) {
  for (const std::string name : {"sneddon", "penny"})
    for (const int order : {1, 2}) {
      if (name == "penny" && order == 2) continue;
      SCOPED_TRACE(fmt::format("{} of order {}", name, order));
      expect_same_on_ranks(read_scene("verification/" + name + ".xml", {fmt::format("Mesh file.order={}", order)}),
                           1e-8);
    }
}

/// Rock without fractures, rock without displacement, and rock at rest under its initial stress.
TEST(ErrorEstimate, OfWhatHasNoJump) {
  model::Model intact(read_scene("verification/uniaxial_2d.xml"), Tpetra::getDefaultComm());
  ASSERT_TRUE(intact.step_to(intact.scene().time.times().front()).converged);
  const auto summary = estimate_of(intact).summary;
  EXPECT_FALSE(summary.contains("jump"));
  EXPECT_LT(summary["stress"]["relative"].get<Real>(), 1e-9);

  model::Model unmoved(read_scene("verification/free_sides_2d.xml", {"Boundary conditions.moved.displacement={0, 0}"}),
                       Tpetra::getDefaultComm());
  ASSERT_TRUE(unmoved.step_to(1).converged);  // without a linear solve
  const auto none = estimate_of(unmoved).summary;
  EXPECT_EQ(none["stress"]["relative"], 0);
  EXPECT_EQ(none["jump"]["relative"], 0);

  model::Model resting(read_scene("verification/lithostatic_2d.xml"), Tpetra::getDefaultComm());
  ASSERT_TRUE(resting.step_to(resting.scene().time.times().front()).converged);
  const auto rest = estimate_of(resting);
  EXPECT_LT(rest.stress.relative, 1e-3);
  EXPECT_LT(rest.jump.relative, 1e-3);
}

}  // namespace
}  // namespace sprekk::tests
