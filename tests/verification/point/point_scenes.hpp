// Reads and runs scenes of xml/point.
#pragma once

#include "base/check.hpp"
#include "laboratory/point.hpp"
#include "source_dir.hpp"

#include <Tpetra_Core.hpp>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <string>

namespace sprekk::tests {

using laboratory::PointState;

inline laboratory::PointScene read(const std::string& name, const std::vector<std::string>& overrides = {}) {
  return laboratory::read_point_scene(*Tpetra::getDefaultComm(), source_dir() + "/xml/point/" + name, overrides);
}

/// Returns the states of xml/point/NAME.
inline std::vector<PointState> drive(const std::string& name, const std::vector<std::string>& overrides = {}) {
  return laboratory::drive_point(read(name, overrides));
}

}  // namespace sprekk::tests
