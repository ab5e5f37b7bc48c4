// Times at which the slope of loads changes.
#pragma once

#include "model/scene.hpp"

#include <string>
#include <vector>

namespace sprekk::model {

/// Table called by an expression of the scene at shift + factor t.
struct TableOfTime {
  std::string name;
  const base::Table* table;  ///< owned by the scene
  Real shift, factor;
};

/// Returns each table once per shift and factor.
std::vector<TableOfTime> tables_of_time(const Scene& scene);

/// Returns the knots of these tables after the start and up to `end`, ascending, s.
std::vector<Real> knots(const Scene& scene, Real end);

}  // namespace sprekk::model
