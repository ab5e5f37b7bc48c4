#include "physics/mechanics/bulk_momentum.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mesh/raise_order.hpp"
#include "unit/physics/rock.hpp"

namespace sprekk::physics::testing {
namespace {

/// Returns a box [0, 3] x [0, 2] [x [0, 2]] of soft rock without fractures, turned by `rotation` (degrees).
mesh::BoxMesh plain_box(const std::string& cell, Real rotation) {
  auto box = mesh::testing::unit_steps(
      cell, mesh::testing::dim_of(cell) == 2 ? std::vector<int>{3, 2} : std::vector<int>{3, 2, 2});
  box.rotation = rotation;
  return box;
}

/// General displacement gradient.
constexpr Real H[3][3] = {{0.3, -0.2, 0.5}, {0.7, -0.4, 0.1}, {-0.6, 0.25, 0.15}};

Real linear(const Real* x, int i, int dim) {
  Real u = 0.1 * i;
  for (int j = 0; j < dim; ++j) u += H[i][j] * x[j];
  return u;
}

/// Returns 2 G eps + lambda tr(eps) I of H, [i][j], with the plane-strain zz component in 2D.
std::array<std::array<Real, 3>, 3> stress(const laws::Elasticity& law, int dim) {
  std::array<std::array<Real, 3>, 3> sigma{};
  Real trace = 0;
  for (int i = 0; i < dim; ++i) trace += H[i][i];
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3 && i < dim; ++j) sigma[i][j] = j < dim ? law.G * (H[i][j] + H[j][i]) : 0;
    sigma[i][i] += law.lambda * trace;
  }
  return sigma;
}

TEST(BulkMomentum, RigidMotionsAreFree) {
  for (const auto& cell : all_cells) {
    const auto rock = make_rock(mesh::make_box(plain_box(cell, 25)));
    auto x = rock.system->initial(), r = fields::create_like(x);
    const int dim = rock.dim(), n_rotations = dim == 2 ? 1 : 3;
    for (int k = 0; k < n_rotations; ++k) {
      const int a = k, b = dim == 2 ? 1 : (k + 1) % 3;  // rotation in the plane of axes a, b
      rock.displace(x, [&](const Real* X, int i) { return 1.0 + i + (i == a ? -X[b] : i == b ? X[a] : 0); });
      rock.system->raw_residual(x, r);
      EXPECT_LE(r[0]->normInf(), 1e-13) << cell;
    }
    const auto modes = rock.system->blocks()[0].near_null_space.make();  // near-null space of multigrid: contains
                                                                         // rigid rotations
    EXPECT_EQ(static_cast<int>(modes->getNumVectors()), dim + n_rotations);
    for (int m = 0; m < dim + n_rotations; ++m) {
      Tpetra::deep_copy(*x[0], *modes->getVector(m));
      EXPECT_GT(x[0]->normInf(), 0.5);
      rock.system->raw_residual(x, r);
      EXPECT_LE(r[0]->normInf(), 1e-13) << cell;
    }
  }
}

