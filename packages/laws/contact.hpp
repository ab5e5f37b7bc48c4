// Contact quantities at a point of a fracture: the arguments of the joint laws.
#pragma once

#include "base/view.hpp"

#include <type_traits>

namespace sprekk::laws {

enum class ContactState : int { open = 0, stick = 1, slip = 2 };

/// Value of x without derivatives.
template <class T>
KOKKOS_INLINE_FUNCTION Real value_of(const T& x) {
  if constexpr (std::is_arithmetic_v<T>) {
    return x;
  } else {
    return x.val();
  }
}

/// Strided array of numbers of one face; `stride` is the distance of consecutive numbers.
template <class Number>
struct Numbers {
  Number* first = nullptr;
  long stride = 1;

  KOKKOS_INLINE_FUNCTION Number& operator[](int i) const { return first[i * stride]; }
  KOKKOS_INLINE_FUNCTION Numbers from(int i) const { return {first ? first + i * stride : nullptr, stride}; }
};

/// History variables of a law on a face at the end of the last step. They start at 0; for those of joints in situ see
/// joint_start.hpp.
using History = Numbers<const Real>;

/// Contact quantities at a point of a joint. Tension is positive. Tangential vectors are (t1[, t2]) in the face frame.
/// T carries derivatives with respect to jump and traction. For the elastic compliance, u_t^p, the slip of the step and
/// the separation are 0: they are not yet known.
template <class T>
struct Contact {
  T lambda_n = 0;                  ///< normal traction, Pa; for the bound the projected one
  T shear = 0;                     ///< |lambda_t|, Pa
  T plastic_slip = 0;              ///< |u_t^p|, m
  T slip_of_step = 0;              ///< |u_t^p - last_plastic_jump|, m; may be negative in iterates
  T separation = 0;                ///< w_n - g, m; for bonds only
  T friction_left = 1;             ///< friction factor of damage; for laws with `takes_damage`
  T dilation_left = 1;             ///< dilation factor of damage; likewise
  T plastic_jump[2] = {0, 0};      ///< u_t^p, m
  T slip_direction[2] = {0, 0};    ///< unit vector of the slip of the step, parallel to the shear traction
  T wear = 1;                      ///< k, damage per unit of slip; for damage only
  Real last_plastic_jump[2] = {};  ///< u_t^p at the end of the last step, m
  int dim = 2;                     ///< dimension of space
  bool open = false;               ///< no traction; known at the end of a step only
  Real rubs = 1;                   ///< share of the step's slip that wears; below 1 at the end of a step only
  History history = {};            ///< history variables of the called law
  Real duration = 0;               ///< length of the step, s; 0 outside of a step

  /// Returns use(contact), where the history variables of `contact` begin `offset` numbers later.
  template <class Use>
  KOKKOS_INLINE_FUNCTION auto after(int offset, const Use& use) const {
    if (offset == 0) return use(*this);
    Contact other = *this;
    other.history = history.from(offset);
    return use(other);
  }
};

/// Errors of a step by friction that depends on the slip rate: of the slip rate, by its effect on slip and friction; of
/// the logarithm of the state; of the growth of instabilities. Negative: unknown.
struct StepDefect {
  Real rate = 0, state = 0, growth = 0;
};

}  // namespace sprekk::laws
