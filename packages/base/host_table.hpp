// Device tables with values set on the host.
#pragma once

#include "base/view.hpp"

#include <string>
#include <vector>

namespace sprekk::base {

/// Array in device memory whose values are set on the host. The values of a new array are zero.
template <class T>
class HostTable {
 public:
  template <class... Extents>
  explicit HostTable(const std::string& name, Extents... extents) : HostTable(View<T>(name, extents...)) {}
  /// Sets the values of an existing array. Until set, they are undefined.
  explicit HostTable(const View<T>& device) : device_(device), host_(Kokkos::create_mirror_view(device)) {}

  template <class... Indices>
  auto& operator()(Indices... indices) const {
    return host_(indices...);
  }
  std::size_t extent(int k) const { return host_.extent(k); }
  const typename View<T>::HostMirror& host() const { return host_; }

  /// Copies the values to the device. Returns the array there.
  const View<T>& on_device() const {
    Kokkos::deep_copy(device_, host_);
    return device_;
  }

 private:
  View<T> device_;
  typename View<T>::HostMirror host_;
};

/// Returns the array in host memory: a copy, or the array itself if it is there.
template <class Device>
auto to_host(const Device& device) {
  return Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), device);
}

/// Returns a copy of the values in device memory.
template <class T>
View<T*> to_device(const std::vector<T>& values, const std::string& name) {
  const HostTable<T*> table(name, values.size());
  for (std::size_t i = 0; i < values.size(); ++i) table(i) = values[i];
  return table.on_device();
}

}  // namespace sprekk::base
