// What scenes say of mechanics.
#include "physics/mechanics/mechanics.hpp"
#include "physics/ranged_entry.hpp"

#include <algorithm>
#include <cmath>

namespace sprekk::physics {

namespace {

constexpr Real degree = 3.14159265358979323846 / 180;
constexpr Real any = -std::numeric_limits<Real>::infinity();

std::vector<RangedEntry> entries_of(const Mechanics::Rock& rock) {
  return {{"Young's modulus", rock.E, 0, false},
          {"Poisson's ratio", rock.nu, -1, false, 0.5},
          {"shear modulus", rock.G, 0, false},
          {"Lame's first parameter", rock.lambda, any, false},
          {"bulk modulus", rock.K, 0, false},
          {"density", rock.density, 0}};
}

std::vector<RangedEntry> entries_of(const Mechanics::Joint& joint) {
  return {{"tangential stiffness", joint.tangential_stiffness, 0, false},
          {"friction coefficient", joint.friction_coefficient, 0},
          {"friction angle", joint.friction_angle, 0, true, 90},
          {"dilation angle", joint.dilation_angle, 0, true, 90},
          {"initial gap", joint.initial_gap, any, false},
          {"maximum closure", joint.maximum_closure, 0},
          {"initial aperture", joint.initial_aperture, 0},
          {"normal stiffness", joint.normal_stiffness, 0, false}};
}

template <class Part>
bool all_uniform(const Part& part) {
  const auto entries = entries_of(part);
  return std::all_of(entries.begin(), entries.end(), [](const auto& entry) { return entry.is_uniform(); });
}

void describe_initial_stress(base::Section& s, std::vector<base::Expression>& stress, const std::string& whose) {
  s.entry(stress, "initial stress", "Pa",
          "stress at zero displacement" + whose +
              ", tension positive: XX, YY, ZZ, XY in 2D; XX, YY, ZZ, XY, YZ, XZ in 3D; values or expressions of x, y, "
              "z");
  for (const auto& component : stress) check_constant_in_time(s, "initial stress", component);
}

Real friction(const Mechanics::Joint& joint, const std::array<Real, 3>& x) {
  return joint.friction_coefficient ? (*joint.friction_coefficient)(x, 0)
                                    : std::tan((*joint.friction_angle)(x, 0) * degree);
}

}  // namespace

void Mechanics::Rock::describe(base::Section& s) {
  s.entry(E, "Young's modulus", "Pa", base::positive(), "E; give exactly two elastic constants");
  s.entry(nu, "Poisson's ratio", "-", base::greater_than(-1).below(0.5), "nu");
  s.entry(G, "shear modulus", "Pa", base::positive(), "G");
  s.entry(lambda, "Lame's first parameter", "Pa", base::any(), "lambda");
  s.entry(K, "bulk modulus", "Pa", base::positive(), "K");
  s.entry(density, "density", "kg/m^3", base::at_least(0), "of the rock; needed with gravity");
  s.hint({"E", "young"}, "Did you mean \"Young's modulus\"?");
  s.hint({"nu", "poisson"}, "Did you mean \"Poisson's ratio\"?");
  s.hint({"G"}, "Did you mean \"shear modulus\"?");
  s.hint({"K"}, "Did you mean \"bulk modulus\"?");
  s.hint({"lambda"}, "Did you mean \"Lame's first parameter\"?");
  s.hint({"rho"}, "Did you mean \"density\"?");
  check_constant_in_time(s, entries_of(*this));
}

void Mechanics::Rock::check(base::Section& s) const {
  const int n = E.has_value() + nu.has_value() + G.has_value() + lambda.has_value() + K.has_value();
  if (n != 0 && n != 2) s.fail(fmt::format("{} elastic constants given, exactly two are needed", n));
}

bool Mechanics::Rock::is_uniformly_elastic() const { return all_uniform(*this); }

laws::Elasticity Mechanics::Rock::elasticity(const std::array<Real, 3>& x) const {
  for (const auto& entry : entries_of(*this)) entry.check(x);
  const auto at = [&](const std::optional<base::Expression>& value) {
    return value ? std::make_optional((*value)(x, 0)) : std::nullopt;
  };
  return laws::lame_constants({at(E), at(nu), at(G), at(lambda), at(K)});
}

void Mechanics::Joint::describe(base::Section& s) {
  s.entry(tangential_stiffness, "tangential stiffness", "Pa/m", base::positive_or_infinite(),
          "K_t of the elastic part of the tangential jump (12); infinite: all tangential jump is plastic");
  s.entry(friction_coefficient, "friction coefficient", "-", base::at_least(0),
          "mu of the bound (13); or give the angle");
  s.entry(friction_angle, "friction angle", "degree", base::at_least(0).below(90), "atan(mu) (3)");
  s.entry(dilation_angle, "dilation angle", "degree", base::at_least(0).below(90),
          "theta: the gap grows by tan(theta)|u_t^p| (14)");
  s.entry(initial_gap, "initial gap", "m", base::any(), "g0 of (14)");
  s.entry(maximum_closure, "maximum closure", "m", base::at_least(0).or_infinite(),
          "Du of the normal closure in (14); 0: none; infinite, or absent: closure is linear, the traction over K_n");
  s.entry(normal_stiffness, "normal stiffness", "Pa/m", base::positive(),
          "K_n at zero traction; absent: the joint does not close");
  s.entry(initial_aperture, "initial aperture", "m", base::at_least(0), "a0 of (15)");
  s.hint({"kn", "jkn"}, "Did you mean \"normal stiffness\"?");
  s.hint({"ks", "kt", "jks", "shear stiffness"}, "Did you mean \"tangential stiffness\"?");
  s.hint({"phi", "friction"}, "Did you mean \"friction angle\"?");
  s.hint({"mu"}, "Did you mean \"friction coefficient\"?");
  s.hint({"psi", "dilatancy", "dilatancy angle"}, "Did you mean \"dilation angle\"?");
  s.hint({"cohesion", "tensile strength"}, "A joint has neither cohesion nor tensile strength, friction alone");
  s.hint({"JRC", "JCS"}, "Friction has a \"friction angle\" or \"friction coefficient\", independent of the traction");
  check_constant_in_time(s, entries_of(*this));
}

void Mechanics::Joint::check(base::Section& s) const {
  if (friction_coefficient && friction_angle) s.fail("give either \"friction coefficient\" or \"friction angle\"");
  const bool closes = maximum_closure && (!maximum_closure->is_constant() || (*maximum_closure)({}, 0) > 0);
  if (closes && !normal_stiffness)
    s.fail("normal stiffness", "missing; it is required with a \"maximum closure\" above 0");
}

bool Mechanics::Joint::is_uniform() const { return all_uniform(*this); }

std::optional<Real> Mechanics::Joint::uniform_friction() const {
  const auto& value = friction_coefficient ? friction_coefficient : friction_angle;
  return value && value->is_constant() ? std::make_optional(friction(*this, {})) : std::nullopt;
}

JointParameters Mechanics::Joint::joint(const std::array<Real, 3>& x) const {
  for (const auto& entry : entries_of(*this)) entry.check(x);
  JointParameters joint;
  joint.law.elastic.compliance = 1 / tangential_stiffness(x, 0);
  SPREKK_CHECK(friction_coefficient || friction_angle, "give either \"friction coefficient\" or \"friction angle\"");
  joint.law.friction.coefficient = friction(*this, x);
  joint.law.gap.initial = initial_gap(x, 0);
  joint.law.gap.dilation.tangent = std::tan(dilation_angle(x, 0) * degree);
  if (normal_stiffness)
    joint.law.gap.closure = {maximum_closure ? (*maximum_closure)(x, 0) : std::numeric_limits<Real>::infinity(),
                             (*normal_stiffness)(x, 0)};
  joint.initial_aperture = initial_aperture(x, 0);
  return joint;
}

void Mechanics::Bulk::describe(base::Section& s) {
  s.entry(rigid, "rigid", "-", "the rock does not deform: no mechanics, and no displacements");
  s.entry(body_force, "body force", "N/m^3", "force per volume, one value or expression of x, y, z, t per direction");
  describe_initial_stress(s, initial_stress, "");
  s.section(lithostatic_stress, "lithostatic stress",
            "initial stress of rock at rest under gravity along the last coordinate");
}

void Mechanics::Bulk::check(base::Section& s) const {
  if (lithostatic_stress && !initial_stress.empty())
    s.fail("give either \"initial stress\" or \"lithostatic stress\"");
}

void Lithostatic::describe(base::Section& s) {
  s.required(surface, "surface", "m", "coordinate where the vertical stress is zero");
  s.entry(horizontal_ratio, "horizontal ratio", "-", base::at_least(0), "horizontal over vertical stress");
}

void Mechanics::Region::describe(base::Section& s) {
  describe_initial_stress(s, initial_stress, ", in place of that of \"Bulk\"");
}

void Mechanics::Fracture::describe(base::Section& s) {
  s.entry(
      fluid_pressure, "fluid pressure", "Pa", base::any(),
      "p, a value or an expression of x, y, z, t: it pushes the sides apart; the traction on the rock is lambda - p n");
  s.entry(
      plastic_jump, "plastic jump", "m", base::any(),
      "tangential plastic jump at the start, in the frame of the face: t in 2D, t1, t2 in 3D; values or expressions "
      "of x, y, z");
  for (const auto& component : plastic_jump) check_constant_in_time(s, "plastic jump", component);
}

void Mechanics::BoundaryCondition::describe(base::Section& s) {
  s.entry(displacement, "displacement", "m", base::any().or_word("free"),
          "per direction a value, an expression of x, y, z, t, or free");
  s.entry(traction, "traction", "Pa",
          "force per area on the body, per direction a value or an expression of x, y, z, t");
}

void Mechanics::BoundaryCondition::check(base::Section& s) const {
  if (!displacement.empty() && !traction.empty()) s.fail("give either \"displacement\" or \"traction\"");
}

std::vector<Prescribed> Mechanics::BoundaryCondition::prescribed() const {
  return displacement.empty() ? std::vector<Prescribed>() : std::vector<Prescribed>{{"displacement", displacement}};
}

}  // namespace sprekk::physics
