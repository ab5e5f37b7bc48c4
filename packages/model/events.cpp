#include "model/events.hpp"

#include "model/fracture_table.hpp"
#include "model/json_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace sprekk::model {

using nlohmann::json;

namespace {

constexpr Real min_rate = 1e-2;  ///< smallest rate of change of an event / mean rate
constexpr Real rounding = 1e-9;  ///< rounding error / largest integral; / largest quantity of the unit of the mean

struct Event {
  std::string fracture;
  Real start, end = 0, mean = 0, integral = 0;
};

/// Times and lists of single fractures of all steps with results. Row 0 is the start, with zeros.
struct History {
  std::vector<Real> times;
  std::vector<std::vector<Real>> integrals, means;  ///< [step][fracture]

  std::size_t n_fractures() const { return integrals[0].size(); }
  static Real largest(const std::vector<std::vector<Real>>& rows, std::size_t fracture) {
    Real largest = 0;
    for (const auto& row : rows) largest = std::max(largest, std::abs(row[fracture]));
    return largest;
  }
};

History history_of(const json& results, const std::string& integral, const std::string& mean, Real start) {
  const auto n = results["single_fractures"].size();
  History all = {{start}, {std::vector<Real>(n)}, {std::vector<Real>(n)}};
  for (const auto& step : results["steps"]) {
    const auto lists = step.find("single_fractures");
    if (lists == step.end() || !lists->contains(integral)) continue;
    all.times.push_back(step["time"]);
    all.integrals.push_back(values_of((*lists)[integral]));
    all.means.push_back(values_of((*lists)[mean]));
  }
  return all;
}

/// Adds the events of fracture k.
void add_events(const History& all, std::size_t k, const std::string& name, std::vector<Event>& events) {
  const auto& [times, integrals, means] = all;
  const Real mean_rate = all.largest(integrals, k) / (times.back() - times.front());
  bool goes_on = false;
  for (std::size_t i = 1; i < times.size(); ++i) {
    const Real change = std::abs(integrals[i][k] - integrals[i - 1][k]);
    const bool changes = change > min_rate * mean_rate * (times[i] - times[i - 1]);
    if (changes && !goes_on) events.push_back({name, times[i - 1]});
    if (changes) {
      auto& event = events.back();
      event.end = times[i];
      event.integral += change;
      event.mean += std::abs(means[i][k] - means[i - 1][k]);
    }
    goes_on = changes;
  }
}

/// Largest absolute value of the maxima over fractures with a unit.
Real largest_maximum(const json& results, const std::string& unit) {
  Real largest = 0;
  for (const auto& step : results["steps"]) {
    const auto lists = step.find("single_fractures");
    if (lists == step.end()) continue;
    for (const auto& [name, list] : lists->items())
      if (name.starts_with("max_") && results["units"].value(name, "") == unit)
        for (const Real value : values_of(list)) largest = std::fmax(largest, std::abs(value));
  }
  return largest;
}

/// `scale`: a size of the means.
std::vector<Event> events_of(const History& all, Real scale, const json& fractures) {
  Real largest = 0;
  for (std::size_t k = 0; k < all.n_fractures(); ++k) largest = std::max(largest, all.largest(all.integrals, k));
  std::vector<Event> events;
  for (std::size_t k = 0; k < all.n_fractures(); ++k)
    if (all.largest(all.integrals, k) > rounding * largest && all.largest(all.means, k) > rounding * scale)
      add_events(all, k, fractures[k]["name"], events);
  std::stable_sort(events.begin(), events.end(),
                   [](const Event& a, const Event& b) { return std::tie(a.end, a.start) < std::tie(b.end, b.start); });
  return events;
}

}  // namespace

std::string events_csv(const json& results, const std::vector<FractureColumn>& columns, Real start) {
  const auto column =
      std::find_if(columns.begin(), columns.end(), [](const auto& one) { return one.events.has_value(); });
  if (column == columns.end()) return "";
  const auto& [mean, derived] = *column->events;
  const auto mean_key = "mean_" + with_underscores(mean);
  const auto all = history_of(results, column->name, mean_key, start);
  const std::string time = results["time_unit"]["name"];
  const Real seconds = results["time_unit"]["seconds"];
  auto text = fmt::format("fracture,start [{}],end [{}],{} [{}],{} [{}],{} [{}],cumulated_{} [{}]\n", time, time,
                          with_underscores(mean), results["units"][mean_key].get<std::string>(), column->name,
                          column->unit, derived.name, derived.unit, column->name, column->unit);
  Real sum = 0;
  const Real scale = largest_maximum(results, results["units"][mean_key]);
  for (const auto& event : events_of(all, scale, results["single_fractures"]))
    text += fmt::format("{},{},{},{},{},{},{}\n", csv_cell(event.fracture), event.start / seconds, event.end / seconds,
                        event.mean, event.integral, derived.of({event.integral}).value_or(std::nan("")),
                        sum += event.integral);
  return text;
}

}  // namespace sprekk::model
