// Joint without damage.
#pragma once

#include "laws/contact.hpp"
#include "laws/kinds.hpp"

namespace sprekk::laws {

/// Remaining fractions of friction and dilation; 1: undamaged.
template <class T>
struct Left {
  T friction = 1, dilation = 1;
};

/// Joint without damage: both fractions are 1.
struct NoDamage {
  static constexpr const char *name = "none", *meaning = "no wear of friction and dilation";
  static std::vector<Parameter<NoDamage>> parameters() { return {}; }

  template <class T>
  KOKKOS_INLINE_FUNCTION Left<T> left(const Contact<T>&) const {
    return {};
  }
};

}  // namespace sprekk::laws
