// Matrices after elimination of bubbles, and of bubbles and tractions, compared with closed forms for one face.
#include <gtest/gtest.h>

#include <cmath>

#include "unit/physics/rock.hpp"

namespace sprekk::physics::testing {
namespace {

using mesh::operator*;

/// Blocks of the Jacobian at x as dense matrices: displacement u, side bubble b, traction l.
struct Blocks {
  Dense uu, ub, ul, bu, bb, bl, lu, lb, ll;

  Blocks(const Rock& rock, const fields::BlockVector& x) : Blocks((rock.system->jacobian(x), rock)) {}

  /// Returns A' = A - A_ub A_bb^-1 A_bu.
  Dense condensed() const { return uu - ub * test::solve(bb, bu); }

  /// Returns A - [A_ub A_ul] [A_bb A_bl; A_lb A_ll]^-1 [A_bu; A_lu].
  Dense reduced() const {
    const int n = uu.n_rows, b = bb.n_rows, l = ll.n_rows;
    Dense inner(b + l, b + l), right(b + l, n), left(n, b + l);
    for (int i = 0; i < b + l; ++i) {
      for (int j = 0; j < b + l; ++j)
        inner(i, j) = i < b ? (j < b ? bb(i, j) : bl(i, j - b)) : (j < b ? lb(i - b, j) : ll(i - b, j - b));
      for (int j = 0; j < n; ++j) {
        right(i, j) = i < b ? bu(i, j) : lu(i - b, j);
        left(j, i) = i < b ? ub(j, i) : ul(j, i - b);
      }
    }
    return uu - left * test::solve(inner, right);
  }

 private:
  explicit Blocks(const Rock& rock)
      : uu(rock.block(0, 0)),
        ub(rock.block(0, 1)),
        ul(rock.block(0, 2)),
        bu(rock.block(1, 0)),
        bb(rock.block(1, 1)),
        bl(rock.block(1, 2)),
        lu(rock.block(2, 0)),
        lb(rock.block(2, 1)),
        ll(rock.block(2, 2)) {}
};

/// Fracture face of the global mesh.
struct Face {
  GlobalIndex id;
  mesh::GlobalMesh::FractureFace sides;
  Real area;
  mesh::Vector n;  ///< from side minus to side plus

  Face(const mesh::GlobalMesh& mesh, GlobalIndex face) : id(face), sides(mesh.fracture_faces[face]) {
    const auto a = mesh::area_vector(mesh, sides.cell[mesh::minus], sides.local_face[mesh::minus]);
    area = mesh::norm(a);
    n = (1 / area) * a;
  }
};

/// Gradients of the linear functions that are 1 at one corner of a simplex and 0 at the others; volume of the simplex.
struct Simplex {
  std::vector<mesh::Vector> g;
  Real volume;

