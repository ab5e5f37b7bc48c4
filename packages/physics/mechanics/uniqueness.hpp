// Joints whose law may have no solution or several, for fracture sets and single fractures with individual entries.
#pragma once

#include "physics/scene.hpp"

#include <string>

namespace sprekk::physics {

/// Message about the joint whose friction bound rises most with the compression, with a slope above 1; empty: none. The
/// slope is evaluated at compressions from G/1e5 to G/100. Examples without equilibrium and with several solutions are
/// known for slopes above about 1: Klarbring (1990).
std::string friction_doubt(const Scene& scene, const mesh::Mesh& mesh);

/// Message about the joint whose bound falls most with slip, relative to the compression N. It contains the least N at
/// which slip is unstable: -db/ds > 1/(L/G + 1/K_t), with the extent L of the domain. Excludes bonds. Empty without
/// such a joint, if this N exceeds G/100, or if properties depend on the position. Collective.
std::string weakening_doubt(const Scene& scene, const mesh::Mesh& mesh);
/// Message about bonds that soften faster than the rock unloads; empty: none. Opening: T/o_f > (lambda + 2 G)/L without
/// closure. Slip: c/s_f > G/L without tangential stiffness.
std::string bond_doubt(const Scene& scene, const mesh::Mesh& mesh);

/// Message about joints whose faces lose a cohesion at once when they open; empty: none. Collective.
std::string cohesion_doubt(const Scene& scene, const mesh::Mesh& mesh);

/// Message about a joint for which the solution may not be unique when slip reverses, with its dilation angle and the
/// largest angle without this effect; empty: none. Also empty if properties depend on the position, and for fractures
/// whose opening is not resisted by rock. In the latter case, e.g. at a free block, the load determines the normal
/// traction, and the bound does not fall.
///
/// Consider a block of height L with one fracture. Reversed slip dp lowers the shear traction by K_s dp. As dilation
/// closes the fracture, the friction bound falls by mu tan(theta) k dp, with
///   1/K_s = L/G + 1/K_t,   1/k = L/(lambda + 2G) + B',   B' <= 1/K_n (compliance of the closure).
/// mu and tan(theta) stand for the slopes of bound and dilation. If the bound falls faster, mu tan(theta)/K_s > 1/k,
/// some displacements admit stick, reversed slip and opening. L is the largest extent of the domain, B' = 1/K_n; of
/// several rocks, the largest G and the smallest lambda + 2G are used. Collective.
std::string dilation_doubt(const Scene& scene, const mesh::Mesh& mesh);

}  // namespace sprekk::physics
