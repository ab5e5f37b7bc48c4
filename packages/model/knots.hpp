// Times at which loads change their course.
#pragma once

#include "model/scene.hpp"

#include <string>
#include <vector>

namespace sprekk::model {

/// A table that an expression of the scene calls by shift + factor t.
struct TableOfTime {
  std::string name;
  const base::Table* table;  ///< of the scene
  Real shift, factor;
};

/// Each once for each shift and factor.
std::vector<TableOfTime> tables_of_time(const Scene& scene);

/// The knots of these tables after the start and up to `end`, increasing.
std::vector<Real> knots(const Scene& scene, Real end);

}  // namespace sprekk::model
