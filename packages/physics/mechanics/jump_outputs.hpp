// Outputs of the jumps of fractures.
#pragma once

#include "laws/joint_points.hpp"
#include "physics/mechanics/elastic_plastic_jump.hpp"

#include <functional>

namespace sprekk::physics {

/// Joint of a face at the end of a step. `prescribed`: its slip is given, also if it is open. The state of a face that
/// slid in the step is on the friction limit of its present plastic jump.
template <int dim>
struct JumpOfFace {
  const mesh::Mesh::FractureFace& face;
  const laws::JointPoint<dim>& point;
  laws::ContactState state;
  Real elastic[dim], plastic[dim], slip, slip_since_start, aperture, mobilised = 0;
  laws::Contact<Real> at;
  bool has_slipped = false;  ///< in this step or before
  int number = 0;            ///< of the joint in ElasticPlasticJumpParameters
  Real shear_modulus = 0;    ///< mean of both sides, Pa
  Real runaway = 0;          ///< history variable "runaway slip", m
  Real friction_work = 0;    ///< energy dissipated by slip, J/m^2

  JumpOfFace(const mesh::Mesh::FractureFace& face, const laws::JointPoint<dim>& point,
             const laws::JointParameters& joint, bool slid, const laws::History& history, bool prescribed);
};

/// Calls use(jump) for each owned fracture face.
template <int dim>
using ForEachJump = std::function<void(const assembly::State&, const std::function<void(const JumpOfFace<dim>&)>& use)>;

/// Declares the outputs of make_elastic_plastic_jump().
template <int dim>
void declare_jump_outputs(const ElasticPlasticJumpParameters& parameters, const ForEachJump<dim>& for_each,
                          assembly::Declaration& d);

}  // namespace sprekk::physics
