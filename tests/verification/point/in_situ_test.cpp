// Joints in situ at a point: they continue as the same joint that was loaded from zero, for every law.
#include "base/xml.hpp"
#include "point_scenes.hpp"

namespace sprekk::tests {
namespace {

using Overrides = std::vector<std::string>;

struct Law {
  const char* name;
  Overrides entries;
};

const Overrides rough = {"joint roughness coefficient=8", "joint wall strength=100e6"};

Overrides with(const Overrides& some, const Overrides& more) {
  Overrides all = some;
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

const std::vector<Law> in_situ_laws = {
    {"Coulomb", {}},
    {"linear closure", {"closure=linear", "normal stiffness=5e11"}},
    {"power closure", {"closure=power", "normal stiffness=50e9", "stiffening stress=1e6", "stiffening exponent=0.5"}},
    {"memory", {"closure=Barton-Bandis with memory", "irrecoverable part of closure=0.4"}},
    {"Bandis", with(rough, {"closure=Bandis"})},
    {"Bandis, third cycle", with(rough, {"closure=Bandis", "loading cycle=3", "dilation angle=2"})},
    {"constant dilation", {"dilation angle=5"}},
    {"decaying dilation", {"dilation=decaying angle", "dilation angle=5", "dilation decay distance=5e-4"}},
    {"limited dilation", {"dilation=limited", "dilation angle=5", "largest dilation=6e-5"}},
    {"mobilised", with(rough, {"friction=mobilised Barton-Choubey", "dilation=mobilised", "residual friction angle=28",
                               "peak slip=2e-3"})},
    {"Barton-Choubey", with(rough, {"friction=Barton-Choubey", "residual friction angle=28"})},
    {"slip weakening", {"friction=slip weakening", "residual friction coefficient=0.4", "weakening distance=5e-3"}},
    {"cohesion", {"bond=constant cohesion", "cohesion=1e6"}},
    {"bond",
     {"bond=linear softening", "cohesion=1e6", "shear fracture energy=2000", "tensile strength=5e5",
      "fracture energy=100"}},
    {"shear power",
     {"tangential elasticity=power", "shear stiffening stress=5e6", "shear stiffening exponent=0.5",
      "dilation angle=3"}},
    {"damage by slip",
     {"damage=isotropic", "damage length of friction=5e-3", "residual part of friction=0.7", "dilation angle=5",
      "damage length of dilation=3e-3"}},
    {"damage by compression",
     {"damage=isotropic", "damage driver=compression", "reference stress=5e6", "damage length of friction=5e-3",
      "residual part of friction=0.7", "dilation angle=5", "damage length of dilation=3e-3"}},
    {"damage by work",
     {"damage=isotropic", "damage driver=frictional work", "reference stress=5e6", "damage length of friction=5e-3",
      "residual part of friction=0.7", "dilation angle=5", "damage length of dilation=3e-3"}},
    {"anisotropic damage",
     {"damage=anisotropic", "damage length of friction=5e-3", "residual part of friction=0.7", "dilation angle=5",
      "damage length of dilation=3e-3"}}};

constexpr Real unloaded_aperture = 0.25e-3;

/// Jump along the direction of slip; in 3D (0.6, -0.8).
std::string jump(int dim, const std::string& along) {
  return dim == 2 ? along : fmt::format("0.6*({0}), -0.8*({0})", along);
}

laboratory::PointScene scene(const Law& law, int dim, const Overrides& more) {
  const std::string text =
      R"(<ParameterList name="Sprekk"><ParameterList name="Materials"><ParameterList name="joint">
      <Parameter name="type" type="string" value="joint"/></ParameterList></ParameterList>
      <ParameterList name="Time"/><ParameterList name="Point"><Parameter name="material" type="string" value="joint"/>
      </ParameterList></ParameterList>)";
  Overrides entries = {"tangential stiffness=10e9", "maximum closure=0.2e-3", "normal stiffness=20e9",
                       "friction coefficient=0.6"};
  const auto closes_otherwise = [](const std::string& entry) { return entry.rfind("closure=", 0) == 0; };
  for (const auto& entry : law.entries)
    if (closes_otherwise(entry) && entry.find("memory") == entry.npos) {
      std::erase(entries, "maximum closure=0.2e-3");
      std::erase(entries, "normal stiffness=20e9");
    }
  for (const auto& entry : law.entries)
    if (entry.rfind("friction=", 0) == 0 && entry.find("weakening") == entry.npos)
      std::erase(entries, "friction coefficient=0.6");
  Overrides all = {dim == 2 ? "Point.control={traction, jump}" : "Point.control={traction, jump, jump}"};
  for (const auto& entry : with(entries, law.entries)) all.push_back("Materials.joint." + entry);
  return laboratory::point_scene_of(base::parse_xml(text, law.name, "Sprekk", base::Defects::keep), law.name,
                                    with(all, more));
}

std::string numbers(const std::vector<Real>& values, std::size_t from = 0) {
  return fmt::format("{{{:.17g}}}", fmt::join(values.begin() + from, values.end(), ", "));
}

/// The fresh joint is loaded to 8 MPa, slips by about 2 mm, and is partly unloaded in shear. From there on both joints
/// are unloaded, reloaded to twice the compression, sheared, and unloaded completely.
void expect_the_same(const Law& law, int dim) {
  const std::string N = "8e6*piecewise(t)", s = "1e-3*shear(t)";
  const Overrides tables = {"Tables.piecewise.arguments={0, 1, 2, 3, 4, 5, 6, 7, 8}",
                            "Tables.piecewise.values={0, -1, -1, -1, -0.5, -2, -2, -1, -1e-6}",
                            "Tables.shear.arguments={0, 1, 2, 3, 4, 5, 6, 7, 8}",
                            "Tables.shear.values={0, 0, 2, 1.8, 1.8, 1.8, 4, 3.8, 3.8}"};
  const Overrides bandis = {fmt::format("Materials.joint.joint aperture={}", unloaded_aperture)};
  const bool has_aperture = law.name == std::string("Bandis") || law.name == std::string("Bandis, third cycle");
  const auto fresh = laboratory::drive_point(
      scene(law, dim,
            with(with(tables, has_aperture ? bandis : Overrides()),
                 {fmt::format("Point.path={{{}, {}}}", N, jump(dim, s)), "Time.end=8", "Time.steps=8",
                  fmt::format("Materials.joint.initial aperture={}", unloaded_aperture)})));
  ASSERT_EQ(fresh.size(), 8);
  const auto& at = fresh[2];
  EXPECT_EQ(fresh[1].contact, laws::ContactState::slip);
  EXPECT_EQ(at.contact, laws::ContactState::stick);
  EXPECT_GT(std::hypot(at.plastic[1], at.plastic.back()), 1e-4);
  const auto relative = [&](int k) {
    return fmt::format("{} - ({:.17g})", k == 1 && dim == 2 ? s : k == 1 ? "0.6*" + s : "-0.8*" + s, at.jump[k]);
  };
  const auto path =
      dim == 2 ? fmt::format("{{{}, {}}}", N, relative(1)) : fmt::format("{{{}, {}, {}}}", N, relative(1), relative(2));
  const auto curve = laboratory::drive_points(
      scene(law, dim,
            with(tables, {"Point.path=" + path, "Time.start=3", "Time.end=8", "Time.steps=5",
                          "Point.initial traction=" + numbers(at.traction),
                          "Point.plastic jump=" + numbers(at.plastic, 1), "Materials.joint.reference state=in situ",
                          fmt::format("Materials.joint.initial aperture={:.17g}", at.aperture)})))[0];
  ASSERT_EQ(curve.failure, "");
  ASSERT_EQ(curve.states.size(), 5);
  EXPECT_NEAR(curve.initial.aperture, at.aperture, 1e-14 * at.aperture);
  const Real slip = std::hypot(at.plastic[1], at.plastic.back());
  for (std::size_t k = 0; k < 5; ++k) {
    SCOPED_TRACE(fmt::format("t = {}", k + 4));
    const auto &a = curve.states[k], &b = fresh[k + 3];
    EXPECT_EQ(a.contact, b.contact);
    EXPECT_NEAR(a.aperture, b.aperture, 1e-10 * unloaded_aperture);
    EXPECT_NEAR(a.strength, b.strength, 1e-10 * 8e6);
    for (int i = 0; i < dim; ++i) {
      EXPECT_NEAR(a.traction[i], b.traction[i], 1e-10 * 8e6);
      EXPECT_NEAR(a.jump[i], b.jump[i], 1e-10 * slip);
    }
  }
}

TEST(InSitu, ContinuesAsTheJointThatWasLoadedFromZero) {
  for (const int dim : {2, 3})
    for (const auto& law : in_situ_laws) {
      SCOPED_TRACE(fmt::format("{} in {}D", law.name, dim));
      expect_the_same(law, dim);
    }
}

}  // namespace
}  // namespace sprekk::tests
