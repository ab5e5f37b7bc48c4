// What the laws of a joint may ask about the point of a fracture that they are evaluated at.
#pragma once

#include "base/types.hpp"

namespace sprekk::laws {

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
/// derivatives in jump and traction.
template <class T>
struct Contact {
  T lambda_n = 0;                  ///< normal traction, Pa: for the bound the projected one, which is not positive
  T plastic_slip = 0;              ///< |u_t^p|, m; not yet known, 0, where the elastic part is asked for
  T plastic_jump[2] = {0, 0};      ///< u_t^p, m; the same
  Real last_plastic_jump[2] = {};  ///< u_t^p at the end of the last step, m
  History history = {};            ///< the numbers of the law that is asked

  /// The same for a law whose numbers begin later by `offset`.
  KOKKOS_INLINE_FUNCTION Contact after(int offset) const {
    Contact other = *this;
    other.history = history.from(offset);
    return other;
  }
};

}  // namespace sprekk::laws
