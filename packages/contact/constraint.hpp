// Contact constraints of fracture faces, and modifications of the face law during a solve.
#pragma once

#include "base/types.hpp"
#include "mesh/facets.hpp"

#include <array>
#include <optional>

namespace sprekk::contact {

/// Names of the contact states of a face, in the order of their numbers.
inline constexpr const char* state_names[] = {"open", "stick", "slip"};

/// Contact constraint of a fracture face at a state.
struct Constraint {
  std::array<mesh::Vector, 3> constrained{};  ///< rows: constrained directions of the jump, global frame; zero: open
  mesh::Vector resisted{};                    ///< direction of the jump that also other terms resist, global frame
  mesh::Vector excess{};                      ///< traction unknown minus the traction of the law, Pa, global frame
  mesh::Vector traction{}, jump{};            ///< Pa, m, global frame
  Real augmentation = 0;                      ///< augmentation constant c of the face law, Pa/m
  Real modulus = 0;                           ///< Young's modulus of the softer side, Pa
  Real gap = 0;                               ///< distance of the sides from contact without traction, m
  mesh::Vector away{};                        ///< derivative of the gap with respect to the jump
  bool weakens = false;                       ///< the law has history variables; slip may reduce the friction bound
  Real limit = 0;                             ///< friction bound: largest tangential traction, Pa
  mesh::Vector slip{};  ///< plastic tangential jump since the last accepted state, m, global frame
};

/// Supported displacement unknown, or component of the displacement of a node.
struct Support {
  LocalIndex unknown;  ///< owned; one of the node
  int component;
  std::optional<mesh::Vector> direction = {};  ///< unit vector of the support, in place of the axis of the component
};

/// Modifications of the face laws for the convergence of Newton's method. Solutions depend on the proximal term only.
struct Regularisation {
  ConstView<Real*> damping = {};       ///< [owned fracture face], see Globalisation::damp(); empty: zero
  ConstView<Real*> augmentation = {};  ///< [owned fracture face] factor, see Globalisation::calibrate(); empty: 1
  Real proximal = 0;                   ///< see Globalisation::set_proximal_term()
  ConstView<Real**> anchor = {};       ///< [owned fracture face, 2 dim] jump at rest, traction there; global frame
};

}  // namespace sprekk::contact
