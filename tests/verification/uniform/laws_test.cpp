// Every joint law on a mesh. Under uniform stress, each face behaves like a point in a column of the same stiffness,
// under cyclic loads, in 3D in a general direction of the joint frame.
#include "laboratory/point.hpp"
#include "verification/uniform/states.hpp"

namespace sprekk::tests {
namespace {

using Overrides = std::vector<std::string>;

struct Law {
  const char* name;
  Overrides entries;  ///< entries of the joint
};

const std::vector<Law> all_laws = {
    {"cohesion", {"bond=constant cohesion", "cohesion=0.04"}},
    {"cohesion by opening", {"bond=constant cohesion", "cohesion=0.04", "opening without cohesion=0.02"}},
    {"bond", {"bond=linear softening", "cohesion=0.05", "shear fracture energy=0.005"}},
    {"no slip", {"friction=no slip"}},
    {"slip weakening", {"friction=slip weakening", "residual friction coefficient=0.4", "weakening distance=0.3"}},
    {"slip weakening with radiation damping",
     {"friction=slip weakening", "residual friction coefficient=0.4", "weakening distance=0.3",
      "radiation damping=0.02"}},
    {"rate and state",
     {"friction=rate and state", "direct effect=0.05", "evolution effect=0.06", "state evolution distance=0.1",
      "initial slip rate=0.3", "reference slip rate=0.3", "radiation damping=0.01", "dilation angle=5"}},
    {"slip law",
     {"friction=rate and state, slip law", "direct effect=0.05", "evolution effect=0.04",
      "state evolution distance=0.2", "initial slip rate=0.1"}},
    {"composed",
     {"friction=composed", "basic friction coefficient=0.4", "asperity angle=10", "asperity friction coefficient=0.2",
      "transition stress=2", "damage=isotropic", "damage length of friction=1", "damage length of dilation=0.7"}},
    {"mobilised",
     {"friction=mobilised Barton-Choubey", "dilation=mobilised", "residual friction angle=25",
      "joint roughness coefficient=8", "joint wall strength=5", "peak slip=0.1"}},
    {"decaying dilation", {"dilation=decaying angle", "dilation angle=8", "dilation decay distance=0.2"}},
    {"limited dilation", {"dilation=limited", "dilation angle=8", "largest dilation=0.03"}},
    {"memory",
     {"closure=Barton-Bandis with memory", "normal stiffness=5", "maximum closure=0.1",
      "irrecoverable part of closure=0.4", "dilation angle=5"}},
    {"power", {"closure=power", "normal stiffness=5", "stiffening stress=0.4", "stiffening exponent=0.5"}},
    {"shear power",
     {"tangential elasticity=power", "shear stiffening stress=0.2", "shear stiffening exponent=0.5",
      "dilation angle=5"}},
    {"damage by compression",
     {"damage=isotropic", "damage driver=compression", "reference stress=0.3", "damage length of friction=1",
      "residual part of friction=0.5", "dilation angle=5", "damage length of dilation=0.5"}},
    {"damage by work",
     {"damage=isotropic", "damage driver=frictional work", "reference stress=0.2", "damage length of friction=1",
      "residual part of friction=0.5", "dilation angle=5", "damage length of dilation=0.5"}},
    {"anisotropic damage",
     {"damage=anisotropic", "damage length of friction=0.4", "residual part of friction=0.6", "dilation angle=3",
      "damage length of dilation=0.5"}}};

const std::vector<Real> path = {0.1, 0.3, 0.5, 0.6, 0.5, 0.2, -0.1, -0.4, -0.6, -0.3, 0.1, 0.5};

Overrides along_path(const std::string& table) {
  std::vector<Real> times(path.size() + 1), from_rest = {0};
  for (std::size_t k = 0; k < times.size(); ++k) times[k] = k;
  from_rest.insert(from_rest.end(), path.begin(), path.end());
  return {fmt::format("Tables.{}.arguments={{{}}}", table, fmt::join(times, ", ")), values(table, from_rest),
          fmt::format("Time.end={}", path.size()), fmt::format("Time.steps={}", path.size())};
}

/// Sets the entries of a law in the joint.
void set(laws::JointMaterial& joint, const Law& law) {
  using Material = laws::JointMaterial;
  const std::map<std::string, std::string Material::*> roles = {
      {"friction", &Material::friction},
      {"dilation", &Material::dilation},
      {"closure", &Material::closure},
      {"tangential elasticity", &Material::tangential_elasticity},
      {"bond", &Material::bond},
      {"damage", &Material::damage},
      {"damage driver", &Material::damage_driver}};
  for (const auto& text : law.entries) {
    const auto at = text.find('=');
    const std::string name = text.substr(0, at), value = text.substr(at + 1);
    if (roles.count(name) > 0)
      joint.*roles.at(name) = value;
    else
      joint.entry(name) = std::stod(value);
  }
  if (joint.friction != "Coulomb" && joint.friction != "slip weakening") joint.friction_coefficient.reset();
}

std::vector<laboratory::PointState> at_a_point(const Law& law) {
  auto scene = laboratory::read_point_scene(*Tpetra::getDefaultComm(), source_dir() + "/xml/point/cyclic_shear.xml",
                                            along_path("shear"));
  set(scene.materials.at("joint"), law);
  return laboratory::drive_point(scene);
}

void expect_the_same(const Law& law, int dim) {
  const auto states = at_a_point(law);
  auto overrides = along_path("tangential");
  if (dim == 3)
    overrides.push_back("Boundary conditions.moved.displacement={0.6*tangential(t), -0.8*tangential(t), -0.1}");
  auto scene = read_scene(fmt::format("verification/cyclic_{}d.xml", dim), overrides);
  tie_sides(scene);
  set(scene.materials.at("joint"), law);
  model::Model model(scene, Tpetra::getDefaultComm());
  int slips = 0;
  for (std::size_t k = 0; k < path.size(); ++k) {
    SCOPED_TRACE(fmt::format("step {}", k + 1));
    const auto report = model.step_to(k + 1);
    ASSERT_TRUE(report.converged) << report.reason;
    const auto& s = states[k];
    slips += s.contact == laws::ContactState::slip;
    const Real K_t = s.elastic[1] == 0 ? 1 : s.traction[1] / s.elastic[1];
    auto e = UniformJoint{s.traction[1], s.traction[0], s.plastic[1], s.jump[0], s.elastic[0], K_t}.along(
        dim == 2 ? Vector3{1, 0, 0} : Vector3{0.6, -0.8, 0}, dim);
    e.tolerance = e.traction_tolerance = 1e-9;
    expect_joint(model, e);
  }
  const bool may_slip = law.name != std::string("no slip");
  EXPECT_EQ(slips >= 4, may_slip);
  EXPECT_EQ(slips > 0, may_slip);
}

TEST(LawsOfJoints, FacesDoWhatPointsDo) {
  for (const int dim : {2, 3})
    for (const auto& law : all_laws) {
      SCOPED_TRACE(fmt::format("{} in {}D", law.name, dim));
      expect_the_same(law, dim);
    }
}

}  // namespace
}  // namespace sprekk::tests
