// Joints whose law may have no state, or more than one: of sets of fractures, and of single fractures with entries of
// their own.
#pragma once

#include "physics/scene.hpp"

#include <string>

namespace sprekk::physics {

/// Names the joint whose friction bound rises most with the compression, by more than 1, and how much; empty without
/// such a joint. Laws are asked at compressions that rock is under, G/1e5 to G/100.
/// Above about 1 examples without equilibrium, and with several, are known: Klarbring (1990).
std::string friction_doubt(const Scene& scene, const mesh::Mesh& mesh);

/// Names the joint whose bound falls most with slip, relative to the compression N, and the N from which on it falls
/// faster than a block of the domain's extent L unloads, -db/ds > 1/(L/G + 1/K_t): there slip runs away. Bonds are left
/// out. Empty without such a joint, if that takes more than G/100, or if properties depend on the place. Collective.
std::string weakening_doubt(const Scene& scene, const mesh::Mesh& mesh);
/// The same of bonds, which soften faster than the rock unloads, by opening, T/o_f > (lambda + 2 G)/L without closure,
/// or by slip, c/s_f > G/L without tangential stiffness: in words, or "".
std::string bond_doubt(const Scene& scene, const mesh::Mesh& mesh);

/// Names a joint on reversal of whose slip the solution may not be unique, and its largest dilation angle; empty
/// without such a joint, if properties depend on the place, and of fractures whose opening no rock resists, as where
/// the load on a block that is free to move gives the normal traction: the bound does not fall then. In a block of
/// height L with one fracture, slip that turns back by dp lowers the shear traction by K_s dp and, since dilation
/// closes the fracture, friction's bound by mu tan(theta) k dp, with 1/K_s = L/G + 1/K_t and 1/k = L/(lambda + 2G) +
/// B', B' <= 1/K_n the compliance of the closure; mu and tan(theta) stand for the slopes of bound and dilation. Where
/// the bound falls faster, mu tan(theta)/K_s > 1/k, there are displacements for which sticking, slipping back and
/// opening all satisfy the law. L is the largest extent of the domain and B' = 1/K_n; of several rocks, the largest G
/// and the smallest lambda + 2G count. Collective.
std::string dilation_doubt(const Scene& scene, const mesh::Mesh& mesh);

}  // namespace sprekk::physics
