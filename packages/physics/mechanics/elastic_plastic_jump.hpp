// Elastic-plastic split of the displacement jump with contact and friction: rows of the contact traction.
#pragma once

#include "assembly/module.hpp"
#include "fields/properties.hpp"
#include "laws/elasticity.hpp"
#include "laws/joint_parameters.hpp"
#include "laws/joint_quantities.hpp"
#include "physics/mechanics/loads.hpp"
#include "physics/mechanics/prescribed_slip.hpp"

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace sprekk::physics {

struct ElasticPlasticJumpParameters {
  fields::Properties<laws::JointParameters> joints;  ///< of owned fracture faces, grouped by fractures
  fields::Properties<laws::Elasticity> elasticity;   ///< of local cells, grouped by regions
  InitialStress initial_stress = {};
  /// Factor of the augmentation constant, c / (E/L) with the size L of the fracture. Affects Newton's iterates, not
  /// solutions.
  Real augmentation = 0.3;
  FluidPressure fluid_pressure = {};
  Real start = 0;  ///< time of the initial state, s
  PrescribedSlips prescribed_slips = {};
  int n_history = 0;                                 ///< largest number of history variables per face, over all ranks
  bool depends_on_rate = false;                      ///< friction of any rank depends on the slip rate
  std::vector<laws::JointQuantity> quantities = {};  ///< quantities that joints of any rank provide
  std::string power_to = "";  ///< facet field whose fracture rows receive the power of SlidingFace; empty: none
};

/// Initial tractions of the contact in the frames of owned faces, Pa: those of InitialStress::of_fracture, elsewhere
/// the mean of sigma_0 n + alpha_f p n over both sides at a time. Zero without initial stress.
std::vector<std::array<Real, 3>> initial_tractions(const mesh::Mesh& mesh, const InitialStress& stress,
                                                   const FluidPressure& fluid, Real time);

/// Creates the module that declares the unknown "traction" lambda (fracture faces, frame n, t1[, t2], Pa; tension
/// positive). Its rows are the residual R(w, lambda) of laws/joint.hpp, Wollmann (2024), (9)-(14), with the jump
///   w = w_0 + mean over the face of R (u+ - u-),
/// including bubbles: shares of the nodes + mean(b) R (beta+ - beta-).
///
/// w_0 is the jump laws::start_of() of the joint under initial_tractions(), zero without initial stress. The initial
/// state is thus at rest if sigma_0 is in equilibrium and the tractions are those of the rock.
///
/// History variables:
/// - plastic tangential jump p_old [face, dim - 1], set to w_t on open faces, w_t - lambda_t/K_t on sliding faces and
///   to a prescribed slip, see laws/prescribed_jump.hpp;
/// - "slid" [face, 2]: 0 never, 1 in the last step, 2 before; energy dissipated by slip, J/m^2;
/// - "history of laws" [face, n_history], if any, updated by the laws;
/// - with these "runaway slip" [face, 1]: largest unstable slip of a step so far, see laws/runaway.hpp.
///
/// Outputs on fracture faces, local and global: total, elastic and plastic jump, traction; opening, slip, aperture
/// (15), contact state (0 open, 1 stick, 2 slip), "has slipped" (1 from the first slip on), mobilised strength
/// |lambda_t|/b. The quantities of laws are 0 on joints without these laws.
///
/// Outputs of fractures:
/// - slip tendency |lambda_t|/(-lambda_n) of the mean traction;
/// - moment M0 = integral of G |p - p_0|, N m (2D: per depth, N), with the mean G of both sides;
/// - in 3D the moment magnitude 2/3 (log10(M0/(N m)) - 9.1).
std::unique_ptr<assembly::Module> make_elastic_plastic_jump(const mesh::Mesh& mesh,
                                                            ElasticPlasticJumpParameters parameters);

}  // namespace sprekk::physics
