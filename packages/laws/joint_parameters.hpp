// Laws and initial state of a joint.
#pragma once

#include "laws/joint.hpp"

#include <array>

namespace sprekk::laws {

/// Joint properties of a fracture.
struct JointParameters {
  Joint law;
  Real initial_aperture = 0;           ///< a0 of (15), m
  Real min_aperture = 0;               ///< residual aperture, m
  std::array<Real, 2> plastic_jump{};  ///< initial tangential plastic jump in the face frame, m
};

}  // namespace sprekk::laws
