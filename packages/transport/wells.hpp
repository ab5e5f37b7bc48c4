// Wells: lines that exchange fluid with cells and fracture faces.
#pragma once

#include "assembly/module.hpp"
#include "base/expression.hpp"
#include "laws/conduit.hpp"
#include "laws/fluid.hpp"
#include "transport/carried.hpp"
#include "transport/flux_scheme.hpp"

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sprekk::transport {

struct Well {
  std::string name;
  std::vector<std::array<Real, 3>> points;   ///< 3D: points of a polyline; 2D: one point of a line of length 1 across
                                             ///< the plane
  Real radius, skin;                         ///< m, -
  std::optional<base::Expression> rate;      ///< injected volume per time at reference conditions, m^3/s; or
  std::optional<base::Expression> pressure;  ///< pressure in the well at its first point, Pa
};

struct WellsParameters {
  std::vector<Well> wells;
  fields::Properties<laws::Mobility> mobility;  ///< this and the following as in HybridDiffusionParameters; no values:
                                                ///< impermeable rock, wells are connected to fractures only
  FluxScheme scheme = FluxScheme::rt0;
  FluxScheme in_fractures = FluxScheme::rt0;
  laws::Fluid fluid = {};
  std::array<Real, 3> weight{};
  std::vector<laws::Conduit> faces = {};  ///< [local fracture face]
  std::vector<Carried> carried = {};      ///< quantities that the fluid transports, see InjectedQuantity
};

/// Creates the module of the wells. It adds -W (p_w - p) to the rows of "pressure" of cells that contain a part of a
/// well, and to the rows of "face pressure" of fracture faces that a well crosses (2D: lies on). For a compressible
/// fluid the term is -W (e_w - e)/c.
///
/// | connection        | W                               |
/// | cell              | 2 pi k_w L/(ln(r_0/r_w) + skin) |
/// | fracture face, 3D | 2 pi T/(ln(r_0/r_w) + skin)     |
/// | fracture face, 2D | T/((1 + skin) r_w/2 + d)        |
///
/// d = h/6 with the size h of the face represents the drop from the centre to the mean; tpfa: d = 0.
/// L is the length of the well in the cell, and k_w = LineFlow::conductance. r_0 is the equivalent radius, see
/// log_equivalent_radius(). T is the present transmissivity, or that of State::coefficients. The pressure p_w is that
/// at the first point plus the hydrostatic pressure difference to the centre of the cell.
///
/// * A rate is distributed in proportion to W at the start of the step, which corresponds to a uniform drawdown.
/// * A transported field that changes the fluid multiplies W by d m of the cell or face, see laws::FluidResponse. The
///   fluid column in a well has the density of the injected fluid, or rho_0 if its u is not given.
/// * Wells are shifted by 1e-9 of the domain size in a direction that no face has. Lengths are then independent of the
///   partition, and a well in a face between cells counts once.
///
/// Throws an Error on every rank if a well leaves the domain, lies in the plane of a fracture (3D), or has a radius of
/// r_0 exp(skin) or more.
///
/// Totals: "wells", the name, then "rate", "pressure" (for wells with a rate the mean weighted by W), and the rates "in
/// rock" and "in FRACTURE". For each transported quantity: the field name, with the weighted mean of u in the injected
/// or extracted fluid, and Carried::total, with the injection rate c q u.
std::unique_ptr<assembly::Module> make_wells(WellsParameters parameters);

}  // namespace sprekk::transport
