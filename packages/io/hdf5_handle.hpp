// Shared HDF5 code of this package; not for other packages.
#pragma once

#include "base/check.hpp"

#include <hdf5.h>

#include <string>

namespace sprekk::io {

/// HDF5 identifier, closed by the destructor. Throws an Error if the identifier is invalid.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t), const std::string& what) : id_(id), close_(close) {
    SPREKK_CHECK(id >= 0, "HDF5: {} failed", what);
  }
  ~Handle() { close_(id_); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// Throws an Error if an HDF5 call has failed.
inline void check(herr_t status, const std::string& what) { SPREKK_CHECK(status >= 0, "HDF5: {} failed", what); }

/// Access properties of files in memory.
inline hid_t in_memory() {
  constexpr std::size_t increment = 1 << 20;  // byte
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_fapl_core(access, increment, false);
  return access;
}

/// Returns the bytes of a file in memory.
inline std::string image_of(hid_t file) {
  check(H5Fflush(file, H5F_SCOPE_GLOBAL), "a file in memory");
  const auto size = H5Fget_file_image(file, nullptr, 0);
  check(size < 0 ? -1 : 0, "a file in memory");
  std::string content(size, '\0');
  check(H5Fget_file_image(file, content.data(), size) < 0 ? -1 : 0, "a file in memory");
  return content;
}

}  // namespace sprekk::io
