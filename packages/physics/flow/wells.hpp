// Wells: lines from which fluid flows into cells of the rock and fractures, or back.
#pragma once

#include "assembly/module.hpp"
#include "base/expression.hpp"
#include "laws/conduit.hpp"
#include "laws/fluid.hpp"
#include "physics/flux_scheme.hpp"
#include "physics/physics.hpp"

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace sprekk::physics {

struct Well {
  std::string name;
  std::vector<std::array<Real, 3>> points;   ///< 3D: of a polyline; 2D: one, of a line of length 1 across the plane
  Real radius, skin;                         ///< m, -
  std::optional<base::Expression> rate;      ///< volume per time at reference conditions that it puts in, m^3/s; or
  std::optional<base::Expression> pressure;  ///< in the well at its first point, Pa
};

struct WellsParameters {
  std::vector<Well> wells;
  Properties<laws::Mobility> mobility;  ///< as in HybridDiffusionParameters, and the following
  FluxScheme scheme = FluxScheme::rt0;
  laws::Fluid fluid = {};
  std::array<Real, 3> weight{};
  std::vector<laws::Conduit> faces = {};  ///< [local fracture face]
  std::vector<Carried> carried = {};      ///< what their fluid carries, see Brought
};

/// Adds -W (p_w - p) to the rows of "pressure" of cells that a well runs through and of "face pressure" of fracture
/// faces that it crosses (2D: lies on), of a compressible fluid -W (e_w - e)/c. In a cell
///   W = 2 pi k_w L/(ln(r_0/r_w) + skin)
/// with the length L of the well in it, k_w = LineFlow::conductance and the equivalent radius r_0 of the cell, see
/// log_equivalent_radius(); in a fracture likewise with its transmissivity T for k_w L, of one that widens the present
/// one, or that of State::coefficients; in 2D, where flow in the fracture is along a line, W = 2 T/((1 + skin) r_w).
/// p_w is the pressure at the first point plus the weight of fluid at rest between there and the middle of what is in
/// the cell. A well with a rate puts it in by the shares of W at the start of the step, as if it drew all cells down by
/// the same. Where what the fluid carries changes it, W is times d m at the cell or face, see laws::FluidResponse, and
/// the fluid in a well as heavy as what it puts in, else as rho_0. Lengths do not depend on the partition, and a well
/// in a face between cells counts once: wells are moved by 1e-9 of the domain's extent, in a direction that no face
/// has. Errors, on every rank: a well leaves the domain, lies in a fracture, or is as wide as an equivalent radius.
/// Totals: "wells", the name, then "rate", "pressure" (of a well with a rate the mean by shares), "in rock" and "in
/// FRACTURE", rates; and of what is carried by the name of its field its value in the fluid that is put in or taken
/// out, the mean by shares, and as Carried::total c q u, the rate that is put in.
std::unique_ptr<assembly::Module> make_wells(WellsParameters parameters);

}  // namespace sprekk::physics
