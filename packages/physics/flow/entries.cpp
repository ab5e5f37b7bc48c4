// Scene entries of flow.
#include "physics/flow/flow.hpp"
#include "physics/entry_of_place.hpp"
#include "physics/tensor_entry.hpp"

#include <algorithm>
#include <cmath>

namespace sprekk::physics {

void Flow::Rock::describe(base::Section& s) {
  entry_of_place(s, permeability, "permeability", "m^2", base::any(),
                 "k of the rock, needed with \"Flow\": one value; XX, YY[, ZZ]; or XX, YY, XY in 2D, XX, YY, ZZ, XY, "
                 "YZ, XZ in 3D");
  entry_of_place(s, porosity, "porosity", "-", base::between(0, 1), "share of the volume that is fluid");
  s.entry(
      compressibility, "compressibility of pores", "Pa^-1", base::at_least(0),
      "growth of the porosity with the fluid's pressure; of rock that deforms: at constant strain, (Biot coefficient "
      "- porosity)/bulk modulus of the grains");
  s.entry(biot_modulus, "Biot modulus", "Pa", base::positive_or_infinite(),
          "M, instead of the compressibility of pores: 1/M is that plus the porosity times the compressibility of "
          "the fluid, the storage at constant strain");
}

void Flow::Rock::check(base::Section& s) const {
  if (compressibility && biot_modulus) s.fail("give either \"compressibility of pores\" or \"Biot modulus\"");
}

bool Flow::Rock::flows_uniformly() const { return is_uniform_tensor(permeability); }

Capacity Flow::Rock::capacity(Real of_fluid, const std::array<Real, 3>& x) const {
  const Real room = value_at("porosity", porosity, base::between(0, 1), x), least = room * of_fluid;
  if (!biot_modulus) return {.room = room, .growth = compressibility.value_or(0)};
  const auto here = porosity.is_constant() ? "" : fmt::format(" at ({}, {}, {})", x[0], x[1], x[2]);
  SPREKK_CHECK(least <= (1 + 1e-12) / *biot_modulus,
               "\"Biot modulus\": is {:.6g} Pa, must not be above {:.6g} Pa{}, which \"porosity\" and "
               "\"compressibility\" of the fluid make without any growth of pores",
               *biot_modulus, 1 / least, here);
  return {.room = room, .growth = std::max(Real(0), 1 / *biot_modulus - least)};
}

bool Flow::Rock::may_store(Real of_fluid) const {
  const bool pores_grow = biot_modulus ? std::isfinite(*biot_modulus) : compressibility.value_or(0) > 0;
  return pores_grow || (of_fluid > 0 && !is_zero(porosity));
}

laws::Mobility Flow::Rock::mobility(int dim, Real viscosity, const std::array<Real, 3>& x) const {
  auto k = tensor_at("permeability", permeability, dim, x);
  for (auto& row : k.value)
    for (Real& component : row) component /= viscosity;
  return k;
}

void Flow::Joint::describe(base::Section& s) {
  entry_of_place(s, residual_aperture, "residual aperture", "m", base::at_least(0),
                 "the hydraulic aperture, with \"Flow\", is not less than this");
  entry_of_place(
      s, tangential_permeability, "tangential permeability", "m^2", base::positive(),
      "k_t of the flow along the fracture, with \"Flow\"; without it the cubic law holds, (hydraulic aperture)^2/12");
  entry_of_place(s, normal_permeability, "normal permeability", "m^2", base::positive_or_infinite(),
                 "k_n of the flow across, with \"Flow\"; infinite: the fluid in the fracture has the pressure of that "
                 "beside it");
}

void FlowSection::describe(base::Section& s) {
  s.entry(rigid_rock, "rigid rock", "-", "the rock does not deform: flow alone, without displacements");
  s.entry(viscosity, "viscosity", "Pa*s", base::positive(), "mu of the fluid");
  s.entry(density, "density", "kg/m^3", base::at_least(0),
          "rho_0 of the fluid, at the reference pressure; its weight counts where \"Bulk\" has gravity");
  s.entry(compressibility, "compressibility", "Pa^-1", base::at_least(0),
          "c of the fluid: its density is rho_0 exp(c (p - reference pressure))");
  s.entry(reference_pressure, "reference pressure", "Pa", base::any(),
          "with a compressibility: where the density is as given; volumes of fluid are at this pressure");
  s.entry(source, "source", "s^-1", base::any(),
          "volume of fluid per volume of rock and time, an expression of x, y, z, t");
  entry_of_place(s, initial_pressure, "initial pressure", "Pa", base::any(),
                 "at the start, where fluid is stored; of x, y, z");
  s.choice(scheme, "scheme", {"auto", "rt0", "tpfa", "mimetic"},
           "how flows follow from pressures; auto: rt0 on simplices; on others tpfa where permeability and cells are "
           "orthogonal, else mimetic");
  s.named_sections(wells, "Wells", "by names of your choice");
}

void WellSection::describe(base::Section& s) {
  s.required(points, "points", "m", base::any(),
             "2D: x, y of a line of length 1 across the plane; 3D: of a polyline, x0, y0, z0, x1, y1, z1, ...");
  s.required(radius, "radius", "m", base::positive(), "r_w of the hole");
  s.entry(skin, "skin", "-", base::any(),
          "S: the pressure falls by S like flow by a further factor exp(S) of distance");
  s.entry(rate, "rate", "m^3/s", base::any(),
          "volume of fluid per time that is put in (2D: m^2/s), negative: taken out; an expression of t");
  s.entry(pressure, "pressure", "Pa", base::any(), "in the well at its first point, an expression of t");
  if (s.complete() && rate.has_value() == pressure.has_value()) s.fail("give either \"rate\" or \"pressure\"");
}

void Flow::Sections::describe(base::Section& s) { s.section(flow, "Flow", "a fluid that flows through the rock"); }

void Flow::Region::describe(base::Section& s) {
  s.entry(
      pressure, "pressure", "Pa", base::any(),
      "of the fluid in its cells and in fractures inside of it, with \"Flow\": a value or an expression of x, y, z, t");
}

std::vector<Prescribed> Flow::Region::prescribed() const {
  if (!pressure) return {};
  return {{"pressure", {*pressure}}, {"face pressure", {*pressure}}};
}

void Flow::Fracture::describe(base::Section& s) {
  s.entry(
      source, "source", "m/s", base::any(),
      "volume of fluid per area and time that is put into the fracture, with \"Flow\", an expression of x, y, z, t");
  s.entry(
      cuts, "cuts", "-",
      "names of fractures that it divides where they meet: what flows from one part to the other crosses it, by its "
      "normal permeability, with \"Flow\"");
}

void Flow::BoundaryCondition::describe(base::Section& s) {
  s.entry(pressure, "pressure", "Pa", base::any(),
          "of the fluid, with \"Flow\": a value or an expression of x, y, z, t; without a \"fracture\" and without a "
          "conductance it holds for rock and fractures, all else for rock");
  s.entry(flux, "flux", "m/s", base::any(), "volume of fluid that leaves per area and time, with \"Flow\"");
  entry_of_place(s, conductance, "conductance", "m/(Pa*s)", base::at_least(0),
                 "c: the flux is c (p - pressure), the pressure then being that beyond the boundary");
}

void Flow::Probe::describe(base::Section& s) {
  s.entry(well, "well", "-", "name of a well: all that results.json has of it");
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
