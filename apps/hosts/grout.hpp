// A module of a host, with an unknown of its own: grout that is sealed in the fractures.
#pragma once

#include "assembly/module.hpp"

#include <memory>
#include <string>

namespace hosts {

struct GroutParameters {
  sprekk::Real thickness;     ///< h, m, at zero displacement
  sprekk::Real bulk_modulus;  ///< K, Pa
  /// With contact: p is eliminated face by face. Empty: it stays in the linear system beside the displacement.
  std::string local_group = "fracture face";
};

/// Grout in all fractures that pushes their sides apart with p = -K w_n/h, w_n the mean normal displacement jump of a
/// face. Declares the unknown "grout pressure" p (fracture faces; Pa) and adds with the face's area |f|
///   displacement and side bubble rows  - |f| p n . (mean(v+) - mean(v-))
///   grout pressure rows                - |f| (w_n + h p/K)
/// so that the Jacobian is symmetric. Output: "grout pressure".
std::unique_ptr<sprekk::assembly::Module> make_grout(sprekk::mesh::Shape shape, const GroutParameters& parameters);

}  // namespace hosts
