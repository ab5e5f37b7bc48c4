// Distributed vectors in HDF5.
#pragma once

#include "fields/types.hpp"

#include <map>
#include <string>
#include <vector>

namespace sprekk::io {

/// Vectors by name.
using NamedVectors = std::map<std::string, RCP<fields::Vector>>;

/// Values and their global numbers.
struct NumberedValues {
  std::vector<GlobalIndex> numbers;
  std::vector<Real> values;
};

/// Returns the content of an HDF5 file with this rank's part of the vectors: for each name a group with the data sets
/// "numbers" and "values". Not collective.
std::string to_hdf5(const NamedVectors& vectors);

/// Appends the vectors in the content of such a file to `values`. `name` is the name of the file for messages. Throws
/// an Error if HDF5 cannot read the content. Not collective.
void from_hdf5(const std::string& content, const std::string& name, std::map<std::string, NumberedValues>& values);

}  // namespace sprekk::io
