// Error estimates of flow, compared with exact solutions.
#include "base/over_ranks.hpp"
#include "estimate/goals.hpp"
#include "model/error_estimates.hpp"
#include "transport/face_plane.hpp"
#include "verification/flow/boxes.hpp"

#include <numeric>

namespace sprekk::tests {
namespace {

/// Exact solution: flux in rock, along a fracture at y = 0, and out of the fracture through each of its sides.
struct Exact {
  std::function<Vector3(const Vector3&)> flux;
  std::function<Real(Real)> along = [](Real) { return 0.0; }, away = [](Real) { return 0.0; };
  Real transmissivity = 1, resistance = 0;
};

/// Returns a box around the origin with edges of length 2 (3D: height 1), mobility 1, and prescribed pressures on all
/// sides.
model::Scene open_box(const std::string& cell, int n, const std::string& pressure) {
  auto scene = closed_box(cell, false, n);
  const bool flat = is_flat(cell);
  scene.mesh.lower_corner = flat ? std::vector<Real>{-1, -1} : std::vector<Real>{-1, -1, 0};
  scene.mesh.upper_corner = flat ? std::vector<Real>{1, 1} : std::vector<Real>{1, 1, 1};
  if (!flat) scene.mesh.cells[2] = n / 2;
  scene.flow->viscosity = 1;
  for (const std::string side : {"west", "east", "south", "north"}) constrain(scene, side, pressure);
  return scene;
}

/// Adds the fracture y = 0 from the west to x = end.
void cut(model::Scene& scene, Real end, Real along, Real across) {
  const bool flat = scene.mesh.cells.size() == 2;
  using Corner = std::vector<Real>;
  scene.mesh.fractures["a"] = {flat ? Corner{-1, 0} : Corner{-1, 0, 0}, flat ? Corner{end, 0} : Corner{end, 0, 1}};
  auto& joint = scene.materials.at("joint");
  joint.tangential_permeability = along / aperture;
  joint.normal_permeability = base::Expression(across * aperture / 2);  // 1/R = 2 k_n/a
}

/// Returns |q_h - q| over rock and fractures in the energy norm, with fluxes from the unknowns of the model.
template <mesh::Shape shape>
Real true_error(model::Model& model, const Exact& exact) {
  constexpr int dim = mesh::dimension(shape), n = dim + 1;
  const auto& mesh = model.mesh();
  std::map<std::string, std::vector<Real>> p;
  for (std::size_t b = 0; b < model.state().size(); ++b) {
    const auto& layout = model.system().layouts()[b];
    fields::Vector all(layout.ghosted());
    all.doImport(*model.state()[b], *layout.import(), Tpetra::REPLACE);
    const auto view = all.getLocalViewHost(Tpetra::Access::ReadOnly);
    p[layout.field().name].assign(view.data(), view.data() + view.extent(0));
  }
  std::map<LocalIndex, Real> resistance;  // [cell * n + face]
  for (const auto& [f, side] : assembly::fracture_sides(mesh)) {
    const auto& face = mesh.fracture_faces[f];
    if (exact.resistance > 0) resistance[face.cell[side] * n + face.local_face[side]] = exact.resistance / face.area;
  }
  Real square = 0;
  for (LocalIndex c = 0; c < mesh.n_owned_cells; ++c) {
    Real X[mesh::n_nodes(shape)][dim], q[n] = {};
    assembly::gather_host<shape>(mesh, c, X);
    const transport::CellFaces<shape> faces(X);
    transport::FlowMatrix<shape> matrix(faces, laws::Mobility::isotropic(1), transport::FluxScheme::rt0);
    for (int k = 0; k < n; ++k)
      if (resistance.count(c * n + k)) transport::add_resistance(matrix.T, k, resistance[c * n + k]);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        q[i] += matrix.T[i][j] * (p["pressure"][c] - p["face pressure"][mesh.facets->of_cell[c * n + j]]);
    assembly::for_each_cell_point<shape>(mesh, c, [&](const auto&, Real volume, const Vector3& x) {
      const auto v = exact.flux(x);
      for (int i = 0; i < dim; ++i) {
        Real discrete = 0;
        for (int k = 0; k < n; ++k) discrete += q[k] * (x[i] - X[dim == 2 ? (k + 2) % 3 : k][i]) / (dim * faces.volume);
        square += volume * std::pow(v[i] - discrete, 2);
      }
    });
    for (int k = 0; k < n; ++k)
      if (resistance.count(c * n + k)) {
        Real area = 0;
        assembly::for_each_face_point(mesh, c, k, [&](const auto&, Real da, const auto&) { area += da; });
        assembly::for_each_face_point(mesh, c, k, [&](const auto&, Real da, const auto& x) {
          square += da * exact.resistance * std::pow(q[k] / area + exact.away(x[0]), 2);
        });
      }
  }
  for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) {
    const transport::FacePlane<shape> plane(mesh, f, exact.transmissivity, transport::FluxScheme::rt0);
    const auto& face = mesh.fracture_faces[f];
    Real q[dim] = {};
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j)
        q[i] += plane.T[i][j] * (p["face pressure"][mesh.facets->fracture_face[f]] -
                                 p["face pressure"][mesh.facets->ridge[f * dim + j]]);
    const auto corner = [&](int k, int i) { return mesh.coordinates[face.nodes[mesh::minus][k] * dim + i]; };
    assembly::for_each_face_point(
        mesh, face.cell[mesh::minus], face.local_face[mesh::minus], [&](const auto&, Real da, const Vector3& x) {
          for (int i = 0; i < dim; ++i) {
            Real discrete = 0;
            for (int k = 0; k < dim; ++k)  // ridge k is corner k in 2D, the edge that begins there in 3D
              discrete += q[k] * (x[i] - corner(dim == 2 ? 1 - k : (k + 2) % 3, i)) / ((dim - 1) * face.area);
            const Real v = i == 0 ? exact.along(x[0]) : 0;
            square += da * std::pow(v - discrete, 2) / exact.transmissivity;
          }
        });
  }
  return std::sqrt(base::sum_over_ranks(*mesh.comm, square));
}