  Simplex(const mesh::GlobalMesh& mesh, GlobalIndex cell) : volume(mesh::testing::cell_volume(mesh, cell)) {
    const int dim = mesh.dim();
    for (int a = 0; a <= dim; ++a)  // minus the outward area vector of the opposite face, over dim |cell|
      g.push_back((-1 / (dim * volume)) * mesh::area_vector(mesh, cell, dim == 2 ? (a + 1) % 3 : a));
  }
};

/// Returns the integral of grad b x grad b over the cell, for the bubble b of a face.
Dense bubble_gradients(const mesh::GlobalMesh& mesh, GlobalIndex cell, int local_face) {
  const int dim = mesh.dim();
  Dense M(dim, dim);
  if (on_simplices(mesh)) {  // b = 4 l_1 l_2 or 27 l_1 l_2 l_3; integrals of monomials in closed form
    const Simplex simplex(mesh, cell);
    const Real same = dim == 2 ? 16 / 6.0 : 729 / 210.0, other = dim == 2 ? 16 / 12.0 : 729 / 420.0;
    for (int p = 0; p < dim; ++p)
      for (int q = 0; q < dim; ++q) {
        const auto& gp = simplex.g[mesh::face_nodes(mesh.shape)[local_face][p]];
        const auto& gq = simplex.g[mesh::face_nodes(mesh.shape)[local_face][q]];
        for (int i = 0; i < dim; ++i)
          for (int j = 0; j < dim; ++j) M(i, j) += simplex.volume * (p == q ? same : other) * gp[i] * gq[j];
      }
    return M;
  }
  // Unit square or cube: product of 4 s (1 - s) along the face, times (1 - distance).
  const auto area = mesh::area_vector(mesh, cell, local_face);
  const mesh::Vector n = (1 / mesh::norm(area)) * area;
  const Real along = dim == 2 ? 16 / 9.0 : 16 / 9.0 * 8 / 15, across = dim == 2 ? 8 / 15.0 : 64 / 225.0;
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j) M(i, j) = (i == j ? along : 0) + (across - along) * n[i] * n[j];
  return M;
}

/// Returns alpha of a side: number of fracture faces of its cell times the largest eigenvalue of the bubble's
/// stiffness.
Real alpha(const Rock& rock, const Face& face, int side) {
  const GlobalIndex cell = face.sides.cell[side];
  const auto& law = rock.elasticity[rock.global.cell_region[cell]];
  const Dense M = bubble_gradients(rock.global, cell, face.sides.local_face[side]);
  Dense B(rock.dim(), rock.dim());
  Real trace = 0;
  for (int i = 0; i < rock.dim(); ++i) trace += M(i, i);
  for (int i = 0; i < rock.dim(); ++i)
    for (int j = 0; j < rock.dim(); ++j) B(i, j) = (law.lambda + law.G) * M(i, j) + (i == j ? law.G * trace : 0);
  int m = 0;
  for (const auto& other : rock.global.fracture_faces) m += (other.cell[0] == cell) + (other.cell[1] == cell);
  return m * test::eigenvalues(B).back();
}

Real bubble_mean(const mesh::GlobalMesh& mesh) {
  return mesh.dim() == 2 ? 2 / 3.0 : mesh.shape == mesh::Shape::tetrahedron ? 0.45 : 4 / 9.0;
}

Real gamma(const Rock& rock, const Face& face) {
  const Real c = bubble_mean(rock.global);
  return c * c * face.area * (1 / alpha(rock, face, mesh::plus) + 1 / alpha(rock, face, mesh::minus));
}

/// Returns the frame (n, t1[, t2]) of a face as rows, equal on every rank. Collective.
Dense frame_of(const Rock& rock, const Face& face) {
  Dense R(rock.dim(), rock.dim()), here = R;
  for (LocalIndex f = 0; f < rock.mesh->n_owned_fracture_faces; ++f)
    if (rock.mesh->fracture_faces[f].id == face.id)
      for (int k = 0; k < rock.dim(); ++k)
        for (int i = 0; i < rock.dim(); ++i) here(k, i) = rock.mesh->fracture_faces[f].frame[k][i];
  Teuchos::reduceAll(*rock.mesh->comm, Teuchos::REDUCE_SUM, static_cast<int>(R.values.size()), here.values.data(),
                     R.values.data());
  return R;
}

/// Returns W_f = mean R [[.]] - c_b R (A_bb+^-1 A_bu+ - A_bb-^-1 A_bu-), [dim, displacement unknowns]; A_bb = alpha I.
Dense jump_operator(const Rock& rock, const Face& face, const Blocks& blocks) {
  const int dim = rock.dim(), m = mesh::n_face_nodes(rock.global.shape);
  Dense W(dim, blocks.uu.n_rows);
  for (int side : {mesh::minus, mesh::plus}) {
    const Real sign = side == mesh::plus ? 1 : -1, a = alpha(rock, face, side);
    const auto nodes = mesh::nodes_of_face(rock.global, face.sides.cell[side], face.sides.local_face[side]);
    for (int k = 0; k < m; ++k)
      for (int i = 0; i < dim; ++i) W(i, static_cast<int>(nodes[k]) * dim + i) += sign / m;
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < blocks.uu.n_rows; ++j)
        W(i, j) -=
            sign * bubble_mean(rock.global) / a * blocks.bu(static_cast<int>(face.id) * 2 * dim + side * dim + i, j);
  }
  return frame_of(rock, face) * W;
}

