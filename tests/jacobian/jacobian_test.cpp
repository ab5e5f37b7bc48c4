// Jacobian of every module of a scene, compared with differences, with all faces open, sticking, slipping, and mixed.
#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <functional>
#include <limits>

#include "laws/contact.hpp"
#include "assembly/jacobian_check.hpp"
#include "jacobian/against_plastic_jump.hpp"
#include "model/model.hpp"
#include "unit/assembly/dense.hpp"
#include "unit/mesh/meshes.hpp"

namespace sprekk {
namespace {

using laws::ContactState;

struct Law {
  const char* name;
  Real tangential_stiffness, dilation_angle, maximum_closure;
};

constexpr Real infinite = std::numeric_limits<Real>::infinity();
const Law everything{"everything", 4e9, 5, 0.02}, rigid{"rigid", infinite, 0, 0},
    linear{"closes linearly", 4e9, 5, infinite};

/// Returns rock with an immersed fracture, one that crosses it and one from it to the boundary.
model::Scene make_scene(const std::string& cell, int order, const Law& law) {
  model::Scene scene;
  scene.mesh = mesh::testing::crossed(cell);
  scene.mesh.order = order;
  const int dim = static_cast<int>(scene.mesh.lower_corner.size());
  auto& rock = scene.materials["rock"];
  rock.type = "elastic";
  rock.E = 20e9;
  rock.nu = 0.2;
  auto& joint = scene.materials["joint"];
  joint.type = "joint";
  joint.friction_coefficient = 0.7;
  joint.tangential_stiffness = law.tangential_stiffness;
  joint.dilation_angle = law.dilation_angle;
  joint.initial_gap = 0.003;
  joint.maximum_closure = law.maximum_closure;
  joint.normal_stiffness = 10e9;
  scene.bulk.material = "rock";
  scene.bulk.body_force.assign(dim, base::Expression(1e4));
  for (const auto& [name, fracture] : scene.mesh.fractures) scene.fractures[name].material = "joint";
  for (const auto& [name, side, value] : {std::tuple("floor", "south", 0.0), std::tuple("lid", "north", 0.01)}) {
    scene.boundary_conditions[name].boundary = side;
    scene.boundary_conditions[name].displacement.assign(dim, base::Expression(value));
  }
  return scene;
}

/// Returns unknowns with each face in the state `wanted` (by global number). Displacements and bubbles are random with
/// the magnitude of the load. The normal traction opens or closes the face; the shear traction is far below or above
/// the bound.
template <class Wanted>
fields::BlockVector visit(assembly::System& system, const Wanted& wanted, int seed) {
  auto x = system.initial();
  const Real length = system.scales().at("displacement"), stress = system.scales().at("stress");
  const int dim = system.mesh().dim();
  test::randomize(x, length, seed);
  for (LocalIndex f = 0; f < system.mesh().n_owned_fracture_faces; ++f) {
    const GlobalIndex id = system.mesh().fracture_faces[f].id;
    const ContactState state = wanted(id);
    for (int i = 0; i < dim; ++i) {
      const Real random = 1 + 0.2 * test::pseudo_random(id * dim + i, seed), sign = (id + i) % 2 ? 1 : -1;
      const Real normal = state == ContactState::open ? 40 : -40, shear = state == ContactState::slip ? 400 : 0.5;
      x[2]->replaceLocalValue(f * dim + i, stress * random * (i == 0 ? normal : sign * shear));
    }
  }
  return x;
}

/// Returns the contact state of every face of this rank at x, with the plastic jump of `before`. Outputs are of
/// committed states, hence the separate model.
std::vector<Real> states(const model::Scene& scene, const fields::BlockVector& before, const fields::BlockVector& x) {
  model::Model model(scene, Tpetra::getDefaultComm());
  model.system().set_time(1, 1);
  model.system().commit(before);
  model.system().commit(x);
  for (const auto& field : model.system().outputs(x))
    if (field.name == "state") return field.values;
  ADD_FAILURE() << "no output \"state\"";
  return {};
}

struct Case {
  std::string cell;
  int order;
};

class Jacobian : public ::testing::TestWithParam<Case> {};

TEST_P(Jacobian, OfEveryModuleIsItsDerivativeInEveryState) {
  const std::function<ContactState(GlobalIndex)> open = [](GlobalIndex) { return ContactState::open; },
                                                 stick = [](GlobalIndex) { return ContactState::stick; },
                                                 slip = [](GlobalIndex) { return ContactState::slip; },
                                                 mixed = [](GlobalIndex face) {
                                                   return static_cast<ContactState>(face % 3);
                                                 };
  std::vector<Law> joint_laws{everything};
  if (GetParam().order == 1)
    joint_laws.insert(joint_laws.end(), {rigid, linear});  // the law does not depend on the
                                                           // order
  for (const auto& law : joint_laws) {
    SCOPED_TRACE(law.name);
    const auto scene = make_scene(GetParam().cell, GetParam().order, law);
    model::Model model(scene, Tpetra::getDefaultComm());
    auto& system = model.system();
    system.set_time(1, 1);
    const std::size_t n = GetParam().order == 1 ? 4 : 3;  // numbers of modules and fields, with the enrichment of
                                                          // crack tips
    ASSERT_EQ(system.modules().size(), n);
    const auto before = visit(system, open, 1);
    system.commit(before);
    int seed = 1;
    for (const auto& wanted : {open, stick, slip, mixed}) {
      const auto x = visit(system, wanted, ++seed);
      against_plastic_jump(system, before, *x[2]);
      const auto visited = states(scene, before, x);
      ASSERT_EQ(static_cast<LocalIndex>(visited.size()), system.mesh().n_owned_fracture_faces);
      for (std::size_t f = 0; f < visited.size(); ++f)
        EXPECT_EQ(visited[f], static_cast<Real>(wanted(system.mesh().fracture_faces[f].id)));
      const auto errors = assembly::check_jacobian(system, x, 1e-5);
      EXPECT_EQ(errors.size(), n * n * n);  // modules, rows, columns
      for (const auto& e : errors) EXPECT_LE(e.error, 1e-6) << e.module << ": " << e.row << ", " << e.column;
    }
  }
}

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (const auto& cell : mesh::testing::all_cells)
    for (int order : {1, 2}) cases.push_back({cell, order});
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Cells, Jacobian, ::testing::ValuesIn(all_cases()),
                         [](const auto& info) { return info.param.cell + std::to_string(info.param.order); });

}  // namespace
}  // namespace sprekk