TEST(BulkMomentum, UniformStrainGivesUniformStressAndItsBoundaryForces) {
  for (const auto& cell : all_cells) {
    const auto rock = make_rock(mesh::make_box(plain_box(cell, 25)));
    const int dim = rock.dim();
    auto x = rock.system->initial(), r = fields::create_like(x);
    rock.displace(x, [&](const Real* X, int i) { return linear(X, i, dim); });
    rock.system->raw_residual(x, r);
    const auto sigma = stress(soft, dim);
    Dense expected(static_cast<int>(rock.global.n_nodes()) * dim, 1);
    const int m = mesh::n_face_nodes(rock.global.shape);
    for (const auto& face : rock.global.boundary_faces) {
      const auto area = mesh::area_vector(rock.global, face.cell, face.local_face);
      const auto nodes = mesh::nodes_of_face(rock.global, face.cell, face.local_face);
      for (int k = 0; k < m; ++k)
        for (int i = 0; i < dim; ++i)
          for (int j = 0; j < dim; ++j) expected(static_cast<int>(nodes[k]) * dim + i, 0) += sigma[i][j] * area[j] / m;
    }
    EXPECT_LE(test::largest(test::gather(*r[0]) - expected), 1e-13) << cell;
    EXPECT_GT(test::largest(expected), 0.1);

    const auto outputs = rock.system->outputs(x);
    ASSERT_EQ(outputs[1].name, "stress");
    ASSERT_EQ(static_cast<LocalIndex>(outputs[1].values.size()), 6 * rock.mesh->n_owned_cells);
    const Real voigt[] = {sigma[0][0], sigma[1][1], sigma[2][2], sigma[0][1], sigma[1][2], sigma[0][2]};
    for (std::size_t k = 0; k < outputs[1].values.size(); ++k)
      EXPECT_NEAR(outputs[1].values[k], voigt[k % 6], 1e-13) << k % 6;
  }
}

TEST(BulkMomentum, PlaneStrainHasAStressOutOfPlane) {
  const auto rock = make_rock(mesh::make_box(plain_box("triangle", 0)));
  auto x = rock.system->initial();
  rock.displace(x, [](const Real* X, int i) { return i == 0 ? 0.1 * X[0] : 0; });
  const auto values = rock.system->outputs(x)[1].values;
  for (LocalIndex c = 0; c < rock.mesh->n_owned_cells; ++c) EXPECT_NEAR(values[6 * c + 2], soft.lambda * 0.1, 1e-14);
}

TEST(BulkMomentum, IsSymmetric) {
  for (const auto& cell : all_cells) {
    const auto rock = make_rock(mesh::make_box(plain_box(cell, 25)));
    rock.system->jacobian(rock.system->initial());
    const Dense A = rock.block(0, 0);
    EXPECT_LE(test::largest(A - test::transpose(A)), 1e-14);
  }
}

/// The Jacobian of cells that are affine images of the reference cell is not integrated cell by cell; the residual is.
TEST(BulkMomentum, JacobianIsTheDerivativeOfTheResidual) {
  for (const auto& cell : all_cells)
    for (int order : {1, 2})
      for (Real bend : {0.0, 1e-7, 0.1}) {
        auto mesh = mesh::make_box(plain_box(cell, 25));
        if (order == 2) mesh = mesh::raise_order(mesh);
        const int dim = mesh::dimension(mesh.shape);
        for (std::size_t k = 0; k < mesh.coordinates.size(); k += dim) {
          Real* X = &mesh.coordinates[k];
          X[0] += 0.3 * X[1] + bend * std::sin(2 * X[1] + X[dim - 1]);  // sheared, and bent
        }
        const auto rock = make_rock(mesh);
        auto x = rock.system->initial(), r = fields::create_like(x), product = fields::create_like(x);
        rock.displace(x, [](const Real* X, int i) { return std::sin(3 * X[0] + 2 * X[1] + i); });
        rock.system->module_residual(0, x, r);
        auto J = rock.system->create_matrix();
        rock.system->module_jacobian(0, x, J);
        J.apply(x, product);
        product[0]->update(-1, *r[0], 1);
        EXPECT_LE(product[0]->normInf(), 1e-14 * r[0]->normInf()) << cell << ", order " << order << ", " << bend;
        EXPECT_GT(r[0]->normInf(), 1);
      }
}

/// Returns the sum over all nodes of (component i of the force) * f(node); forces are minus the residual at rest.
template <class F>
Real virtual_work(const Rock& rock, int i, const F& f) {
  auto x = rock.system->initial(), r = fields::create_like(x);
  rock.system->raw_residual(x, r);
  const Dense forces = test::gather(*r[0]);
  Real sum = 0;
  for (GlobalIndex n = 0; n < rock.global.n_nodes(); ++n)
    sum -= forces(static_cast<int>(n) * rock.dim() + i, 0) * f(&rock.global.coordinates[n * rock.dim()]);
  return sum;
}

