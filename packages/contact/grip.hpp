// How the sides of fracture faces hold each other, and what is changed about it on the way to a solution.
#pragma once

#include "base/types.hpp"
#include "mesh/facets.hpp"

#include <array>

namespace sprekk::contact {

/// How the sides of a fracture face hold each other.
struct Grip {
  std::array<mesh::Vector, 3> held{};  ///< rows: jumps that are zero in all of them meet no resistance, global frame
  mesh::Vector excess{};  ///< what the traction, an unknown, is above the one that the law answers with, Pa, global
  mesh::Vector traction{}, jump{};  ///< Pa, m, global
  Real augmentation = 0;            ///< c of the face law, Pa/m
  Real modulus = 0;                 ///< Young's modulus of the softer side, Pa
  Real gap = 0;                     ///< how far the sides are from touching without traction, m
  mesh::Vector away{};              ///< derivative of the gap in the jump
  bool weakens = false;             ///< the law has history variables; slip may reduce the friction bound
  Real limit = 0;                   ///< of friction, on the size of the tangential traction, Pa
  mesh::Vector slip{};              ///< plastic tangential jump since the last accepted state, m, global
};

/// An unknown of the displacement that is held.
struct Support {
  LocalIndex unknown;  ///< owned
  int component;
};

/// What faces are told so that Newton's method converges; solutions do not depend on it, but for the tether.
struct Regularisation {
  ConstView<Real*> damping = {};       ///< [owned fracture face], see Globalisation::damp(); empty: zero
  ConstView<Real*> augmentation = {};  ///< [owned fracture face] factor, see Globalisation::calibrate(); empty: 1
  Real tether = 0;                     ///< see Globalisation::tether()
  ConstView<Real**> anchor = {};       ///< [owned fracture face, 2 dim] jump that it pulls to, traction there; global
};

}  // namespace sprekk::contact