laws::JointParameters simple_joint(Real compliance, Real maximum_closure) {
  laws::JointParameters joint;
  joint.law.elastic = laws::LinearShear{compliance};
  joint.law.friction = laws::CoulombFriction{0.6};
  joint.law.gap.closure = laws::BartonBandisClosure{maximum_closure, 5};
  return joint;
}

/// Returns a state at rest with equal tractions on all faces, in the frame of the faces.
fields::BlockVector with_traction(const Rock& rock, std::array<Real, 3> traction) {
  auto x = rock.system->initial();
  for (LocalIndex f = 0; f < rock.mesh->n_owned_fracture_faces; ++f)
    for (int i = 0; i < rock.dim(); ++i) x[2]->replaceLocalValue(f * rock.dim() + i, traction[i]);
  return x;
}

/// Commits x, because outputs are of committed states, and checks the state of all faces.
void expect_state(const Rock& rock, const fields::BlockVector& x, laws::ContactState state) {
  rock.system->commit(x);
  for (Real visited : rock.output(x, "state")) EXPECT_EQ(visited, static_cast<Real>(state));
}

TEST(Elimination, BubbleStiffnessIsIsotropicAndBoundsTheBubblesOwn) {
  for (const auto& cell : all_cells)
    for (bool crossing : {false, true}) {
      const auto rock = make_rock(cut_box(cell, crossing));
      const Blocks blocks(rock, rock.system->initial());
      Dense expected(blocks.bb.n_rows, blocks.bb.n_rows);
      for (GlobalIndex f = 0; f < rock.mesh->n_global_fracture_faces; ++f)
        for (int side : {mesh::minus, mesh::plus})
          for (int i = 0; i < rock.dim(); ++i) {
            const int row = (static_cast<int>(f) * 2 + side) * rock.dim() + i;
            expected(row, row) = alpha(rock, Face(rock.global, f), side);
          }
      EXPECT_LE(test::largest(blocks.bb - expected), 1e-12) << cell;
    }
}

TEST(Elimination, BubblesFeelAUniformStressThroughTheirFace) {
  const Real H[3][3] = {{0.3, -0.2, 0.5}, {0.7, -0.4, 0.1}, {-0.6, 0.25, 0.15}};
  for (const auto& cell : all_cells) {
    const auto rock = make_rock(cut_box(cell, true));
    const Blocks blocks(rock, rock.system->initial());
    const int dim = rock.dim();
    Dense u(blocks.uu.n_rows, 1);
    for (GlobalIndex n = 0; n < rock.global.n_nodes(); ++n)
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j)
          u(static_cast<int>(n) * dim + i, 0) += H[i][j] * rock.global.coordinates[n * dim + j];
    const Dense force = blocks.bu * u;
    for (GlobalIndex f = 0; f < rock.mesh->n_global_fracture_faces; ++f)
      for (int side : {mesh::minus, mesh::plus}) {
        const Face face(rock.global, f);
        const auto& law = rock.elasticity[rock.global.cell_region[face.sides.cell[side]]];
        Real trace = 0;
        for (int i = 0; i < dim; ++i) trace += H[i][i];
        for (int i = 0; i < dim; ++i) {
          Real traction = law.lambda * trace * face.n[i];  // sigma n_out
          for (int j = 0; j < dim; ++j) traction += law.G * (H[i][j] + H[j][i]) * face.n[j];
          if (side == mesh::plus) traction = -traction;
          EXPECT_NEAR(force((static_cast<int>(f) * 2 + side) * dim + i, 0),
                      bubble_mean(rock.global) * face.area * traction, 1e-13);
        }
      }
  }
}

