// Part of a residual that is constant during a step.
#pragma once

#include "base/types.hpp"

#include <string>

namespace sprekk::assembly {

/// Values [owned row] of one field.
class Load {
 public:
  explicit Load(LocalIndex n_rows = 0) : values_("load", n_rows) {}

  /// Sets all values to zero and calls fill(values) on the host.
  template <class Fill>
  void set(const Fill& fill) {
    const auto host = Kokkos::create_mirror_view(values_);
    Kokkos::deep_copy(host, 0.0);
    fill(host);
    Kokkos::deep_copy(values_, host);
  }

  /// Adds factor * values to the rows.
  void add_to(const View<Real*>& rows, Real factor = 1) const {
    const auto values = values_;
    Kokkos::parallel_for(
        "load", Kokkos::RangePolicy<Execution>(0, values.extent(0)),
        KOKKOS_LAMBDA(int i) { rows(i) += factor * values(i); });
  }

 private:
  View<Real*> values_;
};

}  // namespace sprekk::assembly
