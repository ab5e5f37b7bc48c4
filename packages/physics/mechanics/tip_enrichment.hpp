// Momentum balance of the functions that enrich the displacement around crack tips.
#pragma once

#include "physics/mechanics/bulk_momentum.hpp"

namespace sprekk::physics {

/// Creates the module that declares the field "tip displacement" q, m, one vector per enriched node
/// (mesh::Mesh::enriched):
///   u = sum_a N_a u_a + sum_c psi_c q_c,   psi_c = N_c (rho^(-1/2) - 1)   around tips, see assembly::TipCell.
/// It adds the corresponding terms of
///   integral sigma(u) : grad v + sum_f |f| lambda_f . mean_f(R [[v]]) = loads(v)
/// to the momentum rows of u, q and side bubbles. The rows of q contain all loads of the bulk and of the fluid. q is
/// zero where displacements are prescribed on a face with a tip. Output: q (nodes, m; zero elsewhere). Parameters:
/// those of the bulk. Throws an Error unless cells are of order 1.
std::unique_ptr<assembly::Module> make_tip_enrichment(mesh::Shape shape, BulkMomentumParameters parameters,
                                                      FluidPressure fluid_pressure = {});

}  // namespace sprekk::physics
