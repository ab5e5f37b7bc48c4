// History, outputs and measures of the elastic-plastic jump, and independence of the partition.
#include "physics/mechanics/elastic_plastic_jump.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "unit/physics/rock.hpp"

namespace sprekk::physics::testing {
namespace {

using laws::ContactState;

laws::JointParameters full_joint() {
  laws::JointParameters joint;
  joint.law = {laws::LinearShear{0.5},
               laws::CoulombFriction{0.6},
               {0.01, laws::ConstantDilation{0.2}, laws::BartonBandisClosure{0.1, 5}}};
  joint.initial_aperture = 0.3;
  return joint;
}

/// Cut box with an upper part shifted against the lower one; every face has the same jump `w` (global frame).
struct ShiftedRock {
  Rock rock;
  fields::BlockVector x;

  explicit ShiftedRock(const std::string& cell, const laws::JointParameters& joint = full_joint())
      : rock(make_rock(cut_box(cell, false), joint)), x(rock.system->initial()) {}

  /// Sets jump and traction of all faces, in the frame of the faces.
  void set(std::array<Real, 3> jump, std::array<Real, 3> traction) {
    const int dim = rock.dim();
    const auto& face = rock.global.fracture_faces[0];  // the faces of a plane have one frame
    const auto frame =
        mesh::face_frame(mesh::area_vector(rock.global, face.cell[mesh::minus], face.local_face[mesh::minus]), dim);
    x = rock.system->initial();
    for (LocalIndex c = 0; c < rock.mesh->n_cells(); ++c)
      for (int a = 0; a < rock.mesh->nodes_per_cell(); ++a)
        for (int i = 0; i < dim && rock.mesh->cell_region[c] == 1; ++i) {  // the stiff part is above
          const LocalIndex unknown = rock.mesh->cells[c * rock.mesh->nodes_per_cell() + a] * dim + i;
          Real u = 0;
          for (int k = 0; k < dim; ++k) u += frame[k][i] * jump[k];
          if (unknown < rock.mesh->n_owned_nodes * dim) x[0]->replaceLocalValue(unknown, u);
        }
    for (LocalIndex f = 0; f < rock.mesh->n_owned_fracture_faces; ++f)
      for (int i = 0; i < dim; ++i) x[2]->replaceLocalValue(f * dim + i, traction[i]);
  }

