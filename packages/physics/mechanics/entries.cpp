// Scene entries of mechanics.
#include "laws/elastic_constants.hpp"
#include "physics/mechanics/mechanics.hpp"
#include "physics/entry_of_place.hpp"

#include <algorithm>
#include <array>

namespace sprekk::physics {

namespace {

constexpr const char* density_name = "density";
base::Bounds bounds_of_nu() { return base::greater_than(-1).below(0.5); }

void describe_initial_stress(base::Section& s, std::vector<base::Expression>& stress, const std::string& whose) {
  entry_of_place(s, stress, "initial stress", "Pa", base::any(),
                 "stress at zero displacement" + whose +
                     ", tension positive: XX, YY, ZZ, XY in 2D; XX, YY, ZZ, XY, YZ, XZ in 3D; values or expressions of "
                     "x, y, z");
}

}  // namespace

void Mechanics::Rock::describe(base::Section& s) {
  entry_of_place(s, E, "Young's modulus", "Pa", base::positive(), "E; give exactly two elastic constants");
  entry_of_place(s, nu, "Poisson's ratio", "-", bounds_of_nu(), "nu");
  entry_of_place(s, G, "shear modulus", "Pa", base::positive(), "G");
  entry_of_place(s, lambda, "Lame's first parameter", "Pa", base::any(), "lambda");
  entry_of_place(s, K, "bulk modulus", "Pa", base::positive(), "K");
  entry_of_place(s, density, density_name, "kg/m^3", base::at_least(0), "of the rock; needed with gravity");
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
void Mechanics::Joint::describe(base::Section& s) { JointMaterial::describe(s, s.documents() || !s.is_sound()); }

void Mechanics::Bulk::describe(base::Section& s) {
  s.entry(rigid, "rigid", "-", "the rock does not deform: no mechanics, and no displacements");
  s.entry(body_force, "body force", "N/m^3", "force per volume, one value or expression of x, y, z, t per direction");
  describe_initial_stress(s, initial_stress, "");
  s.section(lithostatic_stress, "lithostatic stress",
            "initial stress of rock at rest under gravity along the last coordinate");
  s.section(in_situ_stress, "in-situ stress",
            "initial stress given by the vertical one and two horizontal ones, compression positive");
  s.entry(release, "release", "s", base::any(),
          "two times, set by \"release\" of a stage: forces out of balance at the first are let go until the second");
}

void Mechanics::Bulk::check(base::Section& s) const {
  if (!initial_stress.empty() + lithostatic_stress.has_value() + in_situ_stress.has_value() > 1)
    s.fail("give one of \"initial stress\", \"lithostatic stress\" and \"in-situ stress\"");
  if (!release.empty() && (release.size() != 2 || !(release[1] > release[0])))
    s.fail("release", "must be two times, the second after the first");
}

void Lithostatic::describe(base::Section& s) {
  s.required(surface, "surface", "m", "coordinate where the vertical stress is zero");
  s.entry(horizontal_ratio, "horizontal ratio", "-", base::at_least(0), "horizontal over vertical stress");
}

void PrincipalStress::describe(base::Section& s) {
  const auto component = [&](Component& one, const std::string& name, const std::string& which) {
    s.entry(one.value, name, "Pa", base::any(), which + " at the datum, compression positive");
    s.entry(one.gradient, name + " gradient", "Pa/m", base::any(), "its growth with depth, per metre");
  };
  s.required(datum, "datum", "m", "vertical coordinate from which depth counts, z in 3D, y in 2D");
  component(vertical, "Sv", "vertical stress");
  component(largest, "SHmax", "largest horizontal stress");
  component(smallest, "Shmin", "smallest horizontal stress");
  s.entry(
      azimuth, "azimuth", "degree", base::any(),
      "direction of SHmax, clockwise from north: in 3D x is east and y north; in 2D, a section from west to east, 90 "
      "(SHmax lies in it) or 0 (across it)");
}

void Mechanics::Region::describe(base::Section& s) {
  describe_initial_stress(s, initial_stress, ", in place of that of \"Bulk\"");
}

void Mechanics::Fracture::describe(base::Section& s) {
  s.entry(
      fluid_pressure, "fluid pressure", "Pa", base::any(),
      "p, a value or an expression of x, y, z, t: it pushes the sides apart; the traction on the rock is lambda - p n");
  entry_of_place(
      s, plastic_jump, "plastic jump", "m", base::any(),
      "tangential plastic jump at the start, in the frame of the face: t in 2D, t1, t2 in 3D; values or expressions "
      "of x, y, z");
}

void Mechanics::BoundaryCondition::describe(base::Section& s) {
  s.entry(displacement, "displacement", "m", base::any().or_word("free"),
          "per direction a value, an expression of x, y, z, t, or free");
  s.entry(lower_corner, "lower corner", "m",
          "of a box: the \"displacement\" holds only at nodes of the boundary in it, e.g. at a point or along an edge");
  s.entry(upper_corner, "upper corner", "m", "of the box; absent: the \"lower corner\", a point");
  s.entry(traction, "traction", "Pa",
          "force per area on the body, per direction a value or an expression of x, y, z, t");
  s.entry(
      confining_pressure, "confining pressure", "Pa", base::any(),
      "force per area into the body along the normal of its faces, a value or an expression of x, y, z, t; is added "
      "to a \"traction\"");
  s.entry(foundation_stiffness, "foundation stiffness", "Pa/m", base::at_least(0),
          "of springs between the boundary and rigid ground, per direction: the traction -k_i u_i is added");
}

void Mechanics::BoundaryCondition::check(base::Section& s) const {
  if (lower_corner.empty() && !upper_corner.empty()) s.fail("upper corner", "goes with a \"lower corner\"");
  for (std::size_t i = 0; i < std::min(lower_corner.size(), upper_corner.size()); ++i)
    if (upper_corner[i] < lower_corner[i])
      s.fail("upper corner", fmt::format("[{}] is {}, must be at least {}, that of \"lower corner\"", i,
                                         upper_corner[i], lower_corner[i]));
  if (displacement.empty() && !lower_corner.empty()) s.fail("lower corner", "goes with a \"displacement\"");
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
