// Scene entries of mechanics.
#include "base/entry_of_place.hpp"
#include "laws/elastic_constants.hpp"
#include "physics/mechanics/mechanics.hpp"

#include <algorithm>
#include <array>

namespace sprekk::physics {

namespace {

constexpr const char* density_name = "density";
base::Bounds bounds_of_nu() { return base::greater_than(-1).below(0.5); }

void describe_initial_stress(base::Section& s, std::vector<base::Expression>& stress, const std::string& whose) {
  entry_of_place(s, stress, "initial stress", "Pa", base::any(),
                 "initial stress at zero displacement" + whose +
                     ", tension positive: XX, YY, ZZ, XY in 2D; XX, YY, ZZ, XY, YZ, XZ in 3D; values or expressions of "
                     "x, y, z");
}

}  // namespace

void Mechanics::Rock::describe(base::Section& s) {
  entry_of_place(
      s, E, "Young's modulus", "Pa", base::positive(),
      "Young's modulus E; exactly two elastic constants are required; typical: 20e9 to 80e9 (material library)");
  entry_of_place(s, nu, "Poisson's ratio", "-", bounds_of_nu(),
                 "Poisson's ratio nu, an elastic constant; typical: 0.2 to 0.3 (material library)");
  entry_of_place(s, G, "shear modulus", "Pa", base::positive(),
                 "shear modulus G, an elastic constant; typical: 2e9 to 15e9 (material library)");
  entry_of_place(s, lambda, "Lame's first parameter", "Pa", base::any(),
                 "Lame's first parameter lambda, an elastic constant");
  entry_of_place(s, K, "bulk modulus", "Pa", base::positive(), "bulk modulus K, an elastic constant");
  entry_of_place(s, density, density_name, "kg/m^3", base::at_least(0),
                 "density of the rock, required with gravity; typical: 2100 to 2950 (material library)");
  s.hint({"E", "young"}, "Did you mean \"Young's modulus\"?");
  s.hint({"nu", "poisson"}, "Did you mean \"Poisson's ratio\"?");
  s.hint({"G"}, "Did you mean \"shear modulus\"?");
  s.hint({"K"}, "Did you mean \"bulk modulus\"?");
  s.hint({"lambda"}, "Did you mean \"Lame's first parameter\"?");
  s.hint({"rho"}, "Did you mean \"density\"?");
}

void Mechanics::Rock::check(base::Section& s) const {
  const int n = E.has_value() + nu.has_value() + G.has_value() + lambda.has_value() + K.has_value();
  if (n != 0 && n != 2) s.fail(fmt::format("{} elastic constants given, exactly two are needed", n));
}

bool Mechanics::Rock::is_uniformly_elastic() const {
  const auto is_uniform = [](const auto* value) { return !*value || (*value)->is_constant(); };
  return std::ranges::all_of(std::array{&E, &nu, &G, &lambda, &K}, is_uniform);
}

laws::Elasticity Mechanics::Rock::elasticity(const std::array<Real, 3>& x) const {
  const auto at = [&](const char* name, const std::optional<base::Expression>& value, const base::Bounds& bounds) {
    return value ? std::make_optional(value_at(name, *value, bounds, x)) : std::nullopt;
  };
  return laws::lame_constants({.E = at("Young's modulus", E, base::positive()),
                               .nu = at("Poisson's ratio", nu, bounds_of_nu()),
                               .G = at("shear modulus", G, base::positive()),
                               .lambda = at("Lame's first parameter", lambda, base::any()),
                               .K = at("bulk modulus", K, base::positive())});
}

Real Mechanics::Rock::density_at(const std::array<Real, 3>& x) const {
  return value_at(density_name, *density, base::at_least(0), x);
}

/// Declares the entries of all laws if the selection is not known.
void Mechanics::Joint::describe(base::Section& s) { laws::JointMaterial::describe(s, s.documents() || !s.is_sound()); }

void Mechanics::Bulk::describe(base::Section& s) {
  s.entry(rigid, "rigid", "-", "switch for rigid rock, without mechanics and displacements");
  s.entry(body_force, "body force", "N/m^3",
          "force per volume and direction, a value or an expression of x, y, z, t each");
  describe_initial_stress(s, initial_stress, "");
  s.section(lithostatic_stress, "lithostatic stress",
            "initial stress of rock at rest under gravity, along the last coordinate");
  s.section(in_situ_stress, "in-situ stress",
            "initial stress by the vertical and two horizontal stresses, compression positive");
  s.entry(release, "release", "s", base::any(),
          "begin and end of the release of unbalanced forces, set by \"release\" of a stage");
}

void Mechanics::Bulk::check(base::Section& s) const {
  if (!initial_stress.empty() + lithostatic_stress.has_value() + in_situ_stress.has_value() > 1)
    s.fail("give one of \"initial stress\", \"lithostatic stress\" and \"in-situ stress\"");
  if (!release.empty() && (release.size() != 2 || !(release[1] > release[0])))
    s.fail("release", "must be two times, the second after the first");
}

void Lithostatic::describe(base::Section& s) {
  s.required(surface, "surface", "m", "coordinate of the surface with zero vertical stress");
  s.entry(horizontal_ratio, "horizontal ratio", "-", base::at_least(0), "ratio of horizontal to vertical stress");
}

void PrincipalStress::describe(base::Section& s) {
  const auto component = [&](Component& one, const std::string& name, const std::string& which) {
    s.entry(one.value, name, "Pa", base::any(), which + " at the datum, compression positive");
    s.entry(one.gradient, name + " gradient", "Pa/m", base::any(), "increase of the " + which + " per metre of depth");
  };
  s.required(datum, "datum", "m", "vertical coordinate at zero depth, z in 3D and y in 2D");
  component(vertical, "Sv", "vertical stress");
  component(largest, "SHmax", "largest horizontal stress");
  component(smallest, "Shmin", "smallest horizontal stress");
  s.entry(azimuth, "azimuth", "degree", base::any(),
          "azimuth of SHmax, clockwise from north: in 3D x is east and y north; in a 2D section from west to east, 90 "
          "(SHmax in the section) or 0 (across the section)");
}

void Mechanics::Region::describe(base::Section& s) {
  describe_initial_stress(s, initial_stress, ", in place of the stress of \"Bulk\"");
}

void Mechanics::Fracture::describe(base::Section& s) {
  s.entry(fluid_pressure, "fluid pressure", "Pa", base::any(),
          "prescribed fluid pressure p in the fracture, a value or an expression of x, y, z, t; the traction on the "
          "rock is lambda - alpha p n with the \"Biot coefficient\" alpha of the joint");
  entry_of_place(s, initial_traction, "initial traction", "Pa", base::any(),
                 "initial traction lambda of the contact in the frame of the face, tension positive: n, t in 2D; n, "
                 "t1, t2 in 3D; values or expressions of x, y, z; absent: that of the initial stress and pressure");
  entry_of_place(s, plastic_jump, "plastic jump", "m", base::any(),
                 "initial tangential plastic jump in the frame of the face: t in 2D, t1, t2 in 3D; values or "
                 "expressions of x, y, z");
  entry_of_place(
      s, slip_path, "slip path", "m", base::at_least(0),
      "length of the path of the initial slip, of joints with a \"reference state\" in situ; absent: the size "
      "of the plastic jump");
  entry_of_place(s, unbroken, "unbroken", "-", base::any(),
                 "part that is bonded at the start: faces at whose centre this value or expression of x, y, z is above "
                 "0; they have no jump, no conduit and no fluid until the bond opens; other faces have no bond; "
                 "requires the bond \"sharp front\" or \"linear softening\"; absent: bond and conduit everywhere");
  s.entry(stress_intensity, "stress intensity", "-",
          "switch for stress intensity factors and energy release rates at the tips, in 3D along the front, written to "
          "results.json and stress_intensity.csv");
  entry_of_place(
      s, toughness, "toughness", "Pa*m^0.5", base::positive(),
      "intensity of the largest hoop stress at which a tip grows, a value or an expression of x, y; includes "
      "\"stress intensity\"; 2D; see the section \"Growth\"");
  entry_of_place(
      s, strength, "strength", "Pa", base::positive(),
      "tensile strength of the rock beyond other fractures that a growing tip meets, a value or an expression of x, "
      "y; the tip crosses a fracture if the rock beyond fails before the fracture slips; absent: it ends there");
  if (s.complete() && strength && !toughness) s.fail("strength", "requires a \"toughness\"");
  s.section(prescribed_slip, "prescribed slip", "slip as a function of position and time, in place of friction");
}

void Mechanics::BoundaryCondition::describe(base::Section& s) {
  s.entry(displacement, "displacement", "m", base::any().or_word("free"),
          "prescribed displacement per direction: a value, an expression of x, y, z, t, or free");
  s.entry(lower_corner, "lower corner", "m",
          "lowest coordinates of a box, which restricts the \"displacement\" to nodes of the boundary inside, e.g. a "
          "point or an edge");
  s.entry(upper_corner, "upper corner", "m", "highest coordinates of the box; empty: the \"lower corner\", a point");
  s.entry(traction, "traction", "Pa",
          "force per area on the body, per direction a value or an expression of x, y, z, t");
  s.entry(confining_pressure, "confining pressure", "Pa", base::any(),
          "pressure on the body along the normal of its faces, a value or an expression of x, y, z, t; adds to a "
          "\"traction\"");
  s.entry(foundation_stiffness, "foundation stiffness", "Pa/m", base::at_least(0),
          "stiffness k_i per direction of springs between the boundary and rigid ground, with the traction -k_i u_i; "
          "one value k: along the normal n of each face, with the traction -k n (n.u)");
}

void Mechanics::BoundaryCondition::check(base::Section& s) const {
  if (lower_corner.empty() && !upper_corner.empty()) s.fail("upper corner", "requires a \"lower corner\"");
  for (std::size_t i = 0; i < std::min(lower_corner.size(), upper_corner.size()); ++i)
    if (upper_corner[i] < lower_corner[i])
      s.fail("upper corner", fmt::format("[{}] is {}, must be at least {}, the value of \"lower corner\"", i,
                                         upper_corner[i], lower_corner[i]));
  if (displacement.empty() && !lower_corner.empty()) s.fail("lower corner", "requires a \"displacement\"");
  if (!displacement.empty() && (is_loaded() || !foundation_stiffness.empty()))
    s.fail(fmt::format("give either \"displacement\" or \"{}\"", !traction.empty()    ? "traction"
                                                                 : confining_pressure ? "confining pressure"
                                                                                      : "foundation stiffness"));
}

std::vector<Prescribed> Mechanics::BoundaryCondition::prescribed() const {
  if (displacement.empty()) return {};
  return {{"displacement", displacement, lower_corner, upper_corner.empty() ? lower_corner : upper_corner}};
}

}  // namespace sprekk::physics