struct MeasuredFlux {
  Real error, estimate, value, goal_error;
};

MeasuredFlux measure(model::Scene scene, const Exact& exact, const model::Quantity& quantity) {
  scene.accuracy.emplace().quantities["goal"] = quantity;
  scene.accuracy->quantities["goal"].relative = 0.01;
  model::Model model(scene, Tpetra::getDefaultComm());
  auto estimator = model::make_error_estimator(model, 0);
  estimate::Goals goals(estimator, model.scene().accuracy->functionals());
  estimate::ErrorEstimate estimate;
  const auto times = model.scene().time.times();
  for (const Real t : times) {
    EXPECT_TRUE(model.step_to(t).converged);
    const auto outputs = Outputs(model).all();
    const auto state = model::present_state(model, outputs);
    estimate = estimator(state);
    goals.add(state, estimate, t == times.back());
  }
  const auto& goal = goals.estimates().at("goal");
  const Real error = mesh::dimension(model.mesh().shape) == 2 ? true_error<mesh::Shape::triangle>(model, exact)
                                                              : true_error<mesh::Shape::tetrahedron>(model, exact);
  return {error, estimate.norms.at(0).error, goal.value, goal.error};
}

struct Case {
  std::string name, cell;
  std::function<model::Scene(int)> scene;
  Exact exact;
  model::Quantity quantity;
  Real value;              // exact value of the quantity
  Real order, goal_order;  // convergence orders; 0: not checked
  std::vector<int> meshes;
};

model::Quantity pressure_of_a() {
  model::Quantity quantity;
  quantity.what = "pressure";
  quantity.fractures = {"a"};
  return quantity;
}
model::Quantity flow_through(const std::string& boundary) {
  model::Quantity quantity;
  quantity.what = "flow";
  quantity.boundary = boundary;
  return quantity;
}

