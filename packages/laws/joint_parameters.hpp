// Laws and initial state of a joint.
#pragma once

#include "laws/joint.hpp"

#include <array>

namespace sprekk::laws {

/// Joint properties of a fracture.
struct JointParameters {
  Joint law;
  Real initial_aperture = 0;           ///< a0 of (15), m; of joints in situ before unloaded(): the measured aperture
  Real min_aperture = 0;               ///< residual aperture, m
  std::array<Real, 2> plastic_jump{};  ///< initial tangential plastic jump in the face frame, m
  bool in_situ = false;                ///< the history variables start from the initial traction and slip
  Real slip_path = 0;                  ///< path length of the initial slip of joints in situ, m; at least its size
};

}  // namespace sprekk::laws