Real one(const Real*) { return 1; }

TEST(BulkMomentum, BodyForcesAddUpToTheirIntegral) {
  for (const auto& cell : all_cells) {
    const int dim = mesh::testing::dim_of(cell);
    Loads loads;
    loads.body_force = {text("1+2*x+3*y"), base::Expression(-7)};
    if (dim == 3) loads.body_force.push_back(text("z*t"));
    const auto rock = make_rock(mesh::make_box(plain_box(cell, 0)), {}, loads);
    const Real volume = dim == 2 ? 6 : 12;
    EXPECT_NEAR(virtual_work(rock, 0, one), volume * (1 + 2 * 1.5 + 3 * 1), 1e-12);
    EXPECT_NEAR(virtual_work(rock, 1, one), -7 * volume, 1e-12);
    EXPECT_NEAR(virtual_work(rock, 0, [](const Real* X) { return X[0]; }), volume * (1.5 + 2 * 3 + 3 * 1.5),
                1e-12);  // (1 + 2x + 3y) x
    if (dim == 2) continue;
    EXPECT_NEAR(virtual_work(rock, 2, one), volume, 1e-12);
    rock.system->set_time(3, 1);
    EXPECT_NEAR(virtual_work(rock, 2, one), 3 * volume, 1e-12);
  }
}

TEST(BulkMomentum, TractionsAddUpToTheirIntegral) {
  for (const auto& cell : all_cells) {
    const int dim = mesh::testing::dim_of(cell);
    const auto global = mesh::make_box(plain_box(cell, 0));
    const auto number = [&](const std::string& name) {
      return static_cast<int>(std::find(global.boundary_names.begin(), global.boundary_names.end(), name) -
                              global.boundary_names.begin());
    };
    std::vector<base::Expression> east{base::Expression(5), text("2*y*t")}, north{text("x"), base::Expression(0)};
    if (dim == 3) {
      east.push_back(base::Expression(0));
      north.push_back(text("x+z"));
    }
    const auto rock = make_rock(global, {}, {{}, {{number("east"), east}, {number("north"), north}}});
    const Real depth = dim == 2 ? 1 : 2;
    for (Real t : {1.0, 4.0}) {
      rock.system->set_time(t, 1);
      EXPECT_NEAR(virtual_work(rock, 0, one), (5 * 2 + 4.5) * depth, 1e-12);
      EXPECT_NEAR(virtual_work(rock, 1, one), 4 * t * depth, 1e-12);
      EXPECT_NEAR(virtual_work(rock, 0, [](const Real* X) { return X[0]; }), (5 * 2 * 3 + 9) * depth, 1e-12);
      EXPECT_NEAR(virtual_work(rock, 1, [](const Real* X) { return X[1]; }), 2 * t * 8 / 3.0 * depth, 1e-12);
      if (dim == 3) {
        EXPECT_NEAR(virtual_work(rock, 2, one), 3 * 2 * (1.5 + 1), 1e-12);
      }
    }
    EXPECT_FALSE(rock.system->modules()[0].has_constant_load());
    EXPECT_NEAR(rock.system->scales().at("stress"), 2 * 2 * 4, 2);  // the largest traction, at quadrature points
  }
}

TEST(BulkMomentum, UniformLoadsDoNotChange) {
  const auto rock = make_rock(mesh::make_box(plain_box("triangle", 0)), {}, {{base::Expression(1), text("x")}, {}});
  EXPECT_TRUE(rock.system->modules()[0].has_constant_load());
  rock.system->set_time(2, 1);
  rock.system->set_time(3, 1);
  EXPECT_NEAR(virtual_work(rock, 0, one), 6, 1e-13);
}

}  // namespace
}  // namespace sprekk::physics::testing
