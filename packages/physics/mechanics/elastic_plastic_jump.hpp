// Elastic-plastic split of the displacement jump with contact and friction: rows of the contact traction.
#pragma once

#include "assembly/module.hpp"
#include "laws/elasticity.hpp"
#include "laws/joint.hpp"
#include "laws/joint_quantities.hpp"
#include "physics/mechanics/loads.hpp"

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace sprekk::physics {

/// The joint of one fracture.
struct JointParameters {
  laws::Joint law;
  Real initial_aperture = 0;           ///< a0 of (15), m
  Real least_aperture = 0;             ///< that is left however far the sides close, m
  std::array<Real, 2> plastic_jump{};  ///< tangential, at the start, in the frame of the face, m
};

struct ElasticPlasticJumpParameters {
  std::vector<JointParameters> joints;       ///< different ones
  std::vector<laws::Elasticity> elasticity;  ///< of the rock, for the size of the augmentation only
  InitialStress initial_stress = {};
  std::vector<int> elasticity_of_cell = {};  ///< [local cell] which elasticity; empty: the number of the cell's region
  std::vector<int> joint_of_face = {};  ///< [owned fracture face] which joint; empty: the number of the face's fracture
  /// c / (E/L) with L the size of the fracture: steers Newton's iterates, has no influence on solutions.
  Real augmentation = 0.3;
  FluidPressure fluid_pressure = {};
  Real start = 0;  ///< time of the initial state, s
  int n_kept = 0;  ///< how many numbers the joints of any rank keep of a face, at most
  std::vector<laws::JointQuantity> quantities = {};  ///< that joints of any rank tell
  std::string power_to =
      "";  ///< field on facets whose rows of fracture faces get what SlidingFace dissipates; empty: none
};

/// mean(sigma_0 n) + p n in the frames of owned faces, Pa, of both sides in the mean; zero without initial stress.
std::vector<std::array<Real, 3>> initial_tractions(const mesh::Mesh& mesh,
                                                   const ElasticPlasticJumpParameters& parameters);

/// w_0 of make_elastic_plastic_jump in the frames of owned fracture faces, m.
std::vector<std::array<Real, 3>> initial_jumps(const mesh::Mesh& mesh, const ElasticPlasticJumpParameters& parameters);

/// Declares the unknown "traction" lambda (fracture faces, frame n, t1[, t2], Pa; tension positive) and writes in its
/// rows the residual R(w, lambda) of laws/joint.hpp, Wollmann (2024), (9)-(14), with the jump
///   w = w_0 + mean over the face of R (u+ - u-), bubbles included: shares of the nodes + mean(b) R (beta+ - beta-).
/// w_0 is the jump that the joint has under the initial stress after the plastic jump p_0 that it starts with,
/// (g0 + tan(theta) |p_0| + B(lambda_n), p_0 + lambda_t/K_t) with lambda =
/// mean(sigma_0 n) + p n, of both sides in the mean, p the fluid's pressure at the start, so that the initial state is
/// one of rest where sigma_0 is in equilibrium; zero without initial stress. History: the plastic tangential jump p_old
/// [face, dim - 1]; committed to w_t where the face is open, kept where it sticks, w_t - lambda_t/K_t where it slips;
/// "kept by laws" [face, n_kept], if there are any, which the laws themselves commit, and then "runaway slip" [face,
/// 1]: the largest slip so far that ran away in a step, see runaway.hpp. Outputs on fracture faces, local and global:
/// total, elastic and plastic jump, traction; opening, slip, aperture (15), contact state (0 open, 1 stick, 2 slip),
/// slip tendency |lambda_t|/b. Of fractures, from their mean traction, the slip tendency |lambda_t|/-lambda_n; the
/// moment M0 = integral of G |p - p_0|, N m (2D: per depth, N), G the mean of both sides; in 3D the moment magnitude
/// 2/3 (log10(M0/(N m)) - 9.1). The quantities that laws tell, 0 where the joint has none of these laws.
std::unique_ptr<assembly::Module> make_elastic_plastic_jump(const mesh::Mesh& mesh,
                                                            ElasticPlasticJumpParameters parameters);

}  // namespace sprekk::physics
