// Distributed vectors in HDF5.
#pragma once

#include "fields/types.hpp"

#include <map>
#include <string>
#include <vector>

namespace sprekk::io {

/// Vectors by name.
using NamedVectors = std::map<std::string, RCP<fields::Vector>>;

/// Values by their global numbers, by name.
struct NumberedValues {
  std::vector<GlobalIndex> numbers;
  std::vector<Real> values;
};

/// This rank's part of the vectors as the content of an HDF5 file: a group of each name with the data sets "numbers"
/// and "values". Not collective.
std::string to_hdf5(const NamedVectors& vectors);

/// Appends what such a file holds; `name` is that of the file, for messages. Error if HDF5 cannot read it. Not
/// collective.
void from_hdf5(const std::string& content, const std::string& name, std::map<std::string, NumberedValues>& values);

}  // namespace sprekk::io
