// What the laws of a joint may ask about the point of a fracture that they are evaluated at.
#pragma once

#include "base/view.hpp"

#include <type_traits>

namespace sprekk::laws {

enum class ContactState : int { open = 0, stick = 1, slip = 2 };

/// x without derivatives.
template <class T>
KOKKOS_INLINE_FUNCTION Real value_of(const T& x) {
  if constexpr (std::is_arithmetic_v<T>) {
    return x;
  } else {
    return x.val();
  }
}

/// Numbers of one face, each `stride` after the one before.
template <class Number>
struct Numbers {
  Number* first = nullptr;
  long stride = 1;

  KOKKOS_INLINE_FUNCTION Number& operator[](int i) const { return first[i * stride]; }
  KOKKOS_INLINE_FUNCTION Numbers from(int i) const { return {first ? first + i * stride : nullptr, stride}; }
};

/// What a law has kept of a face, as it was at the end of the last step. All are 0 at the start.
using History = Numbers<const Real>;

/// A point of a joint; tension is positive, tangential vectors are (t1[, t2]) in the frame of the face. T carries
/// derivatives in jump and traction. Where the elastic part of the tangential jump is asked for, u_t^p, the slip of the
/// step and the separation are not yet known, and 0.
template <class T>
struct Contact {
  T lambda_n = 0;                  ///< normal traction, Pa: for the bound the projected one
  T shear = 0;                     ///< |lambda_t|, Pa
  T plastic_slip = 0;              ///< |u_t^p|, m
  T slip_of_step = 0;              ///< |u_t^p - last_plastic_jump|, m; of iterates also less than 0
  T separation = 0;                ///< w_n - g, m, by which the faces are apart; bonds alone may ask for it
  T friction_left = 1;             ///< what damage leaves of friction; for laws that apply it themselves
  T dilation_left = 1;             ///< the same of dilation
  T plastic_jump[2] = {0, 0};      ///< u_t^p, m
  T slip_direction[2] = {0, 0};    ///< unit vector of the step's slip, which is that of the shear traction
  T wear = 1;                      ///< k, by which slip counts in damage; damage alone may ask for it
  Real last_plastic_jump[2] = {};  ///< u_t^p at the end of the last step, m
  int dim = 2;                     ///< of space
  bool open = false;               ///< bears no traction; known at the end of a step alone
  Real rubs = 1;                   ///< the share of the step's slip that wears; below 1 at the end of a step alone
  History history = {};            ///< the numbers of the law that is asked

  /// Calls use(contact) with the numbers of a law that begin later by `offset`.
  template <class Use>
  KOKKOS_INLINE_FUNCTION auto after(int offset, const Use& use) const {
    if (offset == 0) return use(*this);
    Contact other = *this;
    other.history = history.from(offset);
    return use(other);
  }
};

}  // namespace sprekk::laws
