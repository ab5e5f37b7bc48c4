// Part of a residual that is constant during a step.
#pragma once

#include "base/host_table.hpp"

namespace sprekk::assembly {

/// Values [owned row] of one field.
class Load {
 public:
  explicit Load(LocalIndex n_rows = 0) : values_("load", n_rows) {}

  /// Sets all values to zero and calls fill(values) on the host.
  template <class Fill>
  void set(const Fill& fill) {
    const base::HostTable<Real*> table(values_);
    Kokkos::deep_copy(table.host(), 0.0);
    fill(table.host());
    table.on_device();
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
