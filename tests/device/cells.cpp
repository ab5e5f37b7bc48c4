// Elasticity and flow in random cells.
#include "physics/mechanics/elastic_cell.hpp"
#include "report.hpp"
#include "transport/changed_flow.hpp"

namespace sprekk::device {
namespace {

using mesh::Shape;
using transport::FluxScheme;

/// Returns cells without common nodes: a third are affine; of the others of order 2, half are curved.
template <Shape shape>
assembly::Geometry random_cells(int n_cells) {
  using Cell = assembly::ReferenceCell<shape>;
  constexpr int n = Cell::n_nodes, n_corners = Cell::n_corners, dim = Cell::dim;
  Random random(3);
  assembly::Geometry geometry;
  geometry.coordinates = filled<Real**>(
      [&](const auto& X) {
        for (int c = 0; c < n_cells; ++c) {
          const Real moved = c % 3 == 0 ? 0 : 0.1, bent = c % 6 == 1 ? 0.02 : 0;
          Real A[dim][dim];
          for (auto& row : A)
            for (Real& each : row) each = random(-0.2, 0.2);
          for (int i = 0; i < dim; ++i) A[i][i] += 1;
          for (int a = 0; a < n; ++a)
            for (int i = 0; i < dim; ++i) {
              Real& x = X(c * n + a, i);
              x = 0;
              if (a < n_corners) {
                for (int k = 0; k < dim; ++k) x += A[i][k] * Cell::corner(a, k);
                x += random(-moved, moved);
              } else {
                for (int b = 0; b < n_corners; ++b) x += Cell::corner_share(a, b) * X(c * n + b, i);
                x += random(-bent, bent);
              }
            }
        }
      },
      n_cells * n, dim);
  geometry.cells = filled<LocalIndex**>(
      [&](const auto& cells) {
        for (int c = 0; c < n_cells; ++c)
          for (int a = 0; a < n; ++a) cells(c, a) = c * n + a;
      },
      n_cells, n);
  geometry.region = View<int*>("region", n_cells);
  return geometry;
}

template <class T>
View<T*> one(const T& value) {
  return filled<T*>([&](const auto& view) { view(0) = value; }, 1);
}

View<Real**> unknowns(int n, int columns, Real low, Real high) {
  Random random(7);
  return filled<Real**>(
      [&](const auto& x) {
        for (int e = 0; e < n; ++e)
          for (int k = 0; k < columns; ++k) x(e, k) = random(low, high);
      },
      n, columns);
}

template <Shape shape>
void add_elasticity(Report& report, const std::string& name, int n_timed = 0) {
  using Op = physics::ElasticCell<shape>;
  const auto make = [](int n) {
    const auto geometry = random_cells<shape>(n);
    return std::pair(Op{geometry, one(laws::Elasticity{12e9, 8e9}), geometry.region},
                     unknowns(n, Op::Columns::size, -1e-3, 1e-3));
  };
  add_case(report, "elasticity, " + name, 600, report.n_timed > 0 ? n_timed : 0, make);
}

template <Shape shape>
transport::HybridCell<shape> flow_in_cells(int n, FluxScheme scheme) {
  const auto geometry = random_cells<shape>(n);
  laws::Mobility mobility;
  const Real k[3][3] = {{3e-10, 1e-10, 0}, {1e-10, 2e-10, 0}, {0, 0, 1e-10}};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) mobility.value[i][j] = k[i][j];
  return {geometry, one(mobility), geometry.region, {0, -4e3, -9e3}, scheme, {5e-10, 1e7}};
}

template <Shape shape>
void add_flow(Report& report, const std::string& name, FluxScheme scheme, int n_timed = 0) {
  using Op = transport::HybridCell<shape>;
  const auto make = [&](int n) {
    return std::pair(flow_in_cells<shape>(n, scheme), unknowns(n, Op::Columns::size, 5e6, 2e7));
  };
  add_case(report, "flow, " + name, 600, report.n_timed > 0 ? n_timed : 0, make);
}

/// Adds flow of a fluid with variable density and viscosity.
template <Shape shape>
void add_changed_flow(Report& report, const std::string& name, FluxScheme scheme) {
  using Op = transport::ChangedFlow<transport::HybridCell<shape>>;
  const auto make = [&](int n) {
    laws::FluidResponse response;
    response.expansion = 5e-4;
    response.thinning = 2e-2;
    response.reference = 1.2e7;  // the unknowns have one range, 1e-6 of that of pressures
    response.expansion *= 1e-6;
    response.thinning *= 1e-6;
    return std::pair(Op{flow_in_cells<shape>(n, scheme), response}, unknowns(n, Op::Columns::size, 5e6, 2e7));
  };
  add_case(report, "changed flow, " + name, 600, 0, make);
}

}  // namespace

void add_cells(Report& report) {
  add_elasticity<Shape::triangle>(report, "triangles");
  add_elasticity<Shape::quadrilateral>(report, "quadrilaterals");
  add_elasticity<Shape::tetrahedron>(report, "tetrahedra", report.n_timed);
  add_elasticity<Shape::hexahedron>(report, "hexahedra", report.n_timed / 4);
  add_elasticity<Shape::triangle6>(report, "triangles of order 2");
  add_elasticity<Shape::quadrilateral9>(report, "quadrilaterals of order 2");
  add_elasticity<Shape::tetrahedron10>(report, "tetrahedra of order 2", report.n_timed / 16);
  add_flow<Shape::triangle>(report, "triangles, RT0", FluxScheme::rt0);
  add_flow<Shape::quadrilateral>(report, "quadrilaterals, mimetic", FluxScheme::mimetic);
  add_flow<Shape::tetrahedron>(report, "tetrahedra, RT0", FluxScheme::rt0, report.n_timed);
  add_flow<Shape::hexahedron>(report, "hexahedra, two points", FluxScheme::tpfa, report.n_timed);
  add_flow<Shape::hexahedron>(report, "hexahedra, mimetic", FluxScheme::mimetic, report.n_timed);
  add_changed_flow<Shape::tetrahedron>(report, "tetrahedra, RT0", FluxScheme::rt0);
}

}  // namespace sprekk::device
