// Stress intensity factors of crack fronts.
#pragma once

#include "estimate/state_table.hpp"
#include "physics/physics.hpp"

#include <memory>

namespace sprekk::physics {

/// Creates the table of stress intensity factors at the front points (mesh::FrontPoint) of the fractures with "stress
/// intensity"; null without such fractures. Columns: tip (node), x, y[, z], K_I, K_II[, K_III], G, those of the second
/// estimate with `_of_jump`, `error`, and `radius` of the domain.
///
/// K_I, K_II and K_III are interaction integrals (Gosz and Moran 2002) of the displacement u_h of nodes and tips with
/// crack fields v (crack_fields()) of unit intensity, over the cells around a front point:
///   I = integral [ s_ij v_i,k q_k,j + s(v)_ij u_i,k q_k,j - s_ij v_i,j q_k,k ] + integral s(v)_ij,j u_i,k q_k
///       - integral (F_i + sigma_0ij,j) v_i,k q_k + integral e (v_j,k q_k,j + q_k v_j,jk)
///       + integral over faces t_i [[v_i,k]] q_k,
/// K_I = I E'/(2 L), K_II likewise, K_III = I G/L. s: elastic stress of u_h; q: weight times the direction ahead of the
/// front; L: its integral along the front; F: body force; sigma_0: initial stress; e: isotropic stress of pores and
/// expansion, Pa; t: traction on side minus, along the normal from minus to plus, minus sigma_0 n. t includes contact
/// and fluid. Traction-free crack fields have no other contribution of faces. On sides of the domain that the front
/// meets, the integral of the flux is subtracted.
///
/// Signs: K_I > 0 opens, K_II > 0 moves side plus ahead, K_III > 0 moves it along the front, ahead x normal. G =
/// (K_I^2 + K_II^2)/E' + K_III^2/(2 shear modulus).
///
/// Second estimate: mean jumps of the faces at the front point, as if they were of the crack fields, [[u]] = 8 K/E'
/// sqrt(r/(2 pi)). error = |K - K of the second estimate|, over all modes.
///
/// With a "toughness", in 2D: columns K_hoop and kink_x, kink_y, the intensity of the largest hoop stress and its
/// direction (laws::largest_hoop()), and `toughness` at the tip. With a "strength": `crossing`, see
/// front::margin_of_crossing().
///
/// Throws an Error for periodic meshes, and after changes of elastic constants or a backfill. Collective.
std::unique_ptr<estimate::TableOfStates> make_stress_intensity(const Setting& setting, assembly::System& system);

}  // namespace sprekk::physics