TEST(Elimination, BubblesTestTheBodyForce) {
  for (const auto& cell : all_cells) {
    Loads loads;
    for (int i = 0; i < mesh::testing::dim_of(cell); ++i)
      loads.body_force.push_back(text(std::to_string(2 + i) + "*t"));
    const auto rock = make_rock(cut_box(cell, true), {}, loads);
    auto x = rock.system->initial(), r = fields::create_like(x);
    const int dim = rock.dim();
    const Real mean =
        on_simplices(rock.global) ? (dim == 2 ? 1 / 3.0 : 0.225) : (dim == 2 ? 1 / 3.0 : 2 / 9.0);  // mean of b
    for (Real t : {1.0, 3.0}) {
      rock.system->set_time(t, 1);
      rock.system->raw_residual(x, r);
      const Dense force = test::gather(*r[1]);
      for (int row = 0; row < force.n_rows; ++row) {
        const GlobalIndex owner = rock.global.fracture_faces[row / (2 * dim)].cell[(row / dim) % 2];
        const Real volume = mesh::testing::cell_volume(rock.global, owner);
        EXPECT_NEAR(force(row, 0), -(2 + row % dim) * t * mean * volume, 1e-13) << cell;
      }
    }
  }
}

TEST(Elimination, MeanJumpIsThatOfTheCondensedBubbles) {
  for (const auto& cell : all_cells) {
    const auto rock = make_rock(cut_box(cell, true));
    auto x = with_traction(rock, {-0.7, 0.4, 0.2});
    test::randomize(x, 1, 3);
    const Blocks blocks(rock, x);
    const Dense u = test::gather(*x[0]), l = test::gather(*x[2]);
    Dense load = blocks.bu * u;
    const Dense push = blocks.bl * l;
    for (int i = 0; i < load.n_rows; ++i) load(i, 0) = -load(i, 0) - push(i, 0);
    const Dense beta = test::solve(blocks.bb, load);
    for (int i = 0; i < beta.n_rows; ++i) Rock::set(x, 1, i, beta(i, 0));
    Dense exact(l.n_rows, 1);
    for (GlobalIndex f = 0; f < rock.mesh->n_global_fracture_faces; ++f) {
      const Face face(rock.global, f);
      const Dense w = jump_operator(rock, face, blocks) * u;
      for (int k = 0; k < rock.dim(); ++k) {
        const int row = static_cast<int>(f) * rock.dim() + k;
        exact(row, 0) = w(k, 0) - gamma(rock, face) * l(row, 0);
      }
    }
    const auto jump = rock.output(x, "jump local");
    for (std::size_t i = 0; i < jump.size(); ++i)
      EXPECT_NEAR(jump[i], exact(static_cast<int>(x[2]->getMap()->getGlobalElement(static_cast<LocalIndex>(i))), 0),
                  1e-12)
          << cell;
  }
}

/// Compares A without the unknowns of the faces with A' + sum |f| W^T C W.
template <class Stiffness>
void expect_reduced(const Rock& rock, const fields::BlockVector& x, const Stiffness& C) {
  const Blocks blocks(rock, x);
  Dense expected = blocks.condensed();
  for (GlobalIndex f = 0; f < rock.mesh->n_global_fracture_faces; ++f) {
    const Face face(rock.global, f);
    const Dense W = jump_operator(rock, face, blocks);
    Dense term = test::transpose(W) * (C(face) * W);
    for (Real& value : term.values) value *= -face.area;
    expected = expected - term;
  }
  EXPECT_LE(test::largest(blocks.reduced() - expected), 1e-11 * test::largest(expected));
}

TEST(Elimination, OpenFacesCarryNothing) {
  for (const auto& cell : all_cells) {
    const auto rock = make_rock(cut_box(cell, true), simple_joint(0.5, 0.1));
    const auto x = with_traction(rock, {2, 0.1, 0.3});
    expect_reduced(rock, x, [&](const Face&) { return Dense(rock.dim(), rock.dim()); });
    expect_state(rock, x, laws::ContactState::open);
  }
}

