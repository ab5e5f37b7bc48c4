// Mechanical dispersion of a tracer in rock and fractures.
#pragma once

#include "assembly/module.hpp"
#include "fields/properties.hpp"
#include "laws/darcy.hpp"
#include "physics/tracer/tracer.hpp"

#include <array>
#include <memory>
#include <vector>

namespace sprekk::physics {

struct DispersionParameters {
  fields::Properties<laws::Mobility> mobility;  ///< k/mu of local cells, m^2/(Pa s)
  fields::Properties<Dispersivity> of_rock;     ///< of local cells
  std::vector<Real> transmissivity;             ///< [local fracture face], m^3/(Pa s)
  std::vector<Dispersivity> of_fractures;       ///< [local fracture face]
  std::array<Real, 3> weight{};                 ///< rho_0 g, N/m^3
};

/// Creates the module that adds the flows of Fick's law with the dispersion tensor (Scheidegger 1961)
///   D = alpha_T |u| I + (alpha_L - alpha_T) u u^T/|u|
/// to the rows of "concentration" and "face concentration". u is the Darcy velocity -(k/mu) (G p - rho_0 g) with the
/// gradient G p = sum_j A_j p_j/V of the pressures on the faces; in fractures it is multiplied by the aperture. The
/// flows of a cell or fracture face K are those of the scheme of Eymard, Gallouet and Herbin (2010), which is linear in
/// D and also defined for a singular D:
///   sum_i q_i (c_K - c_i) = sum_i V_i g_i . D g_i,  g_i = G c + sqrt(d) A_i/(A_i . d_i) (c_i - c_K - G c . d_i),
/// with V_i = A_i . d_i/d and G c = sum_j A_j (c_j - c_K)/V. The scheme is exact for constant gradients on cells with
/// plane faces.
std::unique_ptr<assembly::Module> make_dispersion(mesh::Shape shape, DispersionParameters parameters);

}  // namespace sprekk::physics