  /// Checks the plastic jump at the beginning of the next step: R_t of a closed face vanishes only there.
  void expect_history(std::array<Real, 2> p_old) {
    const int dim = rock.dim();
    set({0, p_old[0], p_old[1]}, {-50, 0, 0});
    auto r = fields::create_like(x);
    rock.system->raw_residual(x, r);
    for (LocalIndex f = 0; f < rock.mesh->n_owned_fracture_faces; ++f)
      for (int i = 1; i < dim; ++i) EXPECT_NEAR(r[2]->getData()[f * dim + i], 0, 1e-13);
  }
};

TEST(ElasticPlasticJump, HistoryMovesByState) {
  for (const auto& cell : all_cells) {
    ShiftedRock s(cell);
    const int dim = s.rock.dim();
    const Real third = dim == 3;
    s.expect_history({0, 0});
    s.set({5, 0.4, -0.3 * third}, {0, 0, 0});  // open: all of w_t is plastic
    s.rock.system->commit(s.x);
    s.expect_history({0.4, -0.3 * third});
    s.set({0, 0.7, 0.1 * third}, {-50, 0.3, 0});  // sticks: unchanged
    s.rock.system->commit(s.x);
    s.expect_history({0.4, -0.3 * third});
    s.set({0, 3, 2 * third}, {-0.5, 0.2, -0.1 * third});  // slips: w_t - lambda_t/K_t
    s.rock.system->commit(s.x);
    for (Real state : s.rock.output(s.x, "state")) EXPECT_EQ(state, static_cast<Real>(ContactState::slip));
    s.expect_history({3 - 0.1, (2 + 0.05) * third});
  }
}

TEST(ElasticPlasticJump, OutputsSplitTheJump) {
  for (const auto& cell : all_cells) {
    ShiftedRock s(cell);
    const int dim = s.rock.dim();
    const Real third = dim == 3;
    s.set({-0.04, 3, 2 * third}, {-0.5, 0.2, -0.1 * third});
    s.rock.system->commit(s.x);  // outputs are of committed states
    const Real closure = -0.1 * 0.5 / (0.5 + 0.5);
    const std::vector<std::pair<std::string, std::array<Real, 3>>> expected = {
        {"jump", {-0.04, 3, 2}},
        {"elastic jump", {closure, 0.1, -0.05}},
        {"plastic jump", {-0.04 - closure, 2.9, 2.05}},
        {"traction", {-0.5, 0.2, -0.1}}};
    for (const auto& [name, value] : expected) {
      const auto local = s.rock.output(s.x, name + " local"), global = s.rock.output(s.x, name);
      ASSERT_EQ(static_cast<LocalIndex>(local.size()), s.rock.mesh->n_owned_fracture_faces * dim);
      ASSERT_EQ(local.size(), global.size());
      for (LocalIndex f = 0; f < s.rock.mesh->n_owned_fracture_faces; ++f)
        for (int i = 0; i < dim; ++i) {
          EXPECT_NEAR(local[f * dim + i], value[i], 1e-13) << name;
          Real rotated = 0;
          for (int k = 0; k < dim; ++k) rotated += s.rock.mesh->fracture_faces[f].frame[k][i] * value[k];
          EXPECT_NEAR(global[f * dim + i], rotated, 1e-13) << name;
        }
    }
    const Real slip = dim == 2 ? 2.9 : std::hypot(2.9, 2.05), shear = dim == 2 ? 0.2 : std::hypot(0.2, 0.1);
    const std::vector<std::pair<std::string, Real>> scalars = {{"opening", -0.04}, {"slip", slip},
                                                               {"aperture", 0.26}, {"state", 2},
                                                               {"has slipped", 1}, {"mobilised strength", shear / 0.3}};
    for (const auto& [name, value] : scalars)
      for (Real shown : s.rock.output(s.x, name)) EXPECT_NEAR(shown, value, 1e-13) << name;
    s.set({5, 0.4, 0}, {0, 0, 0});
    for (Real shown : s.rock.output(s.x, "mobilised strength")) EXPECT_EQ(shown, 0);
    for (Real shown : s.rock.output(s.x, "elastic jump local")) EXPECT_EQ(shown, 0);
  }
}

/// Translation of a rigid open body causes no residual. An error e of the jump in a closed face gives the measure e.
TEST(ElasticPlasticJump, MeasureSeesTheSplitInLengths) {
  ShiftedRock s("triangle");
  auto r = fields::create_like(s.x);
  const auto measure = [&] {
    s.rock.system->raw_residual(s.x, r);
    const auto measures = s.rock.system->measures(s.x, r);
    EXPECT_EQ(measures.back().name, "split of the jump");
    return measures.back().value * s.rock.system->scales().at("displacement");
  };
  const Real closed = 0.01 - 0.1 * 50 / (0.5 + 50);
  s.set({closed, 0, 0}, {-50, 0, 0});
  EXPECT_NEAR(measure(), 0, 1e-13);
  s.set({closed, 1e-3, 0}, {-50, 0, 0});
  EXPECT_NEAR(measure(), 1e-3, 1e-13 + 1e-3);  // the plastic jump dilates as well
  EXPECT_GE(measure(), 1e-3 - 1e-13);
  s.set({closed - 2e-3, 0, 0}, {-50, 0, 0});
  EXPECT_NEAR(measure(), 2e-3, 1e-13);
  s.set({5, 1, 0}, {0, 0, 0});
  EXPECT_EQ(measure(), 0);
}

/// Translation of all rock by 1e8 leaves a rounding error of 1e-8 in the jump. This error is not counted as a
/// residual.
TEST(ElasticPlasticJump, MeasuresDoNotSeeTheRoundingOfFarMotions) {
  ShiftedRock s("triangle");
  auto r = fields::create_like(s.x);
  const Real closed = 0.01 - 0.1 * 50 / (0.5 + 50);
  for (const Real error : {0.0, 1e-3}) {
    s.set({closed - error, 0, 0}, {-50, 0, 0});
    for (LocalIndex i = 0; i < s.rock.mesh->n_owned_nodes * s.rock.dim(); ++i)
      s.x[0]->sumIntoLocalValue(i, 1.23456789e8);
    s.rock.system->raw_residual(s.x, r);
    for (const auto& measure : s.rock.system->measures(s.x, r)) {
      if (measure.name != "traction" && measure.name != "split of the jump") continue;
      if (error == 0)
        EXPECT_EQ(measure.value, 0) << measure.name;
      else
        EXPECT_GT(measure.value, 0) << measure.name;
    }
  }
}

/// At the anchor of the proximal term the residual is zero. On an open face, the residual is proportional to the
/// displacement from the anchor. The Jacobian is the derivative of the residual in each contact state.
TEST(ElasticPlasticJump, ProximalTermPullsBack) {
  for (const auto& cell : all_cells) {
    ShiftedRock s(cell);
    const int dim = s.rock.dim();
    auto& system = *s.rock.system;
    auto r = fields::create_like(s.x), other = fields::create_like(s.x), dx = fields::create_like(s.x);
    const std::array<Real, 3> moved{0.02, 0.03, dim == 3 ? -0.01 : 0};
    s.set({5, 0.4, 0}, {0, 0, 0});
    system.globalisation().set_proximal_term(2, s.x);
    system.raw_residual(s.x, r);
    EXPECT_NEAR(r[2]->normInf(), 0, 1e-13);
    s.set({5 + moved[0], 0.4 + moved[1], moved[2]}, {0, 0, 0});
    system.raw_residual(s.x, r);
    for (LocalIndex f = 0; f < s.rock.mesh->n_owned_fracture_faces; ++f)
      for (int i = 0; i < dim; ++i)
        EXPECT_NEAR(r[2]->getData()[f * dim + i] / r[2]->getData()[f * dim], moved[i] / moved[0], 1e-10);
    for (const Real normal : {5.0, -0.1, -1.0}) {  // open, slips, sticks
      s.set({normal, 0.4, 0.1}, {normal < 0 ? 10 * normal : 0, 0.3, 0.1});
      system.jacobian(s.x);
      for (const auto& block : dx) block->randomize();
      system.matrix().apply(dx, r);
      const Real h = 1e-6;
      for (const Real step : {h, -2 * h}) {
        for (std::size_t b = 0; b < dx.size(); ++b) s.x[b]->update(step, *dx[b], 1);
        system.raw_residual(s.x, other);
        r[2]->update(-(step > 0 ? 1 : -1) / (2 * h), *other[2], 1);
      }
      EXPECT_LE(r[2]->normInf(), 1e-6 * other[2]->normInf()) << cell << " " << normal;
    }
    system.globalisation().set_proximal_term(0, s.x);
    s.set({5, 0.4, 0}, {0, 0, 0});
    system.raw_residual(s.x, r);
    EXPECT_NEAR(r[2]->normInf(), 0, 1e-13);
  }
}

/// A proximal term does not resist an elastic tangential jump, without plastic jump.
TEST(ElasticPlasticJump, ProximalTermLeavesTheElasticJumpAlone) {
  for (const auto& cell : all_cells) {
    ShiftedRock s(cell);
    const int dim = s.rock.dim();
    auto r = fields::create_like(s.x);
    const Real closed = 0.01 - 0.1 * 50 / (0.5 + 50);
    s.set({closed, 0, 0}, {-50, 0, 0});
    s.rock.system->globalisation().set_proximal_term(2, s.x);
    s.set({closed, 0.15, dim == 3 ? -0.2 : 0}, {-50, 0.3, dim == 3 ? -0.4 : 0});  // w_t = lambda_t / K_t
    s.rock.system->raw_residual(s.x, r);
    for (LocalIndex f = 0; f < s.rock.mesh->n_owned_fracture_faces; ++f)
      for (int i = 1; i < dim; ++i) EXPECT_NEAR(r[2]->getData()[f * dim + i], 0, 1e-12) << cell;
  }
}

/// Likewise if the tangential stiffness K_t (1 + N/N_r) depends on the compression N: here it is twice as large as
/// without compression. A spring against w_t - lambda_t / K_t would pull with 0.5 of the elastic jump.
TEST(ElasticPlasticJump, ProximalTermLeavesANonlinearElasticJumpAlone) {
  auto joint = full_joint();
  joint.law.elastic = laws::PowerShear{.stiffness = 2, .reference = 50, .exponent = 1};
  for (const auto& cell : all_cells) {
    ShiftedRock s(cell, joint);
    const int dim = s.rock.dim();
    auto r = fields::create_like(s.x);
    const Real closed = 0.01 - 0.1 * 50 / (0.5 + 50);
    for (const Real stiffness : {2, 1000}) {
      s.set({closed, 0, 0}, {-50, 0, 0});
      s.rock.system->globalisation().set_proximal_term(stiffness, s.x);
      s.set({closed, 0.075, dim == 3 ? -0.1 : 0}, {-50, 0.3, dim == 3 ? -0.4 : 0});
      s.rock.system->raw_residual(s.x, r);
      for (LocalIndex f = 0; f < s.rock.mesh->n_owned_fracture_faces; ++f)
        for (int i = 1; i < dim; ++i) EXPECT_NEAR(r[2]->getData()[f * dim + i], 0, 1e-11) << cell;
    }
  }
}

/// A face with springs much stiffer than the rock slides in the direction of its slip p: R_t = -s p - b with the bound
/// b = 0.6 * 0.5 of the traction without the springs. The state open, R = lambda - s (w - w_a), shows s.
TEST(ElasticPlasticJump, ProximalTermStiffensTheProjection) {
  for (const auto& cell : all_cells) {
    ShiftedRock s(cell);
    auto r = fields::create_like(s.x);
    const Real closed = 0.01 - 0.1 * 0.5 / (0.5 + 0.5), slip = 3, opens = 0.2 * slip, pulled = 1e9;
    s.set({closed, 0, 0}, {-0.5, 0, 0});
    s.rock.system->globalisation().set_proximal_term(1000, s.x);
    s.set({closed, slip, 0}, {pulled, 0, 0});
    s.rock.system->raw_residual(s.x, r);
    const bool has_face = r[2]->getLocalLength() > 0;
    const Real per_stress = has_face ? r[2]->getData()[0] / pulled : 1,
               open = has_face ? r[2]->getData()[1] / per_stress : 0;
    s.set({closed + opens, slip, 0}, {-0.5 - open / slip * opens, 0, 0});
    s.rock.system->raw_residual(s.x, r);
    if (!has_face) continue;
    EXPECT_NEAR(r[2]->getData()[1] / per_stress - open, -0.6 * 0.5, 1e-12 * std::abs(open)) << cell;
  }
}

TEST(ElasticPlasticJump, IsSymmetricUnlessItSlips) {
  ShiftedRock s("tetrahedron");
  const auto symmetric = [&](std::array<Real, 3> jump, std::array<Real, 3> traction) {
    s.set(jump, traction);
    s.rock.system->jacobian(s.x);
    return s.rock.system->symmetric();
  };
  EXPECT_TRUE(symmetric({5, 0, 0}, {0, 0, 0}));
  EXPECT_TRUE(symmetric({0, 0, 0}, {-50, 0, 0}));
  EXPECT_FALSE(symmetric({0, 3, 0}, {-0.5, 0.2, 0}));
}

TEST(ElasticPlasticJump, HashTellsTheStatesOfTheFaces) {
  ShiftedRock s("quadrilateral");
  std::vector<std::size_t> hashes;
  s.set({5, 0, 0}, {0, 0, 0});
  hashes.push_back(s.rock.system->globalisation().state_hash(s.rock.system->globalisation().states(s.x)));
  s.set({0, 0, 0}, {-50, 0, 0});
  hashes.push_back(s.rock.system->globalisation().state_hash(s.rock.system->globalisation().states(s.x)));
  Rock::set(s.x, 2, 0, 100);  // one face opens
  hashes.push_back(s.rock.system->globalisation().state_hash(s.rock.system->globalisation().states(s.x)));
  s.set({0, 0, 0}, {-50, 0, 0});
  Rock::set(s.x, 2, 2, 100);  // the other one
  hashes.push_back(s.rock.system->globalisation().state_hash(s.rock.system->globalisation().states(s.x)));
  for (std::size_t i = 0; i < hashes.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(hashes[i], hashes[j]);
}

/// Residual, Jacobian, measures, merit and hash on all ranks equal the values on one rank.
TEST(FracturedRock, IsTheSameForEveryPartition) {
  const auto world = Tpetra::getDefaultComm();
  for (const auto& cell : all_cells) {
    const auto global = cut_box(cell, true);
    Loads loads;
    loads.body_force = std::vector<base::Expression>(global.dim(), text("1+x*t"));
    const auto shared = make_rock(global, full_joint(), loads),
               whole = make_rock(global, full_joint(), loads, world->split(world->getRank(), 0));
    auto x = shared.system->initial(), y = whole.system->initial();
    auto r = fields::create_like(x), q = fields::create_like(y);
    for (int seed : {1, 2}) {
      test::randomize(x, 0.5, seed);
      test::randomize(y, 0.5, seed);
      shared.system->raw_residual(x, r);
      whole.system->raw_residual(y, q);
      shared.system->jacobian(x);
      whole.system->jacobian(y);
      for (int b = 0; b < 3; ++b) {
        EXPECT_LE(test::largest(test::gather(*r[b]) - test::gather(*q[b])), 1e-12) << cell << " " << b;
        for (int c = 0; c < 3; ++c) {
          ASSERT_EQ(shared.system->matrix()(b, c).is_null(), whole.system->matrix()(b, c).is_null());
          EXPECT_LE(test::largest(shared.block(b, c) - whole.block(b, c)), 1e-11) << cell << " " << b << c;
        }
      }
      EXPECT_EQ(shared.system->globalisation().state_hash(shared.system->globalisation().states(x)),
                whole.system->globalisation().state_hash(whole.system->globalisation().states(y)));
      EXPECT_EQ(shared.system->symmetric(), whole.system->symmetric());
      const Real merit = whole.system->merit(y, q);
      EXPECT_NEAR(shared.system->merit(x, r), merit, 1e-12 * merit);
      const auto measures = shared.system->measures(x, r), reference = whole.system->measures(y, q);
      for (std::size_t k = 0; k < measures.size(); ++k)
        EXPECT_NEAR(measures[k].value, reference[k].value, 1e-12 * reference[k].value) << measures[k].name;
      shared.system->commit(x);
      whole.system->commit(y);
    }
  }
}

}  // namespace
}  // namespace sprekk::physics::testing