TEST(Elimination, StickingFacesAreSprings) {
  for (const auto& cell : all_cells)
    for (Real compliance : {0.0, 0.5})
      for (Real closure : {0.0, 0.1}) {
        const auto rock = make_rock(cut_box(cell, true), simple_joint(compliance, closure));
        const auto x = with_traction(rock, {-2, 0.1, 0.2});
        const Real slope = closure == 0 ? 0 : closure * closure * 5 / std::pow(closure * 5 + 2, 2);  // B'(-2)
        expect_reduced(rock, x, [&](const Face& face) {
          Dense C(rock.dim(), rock.dim());
          for (int i = 0; i < rock.dim(); ++i) C(i, i) = 1 / (gamma(rock, face) + (i == 0 ? slope : compliance));
          return C;
        });
        expect_state(rock, x, laws::ContactState::stick);
      }
}

/// C = [[k_n, 0], [-mu k_n d, k_e (I - d d^T)]], k_e = (b/|z|) c_t / (1 - (b/|z|)(1 - c_t (gamma + 1/K_t))).
/// Shear z = lambda_t - c_t lambda_t/K_t with direction d. c_t is K_t in series with the parameter `augmentation`
/// times E of the softer rock over the length of the fracture.
TEST(Elimination, SlippingFacesFollowTheNormalForce) {
  for (const auto& cell : all_cells)
    for (Real compliance : {0.0, 0.5}) {
      const auto rock = make_rock(cut_box(cell, false), simple_joint(compliance, 0));
      const Real shear[] = {3, -4};
      const auto x = with_traction(rock, {-2, shear[0], shear[1]});
      const int n_shear = rock.dim() - 1;
      const Real length = rock.dim() == 2 ? 2 : std::sqrt(8.0), size = n_shear == 1 ? 3 : 5;
      const Real c = physics::ElasticPlasticJumpParameters().augmentation * soft.youngs_modulus() / length;
      const Real c_t = 1 / (1 / c + compliance);
      const Real z = size * (1 - c_t * compliance), ratio = 0.6 * 2 / z;
      ASSERT_LT(ratio, 1);
      expect_reduced(rock, x, [&](const Face& face) {
        Dense C(rock.dim(), rock.dim());
        const Real k_n = 1 / gamma(rock, face),
                   k_e = ratio * c_t / (1 - ratio * (1 - c_t * (gamma(rock, face) + compliance)));
        C(0, 0) = k_n;
        for (int i = 0; i < n_shear; ++i) {
          const Real d = shear[i] / size;
          C(i + 1, 0) = -0.6 * k_n * d;
          for (int j = 0; j < n_shear; ++j) C(i + 1, j + 1) = k_e * ((i == j) - d * shear[j] / size);
        }
        return C;
      });
      expect_state(rock, x, laws::ContactState::slip);
      EXPECT_FALSE(rock.system->symmetric());
    }
}

/// A' is symmetric and positive semi-definite. Its null space consists of the rigid motions of all blocks.
TEST(Elimination, CondensedBulkHasRigidMotionsOfEveryBlockAndNoOtherNullSpace) {
  for (const auto& cell : all_cells)
    for (bool crossing : {false, true}) {
      const auto rock = make_rock(cut_box(cell, crossing));
      const Dense A = Blocks(rock, rock.system->initial()).condensed();
      EXPECT_LE(test::largest(A - test::transpose(A)), 1e-12);
      const auto values = test::eigenvalues(A);
      const int n_null = (crossing ? 4 : 2) * (rock.dim() == 2 ? 3 : 6);
      for (int k = 0; k < n_null; ++k) EXPECT_NEAR(values[k], 0, 1e-11) << cell;
      EXPECT_GT(values[n_null], 1e-3) << cell;
    }
}

}  // namespace
}  // namespace sprekk::physics::testing
