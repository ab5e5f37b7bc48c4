// Momentum of the functions that enrich the displacement around crack tips.
#pragma once

#include "physics/mechanics/bulk_momentum.hpp"

namespace sprekk::physics {

/// Adds the field "tip displacement" q, one vector per enriched node (mesh::Mesh::enriched), m:
///   u = sum_a N_a u_a + sum_c psi_c q_c,   psi_c = N_c (rho^(-1/2) - 1)   around tips, see assembly::TipCell,
/// and to the momentum rows of u, q and side bubbles what follows from it in
///   integral sigma(u) : grad v + sum_f |f| lambda_f . mean_f(R [[v]]) = loads(v).
/// The rows of q hold all loads of the bulk and of the fluid. q is zero where displacements are prescribed on a face
/// with a tip. Outputs it (nodes, m; zero elsewhere). Cells of order 1. Parameters are those of the bulk.
std::unique_ptr<assembly::Module> make_tip_enrichment(mesh::Shape shape, BulkMomentumParameters parameters,
                                                      FluidPressure fluid_pressure = {});

}  // namespace sprekk::physics
