// Energy balance of rock that conducts and stores heat: rows of the temperature and of the temperature on faces.
#pragma once

#include "assembly/module.hpp"
#include "base/expression.hpp"
#include "physics/hybrid_cell.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace sprekk::physics {

/// Fourier's law q = -K grad T: K, W/(m K), a tensor like that of Darcy's law.
using Conductivity = laws::Mobility;

/// Heat that leaves through a boundary: power per area, W/m^2; or with a coefficient h, W/(m^2 K), h (T - value), the
/// value being the temperature beyond, K.
struct HeatCondition {
  int boundary;
  base::Expression value;
  std::optional<base::Expression> coefficient = {};
  int region = -1;  ///< only on faces of cells of this region; -1: all
};

struct HeatConductionParameters {
  std::vector<Conductivity> conductivity;  ///< different ones
  std::vector<int> conductivity_of_cell;   ///< [local cell] which of them; empty: the number of the cell's region
  std::vector<Real> capacity;              ///< [region] rho c, J/(m^3 K)
  FluxScheme scheme = FluxScheme::rt0;
  std::vector<base::Expression> source = {};  ///< power per volume, W/m^3; empty or one
  base::Expression initial = 0;               ///< temperature at the start, K
  std::vector<HeatCondition> conditions = {};
  bool in_regions = false;  ///< temperatures of cells are prescribed: they stay in linear solves
};

/// Declares the unknowns "temperature" (cells, K) and "face temperature" (facets, K). Rows of cells: the heat that
/// flows out through the faces, V rho c (T - T_old)/dt, less the source, W (2D: W/m); rows of facets: what leaves the
/// cells beside them is what crosses the boundary. Flows as in HybridCell, with conductivity for k/mu. History: what
/// the temperature has gained since the start. Outputs on cells: temperature, heat flux.
std::unique_ptr<assembly::Module> make_heat_conduction(mesh::Shape shape, HeatConductionParameters parameters);

}  // namespace sprekk::physics
