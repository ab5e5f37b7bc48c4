// Scene entries of flow.
#include "base/entry_of_place.hpp"
#include "physics/flow/flow.hpp"
#include "transport/tensor_entry.hpp"

#include <algorithm>
#include <cmath>

namespace sprekk::physics {

void Flow::Rock::describe(base::Section& s) {
  entry_of_place(s, permeability, "permeability", "m^2", base::any(),
                 "permeability k of the rock, required with \"Flow\"; 0: fluid flows in fractures only; one value; XX, "
                 "YY[, ZZ]; or XX, YY, XY in 2D, "
                 "XX, YY, ZZ, XY, YZ, XZ in 3D; typical: 1e-19 to 1e-16 (material library)");
  entry_of_place(s, porosity, "porosity", "-", base::between(0, 1),
                 "fraction of the volume filled with fluid; typical: 0.001 to 0.1 (material library)");
  s.entry(compressibility, "compressibility of pores", "Pa^-1", base::at_least(0),
          "increase of the porosity per fluid pressure; in deformable rock at constant strain, (Biot coefficient - "
          "porosity)/bulk modulus of the grains; typical: 3e-12 to 1.5e-11 (material library)");
  s.entry(biot_modulus, "Biot modulus", "Pa", base::positive_or_infinite(),
          "Biot modulus M, in place of the compressibility of pores: 1/M is the storage at constant strain, the "
          "compressibility of pores plus the porosity times the compressibility of the fluid (Coussy 2004)");
}

void Flow::Rock::check(base::Section& s) const {
  if (compressibility && biot_modulus) s.fail("give either \"compressibility of pores\" or \"Biot modulus\"");
}

bool Flow::Rock::flows_uniformly() const { return transport::is_uniform_tensor(permeability); }

bool Flow::Rock::is_impermeable() const { return permeability.size() == 1 && is_zero(permeability[0]); }

transport::Capacity Flow::Rock::capacity(Real of_fluid, const std::array<Real, 3>& x) const {
  const Real room = value_at("porosity", porosity, base::between(0, 1), x), minimum = room * of_fluid;
  if (!biot_modulus) return {.room = room, .growth = compressibility.value_or(0)};
  const auto here = porosity.is_constant() ? "" : fmt::format(" at ({:.6g}, {:.6g}, {:.6g})", x[0], x[1], x[2]);
  SPREKK_CHECK(minimum <= (1 + 1e-12) / *biot_modulus,
               "\"Biot modulus\": is {:.6g} Pa, must not be above {:.6g} Pa{}, the value of \"porosity\" and "
               "\"compressibility\" of the fluid without compressibility of pores",
               *biot_modulus, 1 / minimum, here);
  return {.room = room, .growth = std::max(Real(0), 1 / *biot_modulus - minimum)};
}

bool Flow::Rock::may_store(Real of_fluid) const {
  const bool pores_grow = biot_modulus ? std::isfinite(*biot_modulus) : compressibility.value_or(0) > 0;
  return pores_grow || (of_fluid > 0 && !is_zero(porosity));
}

laws::Mobility Flow::Rock::mobility(int dim, Real viscosity, const std::array<Real, 3>& x) const {
  auto k = transport::tensor_at("permeability", permeability, dim, x);
  for (auto& row : k.value)
    for (Real& component : row) component /= viscosity;
  return k;
}

void Flow::Joint::describe(base::Section& s) {
  entry_of_place(s, residual_aperture, "residual aperture", "m", base::at_least(0),
                 "minimum hydraulic aperture, with \"Flow\"");
  entry_of_place(s, tangential_permeability, "tangential permeability", "m^2", base::positive(),
                 "permeability k_t along the fracture, with \"Flow\"; absent: cubic law, (hydraulic aperture)^2/12");
  entry_of_place(s, normal_permeability, "normal permeability", "m^2", base::positive_or_infinite(),
                 "permeability k_n across the fracture, with \"Flow\"; infinite: equal pressures in the fracture and "
                 "in the adjacent rock");
}

void FlowSection::describe(base::Section& s) {
  s.entry(rigid_rock, "rigid rock", "-", "switch for flow in rigid rock, without displacements");
  s.entry(viscosity, "viscosity", "Pa*s", base::positive(),
          "dynamic viscosity mu of the fluid; the default is the value of water at 20 degrees C");
  s.entry(density, "density", "kg/m^3", base::at_least(0),
          "density rho_0 of the fluid at the reference pressure; with gravity in \"Bulk\" the fluid has weight");
  s.entry(
      compressibility, "compressibility", "Pa^-1", base::at_least(0),
      "compressibility c of the fluid: its density is rho_0 exp(c (p - reference pressure)); about 4.5e-10 for water");
  s.entry(reference_pressure, "reference pressure", "Pa", base::any(),
          "pressure of the given density, with a compressibility; volumes of fluid refer to this pressure");
  s.entry(source, "source", "s^-1", base::any(),
          "volume of injected fluid per volume of rock and time, a value or an expression of x, y, z, t");
  entry_of_place(s, initial_pressure, "initial pressure", "Pa", base::any(),
                 "initial pressure of stored fluid, a value or an expression of x, y, z");
  s.choice(scheme, "scheme", {"auto", "rt0", "tpfa", "mimetic"},
           "flux scheme; rt0: mixed elements (Raviart and Thomas 1977); tpfa: two-point flux approximation; mimetic: "
           "mimetic differences; auto: rt0 on simplices, on other cells tpfa if permeability and cells are orthogonal, "
           "else mimetic; along fractures not tpfa");
  s.named_sections(wells, "Wells", "wells by names of your choice");
  s.named_sections(
      intersections, "Intersections",
      "channels along intersections in 3D, by names of your choice; several in one place conduct in parallel");
}

void IntersectionSection::describe(base::Section& s) {
  s.entry(fractures, "fractures", "-",
          "names of fractures: the channel is in the intersections at which all of them meet; a single name: all "
          "intersections of this fracture; absent: all intersections");
  s.entry(diameter, "diameter", "m", base::positive(),
          "diameter d of a pipe with laminar flow, of the permeability times area pi d^4/128");
  s.entry(permeability_area, "permeability times area", "m^4", base::positive(),
          "permeability times cross-sectional area K of a channel of any shape: the flow is K/mu times the gradient of "
          "the pressure");
  if (s.complete() && diameter.has_value() == permeability_area.has_value())
    s.fail("give either \"diameter\" or \"permeability times area\"");
}

Real IntersectionSection::conductance(Real viscosity) const {
  return (diameter ? M_PI * std::pow(*diameter, 4) / 128 : *permeability_area) / viscosity;
}

void WellSection::describe(base::Section& s) {
  s.required(points, "points", "m", base::any(),
             "points of the well: in 2D x, y of a line of length 1 across the plane; in 3D a polyline x0, y0, z0, x1, "
             "y1, z1, ...");
  s.required(radius, "radius", "m", base::positive(), "radius r_w of the borehole; typical: 0.05 to 0.15");
  s.entry(skin, "skin", "-", base::any(),
          "skin factor S: an additional pressure drop, as by a further factor exp(S) of distance");
  s.entry(
      rate, "rate", "m^3/s", base::any(),
      "injection rate, volume of fluid per time (2D: m^2/s), negative for extraction; a value or an expression of t");
  s.entry(pressure, "pressure", "Pa", base::any(),
          "pressure in the well at its first point, a value or an expression of t");
  if (s.complete() && rate.has_value() == pressure.has_value()) s.fail("give either \"rate\" or \"pressure\"");
}

void Flow::Sections::describe(base::Section& s) { s.section(flow, "Flow", "single-phase flow in rock and fractures"); }

void Flow::Region::describe(base::Section& s) {
  s.entry(pressure, "pressure", "Pa", base::any(),
          "prescribed fluid pressure in the cells of the region and in fractures inside, with \"Flow\": a value or an "
          "expression of x, y, z, t");
}

std::vector<Prescribed> Flow::Region::prescribed() const {
  if (!pressure) return {};
  return {{"pressure", {*pressure}}, {"face pressure", {*pressure}}};
}

void Flow::Fracture::describe(base::Section& s) {
  s.entry(source, "source", "m/s", base::any(),
          "volume of injected fluid per area of the fracture and time, with \"Flow\"; a value or an expression of x, "
          "y, z, t");
  entry_of_place(s, leak_off, "leak-off coefficient", "m/s^0.5", base::at_least(0),
                 "Carter's coefficient C_L of leak-off into impermeable rock, with \"Flow\": each side of the fracture "
                 "loses the volume C_L/sqrt(t - t_0) per area and time from its exposure at t_0 on; typical: 1e-6 to "
                 "1e-4");
  s.entry(cuts, "cuts", "-",
          "names of fractures that this fracture divides at their intersection, with \"Flow\": flow between the two "
          "parts crosses this fracture with its normal permeability");
  s.named_sections(held_pressures, "Held pressures",
                   "prescribed pressures at points or lines of the fracture, by names of your choice, with \"Flow\"");
}

std::vector<Prescribed> Flow::Fracture::prescribed() const {
  std::vector<Prescribed> all;
  for (const auto& [name, held] : held_pressures)
    all.push_back({.field = "face pressure",
                   .values = {held.pressure},
                   .lower_corner = held.lower_corner,
                   .upper_corner = held.upper_corner.empty() ? held.lower_corner : held.upper_corner,
                   .section = "Held pressures > " + name});
  return all;
}

void HeldPressureSection::describe(base::Section& s) {
  s.required(
      pressure, "pressure", "Pa", base::any(),
      "prescribed pressure, a value or an expression of x, y, z, t, at the faces and edges of the fracture whose "
      "corners all are in the box; in 2D an edge is a node");
  s.required(lower_corner, "lower corner", "m", base::any(), "lowest coordinates of the box");
  s.entry(upper_corner, "upper corner", "m", base::any(),
          "highest coordinates of the box; empty: the \"lower corner\", a point, for 2D");
  for (std::size_t i = 0; i < std::min(lower_corner.size(), upper_corner.size()); ++i)
    if (upper_corner[i] < lower_corner[i])
      s.fail("upper corner", fmt::format("[{}] is {}, must be at least {}, the value of \"lower corner\"", i,
                                         upper_corner[i], lower_corner[i]));
}

void Flow::BoundaryCondition::describe(base::Section& s) {
  s.entry(pressure, "pressure", "Pa", base::any(),
          "prescribed fluid pressure, with \"Flow\": a value or an expression of x, y, z, t; without \"fracture\" and "
          "\"conductance\" it applies to rock and fractures; other conditions without \"fracture\" apply to rock only");
  s.entry(flux, "flux", "m/s", base::any(), "outflow of fluid, volume per area and time, with \"Flow\"");
  entry_of_place(s, conductance, "conductance", "m/(Pa*s)", base::at_least(0),
                 "conductance c of the boundary: the flux is c (p - pressure), with the pressure beyond the boundary");
}

void Flow::Probe::describe(base::Section& s) {
  s.entry(well, "well", "-", "name of a well, for all its results in results.json");
}

std::vector<std::string> Flow::Probe::totals() const {
  return well ? std::vector<std::string>{"wells", *well} : std::vector<std::string>();
}

void Flow::BoundaryCondition::check(base::Section& s) const {
  if (conductance && !pressure) s.fail("conductance", "needs a \"pressure\" beyond the boundary");
  if (pressure && flux) s.fail("give either \"pressure\" or \"flux\"");
}

std::vector<Prescribed> Flow::BoundaryCondition::prescribed() const {
  if (!pressure || conductance) return {};
  return {{"face pressure", {*pressure}}};
}

}  // namespace sprekk::physics
