// Table of quantities at points of fractures, for each state of a run.
#pragma once

#include "base/view.hpp"

#include <string>
#include <vector>

namespace sprekk::estimate {

struct State;

/// One row per point. NaN is an undefined number.
struct StateTable {
  struct Column {
    std::string name, unit;
    std::vector<Real> values = {};  ///< [row]
  };
  std::vector<int> fractures;  ///< [row] single fracture
  std::vector<Column> columns;
};

class TableOfStates {
 public:
  virtual ~TableOfStates() = default;
  /// Returns the table of a state with its outputs, equal on all ranks. Collective.
  virtual StateTable operator()(const State& state) const = 0;
};

}  // namespace sprekk::estimate