std::vector<Case> cases() {
  std::vector<Case> all;
  const Real root_of_2 = std::pow(2, 0.25);
  for (const std::string cell : {"triangle", "tetrahedron"}) {
    const bool flat = is_flat(cell);
    const auto meshes = flat ? std::vector<int>{8, 16, 32} : std::vector<int>{4, 8, 16};
    const auto sine = [flat](const Vector3& x) {
      const auto s = [&](int i) { return i < 2 || !flat ? std::sin(M_PI * x[i]) : 1; };
      const auto c = [&](int i) { return M_PI * std::cos(M_PI * x[i]); };
      return Vector3{1 - c(0) * s(1) * s(2), -s(0) * c(1) * s(2), flat ? 0 : -s(0) * s(1) * c(2)};
    };
    all.push_back({"smooth",
                   cell,
                   [=](int n) {
                     auto scene = read_scene(flat ? "flow/source_2d.xml" : "flow/source_3d.xml", {"Mesh.cell=" + cell});
                     for (int& count : scene.mesh.cells) count = n;
                     return scene;
                   },
                   {sine},
                   flow_through("west"),
                   0,
                   1,
                   0,
                   meshes});
    const auto root = [](Real sign) {  // gradient of r^(1/2) cos(theta/2), or sin
      return [=](const Vector3& x) {
        const Real r = std::hypot(x[0], x[1]), half = std::atan2(x[1], x[0]) / 2, f = -0.5 / std::sqrt(r);
        return sign > 0 ? Vector3{f * std::cos(half), f * std::sin(half), 0}
                        : Vector3{-f * std::sin(half), f * std::cos(half), 0};
      };
    };
    /// Change of storage flows out: with implicit Euler, sin(pi x) sin(pi y) decays by a constant factor per step. The
    /// fracture in the middle neither conducts nor resists.
    constexpr Real storage = 10, dt = 0.2, T = 1e-9;
    constexpr int n_steps = 5;
    const Real left = std::pow(1 + 2 * M_PI * M_PI / storage * dt, -n_steps);
    all.push_back({"what is stored",
                   cell,
                   [=](int n) {
                     auto scene = closed_box(cell, false, n);
                     scene.flow->viscosity = 1;
                     scene.flow->initial_pressure = base::Expression("sin(pi*x)*sin(pi*y)");
                     scene.materials.at("rock").compressibility = storage;
                     scene.materials.at("joint").tangential_permeability = T / aperture;
                     for (const std::string side : {"west", "east", "south", "north"}) constrain(scene, side, "0");
                     scene.time.end = n_steps * dt;
                     scene.time.steps = n_steps;
                     return scene;
                   },
                   {.flux =
                        [=](const Vector3& x) {
                          return Vector3{-left * M_PI * std::cos(M_PI * x[0]) * std::sin(M_PI * x[1]),
                                         -left * M_PI * std::sin(M_PI * x[0]) * std::cos(M_PI * x[1]), 0};
                        },
                    .transmissivity = T},
                   pressure_of_a(),
                   left * 2 / M_PI,
                   1,
                   2,
                   meshes});
    const std::string r = "(x^2+y^2)^0.25", half = "(atan2(y,x)/2)";
    all.push_back({"tip that conducts",
                   cell,
                   [=](int n) {
                     auto scene = open_box(cell, n, r + "*cos" + half);
                     cut(scene, 0, 1e8, 1e8);
                     constrain(scene, "end", "0", "a");
                     scene.boundary_conditions.at("end").boundary = "west";
                     return scene;
                   },
                   {.flux = root(1), .transmissivity = 1e8},
                   flow_through("east"),
                   2 * root_of_2 * std::sin(M_PI / 8),
                   0.5,
                   1,
                   meshes});
    all.push_back({"tip that blocks",
                   cell,
                   [=](int n) {
                     auto scene = open_box(cell, n, r + "*sin" + half);
                     cut(scene, 0, 1e-9, 1e-9);
                     auto& west = scene.boundary_conditions.at("west");  // with the jump of the pressure
                     west.pressure.reset();
                     west.flux = base::Expression("-0.5*sin" + half + "/" + r);
                     return scene;
                   },
                   {.flux = root(-1), .transmissivity = 1e-9, .resistance = 1e9},
                   flow_through("north"),
                   root_of_2 * (std::cos(M_PI / 8) - std::cos(3 * M_PI / 8)),
                   0.5,
                   1,
                   meshes});
    for (const Real T : {0.1, 10.0})
      for (const Real R : {0.0, 0.01, 10.0}) {
        if (!flat && R == 0.01) continue;  // as for 0
        /// cos(k x) (a exp(-k |y|) + b exp(k |y|)) in rock, A cos(k x) in the fracture, without source. The inflow
        /// from both sides, 2 k (b - a) cos(k x), flows along the fracture, T k^2 A cos(k x).
        const Real k = 1.5, D = T * k / (2 + T * R * k * k), a = (1 - D) / 2, b = (1 + D) / 2, A = 1 - R * k * D;
        all.push_back(
            {fmt::format("fracture, T = {}, R = {}", T, R),
             cell,
             [=](int n) {
               auto scene = open_box(
                   cell, n, fmt::format("cos({0}*x)*({1:.17g}*exp(-{0}*abs(y))+{2:.17g}*exp({0}*abs(y)))", k, a, b));
               cut(scene, 1, T, R > 0 ? 1 / R : INFINITY);
               for (const std::string side : {"west", "east"}) {
                 scene.boundary_conditions.at(side).region = "bulk";  // without the end of the fracture
                 constrain(scene, side + " end", fmt::format("{:.17g}*cos({}*x)", A, k), "a");
                 scene.boundary_conditions.at(side + " end").boundary = side;
               }
               return scene;
             },
             {.flux =
                  [=](const Vector3& x) {
                    const Real down = a * std::exp(-k * std::abs(x[1])), up = b * std::exp(k * std::abs(x[1]));
                    return Vector3{k * std::sin(k * x[0]) * (down + up),
                                   k * std::cos(k * x[0]) * (down - up) * (x[1] > 0 ? 1 : -1), 0};
                  },
              .along = [=](Real x) { return T * A * k * std::sin(k * x); },
              .away = [=](Real x) { return -k * D * std::cos(k * x); },
              .transmissivity = T,
              .resistance = R},
             pressure_of_a(),
             A * std::sin(k) / k,
             1,
             2,
             meshes});
      }
  }
  return all;
}

