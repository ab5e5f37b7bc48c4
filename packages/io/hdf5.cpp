#include "io/hdf5.hpp"

#include "io/hdf5_handle.hpp"

namespace sprekk::io {

namespace {

void write(hid_t group, const char* name, hid_t type, const void* data, hsize_t n) {
  const Handle space(H5Screate_simple(1, &n, nullptr), H5Sclose, "a data space");
  const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "properties");
  check(H5Pset_obj_track_times(properties, false), "properties");  // equal values give equal files
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
    const auto numbers = base::local_elements(*vector->getMap());
    const auto values = vector->getData();
    write(group, "numbers", H5T_NATIVE_LLONG, numbers.getRawPtr(), numbers.size());
    write(group, "values", H5T_NATIVE_DOUBLE, values.getRawPtr(), values.size());
  }
  return image_of(file);
}

void from_hdf5(const std::string& content, const std::string& name, std::map<std::string, NumberedValues>& values) {
  const Handle access(in_memory(), H5Pclose, "access in memory");
  check(H5Pset_file_image(access, const_cast<char*>(content.data()), content.size()), name);  // copied
  const std::string in_memory_only = name + "/image";  // HDF5 rejects an image with the name of an existing file
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
