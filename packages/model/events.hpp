// Events of single fractures.
#pragma once

#include "base/types.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace sprekk::model {

struct FractureColumn;

/// Returns the table of events as CSV text, in the order of their ends: fracture, start and end time, changes of the
/// mean and of the integral I, a derived number, and the sum of the changes of I up to the end of the event. It is
/// empty if no column declares assembly::Events.
///
/// An event is a sequence of steps in which |I| of a single fracture changes faster than 1 % of its mean rate
///   max |I| / (end of the last step - start),
/// where the maximum is over all steps. The changes are sums of the absolute changes of all steps in the event, from
/// zero at `start`, s. A fracture with max |I| below 1e-9 of the largest one of all fractures has no event.
///
/// `results` is the content of results.json, with complete steps. Not collective.
std::string events_csv(const nlohmann::json& results, const std::vector<FractureColumn>& columns, Real start);

}  // namespace sprekk::model
