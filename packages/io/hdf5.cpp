#include "io/hdf5.hpp"

#include "base/check.hpp"

#include <hdf5.h>

namespace sprekk::io {

namespace {

/// An identifier of HDF5, closed in the end.
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

void check(herr_t status, const std::string& what) { SPREKK_CHECK(status >= 0, "HDF5: {} failed", what); }

/// Access to files that are in memory only.
hid_t in_memory() {
  constexpr std::size_t increment = 1 << 20;  // byte
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_fapl_core(access, increment, false);
  return access;
}

void write(hid_t group, const char* name, hid_t type, const void* data, hsize_t n) {
  const Handle space(H5Screate_simple(1, &n, nullptr), H5Sclose, "a data space");
  const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "properties");
  check(H5Pset_obj_track_times(properties, false), "properties");  // the same values make the same file
  const Handle set(H5Dcreate2(group, name, type, space, H5P_DEFAULT, properties, H5P_DEFAULT), H5Dclose, name);
  if (n > 0) check(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data), name);
}

template <class T>
void append(hid_t group, const char* name, hid_t type, std::vector<T>& to) {
  const Handle set(H5Dopen2(group, name, H5P_DEFAULT), H5Dclose, name);
  const Handle space(H5Dget_space(set), H5Sclose, "a data space");
  const hssize_t n = H5Sget_simple_extent_npoints(space);
  check(n < 0 ? -1 : 0, "the size of a data set");
  to.resize(to.size() + n);
  if (n > 0) check(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, to.data() + to.size() - n), name);
}

}  // namespace

std::string to_hdf5(const NamedVectors& vectors) {
  const Handle access(in_memory(), H5Pclose, "access in memory");
  const Handle file(H5Fcreate("vectors", H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose, "a file in memory");
  for (const auto& [name, vector] : vectors) {
    const Handle group(H5Gcreate2(file, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, name);
    const auto numbers = vector->getMap()->getNodeElementList();
    const auto values = vector->getData();
    write(group, "numbers", H5T_NATIVE_LLONG, numbers.getRawPtr(), numbers.size());
    write(group, "values", H5T_NATIVE_DOUBLE, values.getRawPtr(), values.size());
  }
  check(H5Fflush(file, H5F_SCOPE_GLOBAL), "a file in memory");
  const auto size = H5Fget_file_image(file, nullptr, 0);
  check(size < 0 ? -1 : 0, "a file in memory");
  std::string content(size, '\0');
  check(H5Fget_file_image(file, content.data(), size) < 0 ? -1 : 0, "a file in memory");
  return content;
}

void from_hdf5(const std::string& content, const std::string& name, std::map<std::string, NumberedValues>& values) {
  const Handle access(in_memory(), H5Pclose, "access in memory");
  check(H5Pset_file_image(access, const_cast<char*>(content.data()), content.size()), name);  // copied
  const std::string in_memory_only = name + "/image";  // HDF5 refuses an image by the name of a file that exists
  const Handle file(H5Fopen(in_memory_only.c_str(), H5F_ACC_RDONLY, access), H5Fclose, name);
  H5G_info_t root;
  check(H5Gget_info(file, &root), name);
  for (hsize_t k = 0; k < root.nlinks; ++k) {
    const auto link = [&](char* text, std::size_t size) {
      return H5Lget_name_by_idx(file, ".", H5_INDEX_NAME, H5_ITER_INC, k, text, size, H5P_DEFAULT);
    };
    const auto length = link(nullptr, 0);
    check(length < 0 ? -1 : 0, name);
    std::string key(length, '\0');
    link(key.data(), length + 1);
    const Handle group(H5Gopen2(file, key.c_str(), H5P_DEFAULT), H5Gclose, key);
    append(group, "numbers", H5T_NATIVE_LLONG, values[key].numbers);
    append(group, "values", H5T_NATIVE_DOUBLE, values[key].values);
  }
}

}  // namespace sprekk::io
