#include "model/state_tables.hpp"

#include "model/fracture_table.hpp"
#include "model/json_keys.hpp"
#include "physics/scene.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

namespace sprekk::model {

using nlohmann::json;

StateTables::StateTables(Model& model) : model_(model) {
  physics::for_each_physics([&]<physics::HasTables P>(P) {
    if (auto table = P::Tables::table(model.setting(), model.system()))
      tables_[with_underscores(P::Tables::name())] = std::move(table);
  });
}

json StateTables::of_state(const std::vector<assembly::OutputField>& outputs) {
  json all = json::object();
  for (const auto& [name, table] : tables_) {
    const auto found = (*table)({model_.state(), model_.time(), outputs});
    auto& entry = all[name] = {{"fracture", found.fractures}};
    for (const auto& column : found.columns) {
      entry[column.name] = column.values;
      units_[name][column.name] = column.unit;
    }
  }
  return all;
}

std::vector<std::string> names_of_tables() {
  std::vector<std::string> names = {"growth"};
  physics::for_each_physics([&]<physics::HasTables P>(P) { names.push_back(with_underscores(P::Tables::name())); });
  return names;
}

std::map<std::string, std::string> tables_csv(const json& results) {
  std::map<std::string, std::string> all;
  const std::string unit = results["time_unit"]["name"];
  const Real seconds = results["time_unit"]["seconds"];
  const auto tables = results.value("tables", json::object());
  for (const auto& [name, units] : tables.items()) {
    auto& text = all[name] = fmt::format("fracture,time [{}]", unit);
    for (const auto& [column, of_column] : units.items())
      text += fmt::format(",{} [{}]", column, of_column.template get<std::string>());
    text += '\n';
    for (const auto& step : results["steps"]) {
      if (!step.contains(name)) continue;
      const auto& fractures = step[name]["fracture"];
      for (std::size_t row = 0; row < fractures.size(); ++row) {
        text += csv_cell(results["single_fractures"][fractures[row].get<std::size_t>()]["name"]);
        fmt::format_to(std::back_inserter(text), ",{}", step["time"].get<Real>() / seconds);
        for (const auto& [column, of_column] : units.items()) {
          const auto& value = step[name][column][row];
          const bool defined = !value.is_null() && std::isfinite(value.template get<Real>());
          text += defined ? fmt::format(",{}", value.template get<Real>()) : ",";
        }
        text += '\n';
      }
    }
  }
  return all;
}

}  // namespace sprekk::model
