// What may be wrong with a scene that has no errors.
#pragma once

#include "model/model.hpp"

#include <string>
#include <vector>

namespace sprekk::model {

/// A line each: conditions that hold nowhere, columns that are passed over, what each physics doubts, and steps that
/// pass over knots of a table. Collective.
std::vector<std::string> scene_warnings(const Model& model);

}  // namespace sprekk::model