/// The estimate is a bound up to the oscillation of source and storage in a cell. For smooth solutions it equals the
/// error, also for quantities of interest; near tips it is at most 1.4 times larger. Errors converge with the order of
/// the solution.
TEST(FlowEstimate, BoundsTheErrorOfFluxes) {
  for (const auto& one : cases()) {
    SCOPED_TRACE(one.name + ", " + one.cell);
    MeasuredFlux before{};
    for (const int n : one.meshes) {
      const auto got = measure(one.scene(n), one.exact, one.quantity);
      const Real ratio = got.estimate / got.error, missed = std::abs(got.value - one.value);
      const bool smooth = one.order == 1, oscillates = one.name == "smooth" || one.name == "what is stored";
      EXPECT_GT(ratio, oscillates ? 0.98 : 1);
      EXPECT_LT(ratio, smooth ? 1.03 : 1.4);
      if (one.goal_order > 0) {
        EXPECT_GT(got.goal_error / missed, 0.85);
        EXPECT_LT(got.goal_error / missed, smooth ? 1.15 : 1.7);
      }
      const bool last = n == one.meshes.back();
      if (last) {
        EXPECT_NEAR(std::log2(before.error / got.error), one.order, 0.1);
      }
      if (last && one.goal_order > 0) {
        EXPECT_NEAR(std::log2(std::abs(before.value - one.value) / missed), one.goal_order, 0.1);
      }
      before = got;
      if (Tpetra::getDefaultComm()->getRank() == 0)
        fmt::print("  {}, {}, {}: {:.2e}, estimate {:.2f}; quantity {:.2e}, estimate {:.2f}\n", one.name, one.cell, n,
                   got.error, ratio, missed, got.goal_error / missed);
    }
  }
}

/// Returns a closed box with the fracture "a" from the west to x = 1, in the lower half of the plane y = 0, with the
/// pressure 1 at its western end.
model::Scene half_cut(Real transmissivity) {
  auto scene = open_box("tetrahedron", 4, "0");
  scene.boundary_conditions.clear();
  cut(scene, 1, transmissivity, INFINITY);
  scene.mesh.fractures.at("a").upper_corner[2] = 0.5;
  constrain(scene, "west", "1", "a");
  return scene;
}

/// Nothing flows through the single point in which a fracture touches another one, or the boundary. The estimate does
/// not increase with the transmissivity.
TEST(FlowEstimate, FracturesThatTouchInAPoint) {
  const auto fractures = [](Real transmissivity) {
    auto scene = half_cut(transmissivity);
    scene.mesh.fractures.at("a").upper_corner[0] = 0;
    scene.mesh.fractures["b"] = {{0, 0, 0.5}, {1, 0, 1}};
    scene.fractures["b"] = scene.fractures.at("a");
    constrain(scene, "east", "0", "b");
    return scene;
  };
  const auto boundary = [](Real transmissivity) {
    auto scene = half_cut(transmissivity);
    scene.mesh.regions["corner"] = {{-1, 0, 0.5}, {1, 1, 1}};
    constrain(scene, "east", "0");
    scene.boundary_conditions.at("east").region = "corner";
    return scene;
  };
  for (const auto& scene : {std::function(fractures), std::function(boundary)}) {
    const Exact none{[](const Vector3&) { return Vector3{}; }};
    const Real low = measure(scene(1e3), none, pressure_of_a()).estimate;
    EXPECT_NEAR(measure(scene(1e6), none, pressure_of_a()).estimate, low, 0.01 * low);
  }
}

}  // namespace
}  // namespace sprekk::tests
